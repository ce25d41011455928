"""Editors and type checkers see the keywords that declarations accept."""

import inspect
import subprocess
import sys

import pytest

from templates.core.language.declare import curve, derived, formula, given, profile, table, text
from templates.core.language.meaning import Keywords, meaning


def test_property_the_keywords_are_those_of_a_meaning():
    taken = inspect.signature(meaning).parameters
    assert list(Keywords.__annotations__) == [
        name for name, parameter in taken.items() if parameter.kind is inspect.Parameter.KEYWORD_ONLY
    ]


@pytest.mark.parametrize(
    "declare", [given, table, curve, formula, derived, profile, text], ids=lambda f: f.__name__
)
def test_property_every_declaration_names_its_keywords(declare):
    parameters = inspect.signature(declare).parameters.values()
    (rest,) = (p for p in parameters if p.kind is inspect.Parameter.VAR_KEYWORD)
    assert rest.annotation == "Unpack[Keywords]"


LINES = {
    'given("mm", "width", ge=1, remedy="wider")': None,
    'given("mm", "width", minimum=1)': 'Unexpected keyword argument "minimum" for "given"',
    'given("mm", "width", ge="1 mm")': 'has incompatible type "str"',
    'formula("mm", "width", sorce="Walther")': 'Unexpected keyword argument "sorce" for "formula"',
}


SETTINGS = """[mypy]
follow_imports = silent
[mypy-numpy.*,scipy.*,pint.*,lark.*]
follow_imports = skip
"""
"""The types of the libraries are not read: no keyword of a declaration has one of them."""


@pytest.fixture(scope="module")
def complaints(tmp_path_factory):
    """What mypy prints of each line; one run for all of them, for it reads half the library first."""
    file = tmp_path_factory.mktemp("typed") / "own.py"
    assigned = "".join(f"width_{number} = {line}\n" for number, line in enumerate(LINES))
    file.write_text(
        f"from templates.core.language.template import formula, given\n{assigned}", encoding="utf-8"
    )
    settings = file.with_suffix(".ini")
    settings.write_text(SETTINGS, encoding="utf-8")
    options = [f"--config-file={settings}", f"--cache-dir={file.parent}"]
    command = [sys.executable, "-m", "mypy", *options, str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert f"Found {len(list(filter(None, LINES.values())))} errors in 1 file" in done.stdout, done.stdout
    output = done.stdout.splitlines()
    return {
        line: "".join(text for text in output if f"own.py:{number}: error" in text)
        for number, line in enumerate(LINES, 2)
    }


@pytest.mark.slow
@pytest.mark.parametrize(("line", "complaint"), LINES.items())
def test_property_a_type_checker_sees_a_wrong_keyword(complaints, line, complaint):
    assert (complaint in complaints[line]) if complaint else complaints[line] == ""
