"""Structure: physics that no template, model or benchmark uses belongs in `tests/references`."""

import ast
import re
from collections import defaultdict
from pathlib import Path

PHYSICS = Path("templates/physics")


def names(node):
    """The names in a piece of code."""
    inside = list(ast.walk(node))
    return {one.id for one in inside if isinstance(one, ast.Name)} | {
        one.attr for one in inside if isinstance(one, ast.Attribute)
    }


def defined(files):
    """Functions and classes of some files with the names that each uses, and all names used outside them."""
    uses, outside = defaultdict(set), set()
    for file in files:
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                uses[node.name] |= names(node) - {node.name}
            else:
                outside |= names(node)
    return uses, outside


def unused(files, roots):
    """The functions and classes of some files that nothing reaches from the words of other texts."""
    uses, ahead = defined(files)
    for text in roots:
        ahead |= set(re.findall(r"\w+", text))
    reached, ahead = set(), list(ahead)
    while ahead:
        name = ahead.pop()
        if name not in reached:
            reached.add(name)
            ahead += uses.get(name, ())
    return set(uses) - reached


def test_physics_that_only_tests_use_stands_beside_the_tests():
    files = [path for part in ("templates", "cad", "app", "benchmarks") for path in Path(part).rglob("*.py")]
    texts = [path.read_text(encoding="utf-8") for path in files if PHYSICS not in path.parents]
    roots = [text for text in texts if "templates.physics" in text]
    assert len(roots) > 50
    assert unused(PHYSICS.rglob("*.py"), roots) == set()


def test_what_only_unused_functions_use_is_unused(tmp_path):
    file = tmp_path / "some.py"
    file.write_text(
        "def used(): return deep()\ndef deep(): pass\ndef lost(): lonely()\ndef lonely(): lost()\n"
    )
    assert unused([file], ["used()"]) == {"lost", "lonely"}
