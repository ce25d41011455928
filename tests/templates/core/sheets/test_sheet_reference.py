"""The reference of the language: its example is a worksheet, and it lists every code of a fault."""

import re
from pathlib import Path

import pytest

import templates
from templates.core.language.evaluate import evaluate
from templates.core.sheets import read, run_tests
from templates.core.sheets.grammar import MOST_DEPTH, MOST_PARTS
from templates.core.sheets.lines import LONGEST_STATEMENT, MOST_BYTES, MOST_STATEMENTS
from templates.core.sheets.names import FUEL, LONGEST_NAME

ROOT = Path(templates.__file__).parents[1]
REFERENCE = (ROOT / "docs" / "reference" / "worksheets.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```worksheet\n(.*?)```", REFERENCE, re.DOTALL)
CODE = re.compile(r'(?:refuse\(|FaultyText\(|SheetFault\([^"]*)\s*"([a-z_]+)"')


def test_the_example_is_read_and_calculated():
    (text,) = EXAMPLES
    cls = read(text).template("reference", 1)
    assert all(test.passed for test in run_tests(cls))
    assert evaluate(cls, cls.example).outputs["viscosity"].value == pytest.approx(32.6667, rel=1e-5)


def test_every_code_is_listed():
    sources = (ROOT / "templates" / "core" / "sheets").glob("*.py")
    codes = {code for file in sources for code in CODE.findall(file.read_text(encoding="utf-8"))}
    assert len(codes) > 10
    listed = re.findall(
        r"`([a-z_]+)`", REFERENCE[REFERENCE.index("## Faults") : REFERENCE.index("## Limits\n")]
    )
    assert codes <= set(listed), codes - set(listed)


def test_the_limits_are_those_of_the_code():
    limits = " ".join(REFERENCE[REFERENCE.index("## Limits\n") :].split())
    assert f"{MOST_BYTES // 1024} KiB, {MOST_STATEMENTS} statements" in limits
    assert (
        f"{LONGEST_STATEMENT // 1000} 000 characters, {MOST_PARTS} parts, {MOST_DEPTH} nested levels"
        in limits
    )
    assert f"{FUEL // 1000} 000" in limits
    assert f"{LONGEST_NAME}, 200 characters" in limits
