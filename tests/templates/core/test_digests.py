"""The digest of a version: which changes affect it."""

import ast
import copy
import json
import random
from itertools import chain
from pathlib import Path

import pytest

import templates
from cad.catalogue import models
from templates.core.catalogue.digests import (
    digest,
    digest_of,
    release_file,
)
from templates.core.catalogue.discovery import find
from templates.core.catalogue.golden import mark_released
from templates.core.language.template import Template

SOURCE = '''"""A team's own template."""

import math as maths
from numpy import sqrt as root, pi
from templates.core.language.template import Template, choice, derived, formula, given


class Own(Template):
    """Twice a length."""

    withdrawn = None
    example = {"length": "2 m"}

    a = given("m", "length", gt=0, le=2)
    n = given("1", "count", default=2, integer=True)
    way = choice("up", "down", words="way", default="up")

    @derived("m", "width")
    def b(self):
        return self.a

    @formula("m", "twice the length")
    def r(self):
        """Doubled."""
        return 2 * self.a + 0 * self.b * self.n + 0 * root(maths.e) * pi
'''

TIDYING = [
    ('"""Twice a length."""', '"""Twice a length, better explained."""'),
    ('"""Doubled."""', '"""Doubled: 2 a."""'),
    ('"""A team\'s own template."""', '"""Errata: none."""'),
    ("withdrawn = None", 'withdrawn = "use 2"'),
    ("withdrawn = None", 'withdrawn: str | None = "use 2"'),
    ("    withdrawn = None\n", ""),
    ("withdrawn = None", 'criteria = {"length": "length <= 1 m"}'),
    ("withdrawn = None", 'toleranced = {"length": {"planes": "z"}}'),
    ("2 * self.a +", "2*(self.a) +"),
    ("return self.a\n", "return self.a  # as given\n\n"),
]
MOVES = [
    ("from numpy import", "from numpy.lib.scimath import"),
    (
        "from templates.core.language.template import Template, choice,",
        "from templates.core.language import choice,",
    ),
    ("from numpy import sqrt as root, pi", "from math import pi\nfrom numpy import sqrt as root"),
    ("import math as maths", "import lib.math as maths"),
]
CHANGES = [
    ("2 * self.a", "2.1 * self.a"),
    ("2 * self.a", "2. * self.a"),
    ("gt=0", "ge=0"),
    ('"m", "twice', '"mm", "twice'),
    ("le=2", "le=3"),
    ("integer=True", "integer=False"),
    ("sqrt as root", "cbrt as root"),
    ("import math as maths", "import cmath as maths"),
    ("sqrt as root, pi", "sqrt as root, e as pi"),
    ("        return self.a\n", '        withdrawn = "a local name"\n        return self.a\n'),
    ("\n\nclass Own", '\ncriteria = "of the module"\n\nclass Own'),
]


def written(folder, source=SOURCE):
    folder.mkdir()
    (folder / "own_v1.py").write_text(source, encoding="utf-8")
    (cls,) = find([folder], Template)
    return cls


def replaced(old, new):
    assert SOURCE.count(old) >= 1
    return SOURCE.replace(old, new)


@pytest.mark.parametrize(("old", "new"), TIDYING)
def test_property_words_and_marks_do_not_change_it(tmp_path, old, new):
    one, changed = written(tmp_path / "one"), written(tmp_path / "changed", replaced(old, new))
    assert digest(changed) == digest(one)


@pytest.mark.parametrize(("old", "new"), MOVES)
def test_property_the_path_of_an_imported_module_does_not_change_it(old, new):
    """The text alone is compared: some of these modules do not exist."""
    moved = replaced(old, new)
    assert ast.unparse(ast.parse(moved)) != ast.unparse(ast.parse(SOURCE))
    if "Template, choice" in old:
        moved = moved.replace("import choice,", "import Template, choice,")
    assert digest_of([moved]) == digest_of([SOURCE])


@pytest.mark.parametrize(("old", "new"), CHANGES)
def test_property_any_other_change_changes_it(old, new):
    assert digest_of([replaced(old, new)]) != digest_of([SOURCE])


def test_property_a_record_is_never_overwritten(tmp_path):
    released = written(tmp_path / "released")
    path = mark_released(released)
    path.write_text('{"digest": "kept"}', encoding="utf-8")
    assert mark_released(released) == path
    assert json.loads(path.read_text(encoding="utf-8")) == {"digest": "kept"}


BUILT_IN = [*chain(find([Path(templates.__file__).parent], Template), models())]


@pytest.mark.parametrize("count", [2, pytest.param(8, marks=pytest.mark.slow)])
@pytest.mark.parametrize("cls", BUILT_IN, ids=lambda cls: f"{cls.id}-{cls.version}")
@pytest.mark.sampled(12)
def test_property_every_token_of_a_released_file_counts(cls, count):
    """Names, attributes, numbers, texts and operators, changed one at a time at places drawn by lot."""
    tree = ast.parse(Path(release_file(cls).parent, f"{cls.__module__.rpartition('.')[2]}.py").read_text())
    before, quiet, nodes = digest_of([ast.unparse(tree)]), silent(tree), list(ast.walk(tree))
    random_ = random.Random(f"{cls.id}{cls.version}")
    places = [place for place, node in enumerate(nodes) if changed(copy.copy(node))]
    for place in random_.sample([p for p in places if p not in quiet], count):
        node = nodes[place]
        as_released = dict(vars(node))
        assert changed(node)
        assert digest_of([ast.unparse(tree)]) != before, ast.dump(node)
        vars(node).update(as_released)
    assert digest_of([ast.unparse(tree)]) == before


def changed(node):
    """Change a node in place, if it is of a kind that can stand alone; whether it is."""
    match node:
        case ast.Constant(value=bool()):
            node.value = not node.value
        case ast.Constant(value=int() | float()):
            node.value = node.value + 1
        case ast.Constant(value=str()):
            node.value += "!"
        case ast.Name():
            node.id += "_"
        case ast.Attribute():
            node.attr += "_"
        case ast.BinOp():
            node.op = ast.Mod()
        case ast.keyword(arg=str()):
            node.arg += "_"
        case ast.alias():
            node.asname = "other"
        case ast.FunctionDef() | ast.ClassDef():
            node.name += "_"
        case _:
            return False
    return True


def silent(tree):
    """The places of docstrings and of the marks' values, which may change."""
    nodes = list(ast.walk(tree))
    marks = (node for node in nodes if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) in (
        "withdrawn", "criteria", "toleranced"
    ))  # fmt: skip
    texts = (n.value for n in nodes if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant))
    quiet = {id(part) for node in marks for part in ast.walk(node)} | {id(text) for text in texts}
    return {place for place, node in enumerate(nodes) if id(node) in quiet}
