"""The worksheets on the tutorial's second page are accepted and give the numbers that the page states."""

import re
from pathlib import Path

import pytest

from templates.core.language.evaluate import evaluate
from templates.core.sheets import SheetRefused, read, run_tests
from templates.examples.index import examples

PAGE = Path(__file__).parents[1].joinpath("docs", "tutorial_worksheet.md").read_text("utf-8")
PAPER, THREE, RIGHT = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)


def of_example(text, name):
    """What a sheet gives for its example [its declared unit]."""
    cls = read(text).template("tutorial", 1)
    return float(evaluate(cls, cls.example).outputs[name].value)


def test_the_paper_worksheet_has_the_lines_that_are_quoted_and_gives_its_film():
    text = examples()[0].text
    assert PAPER in text
    assert text.splitlines()[5].startswith("given SCALE [1] = 1 ")
    assert f"{of_example(text, 'minimum_film_thickness'):.5g}" == "3.2449"
    scaled = text.replace("SCALE [1] = 1 ", "SCALE [1] = 1.25 ")
    assert of_example(scaled, "bearing_diameter") == 60
    film = f"{of_example(scaled, 'minimum_film_thickness'):.5g}"
    assert f"the film {film} µm thick" in PAGE
    assert not all(test.passed for test in run_tests(read(scaled).template("scaled", 1)))


def test_the_three_lines_are_refused_at_the_third_and_right_with_a_division():
    with pytest.raises(SheetRefused) as refused:
        read(THREE)
    assert [(fault.line, fault.code) for fault in refused.value.faults] == [(3, "unit_mismatch")]
    wrong = THREE.splitlines()[2]
    size = of_example(THREE.replace(wrong, RIGHT.strip()), "bearing_diameter")
    assert PAGE.count(f"{size:.5g} mm") == 2


def test_the_lines_of_the_table_are_a_worksheet():
    rows = re.findall(r"^\| `([^`]+)`", PAGE, re.MULTILINE)
    lines = [row for row in rows if not row.startswith("# Title")]
    sheet = read("\n".join([*lines, 'given D [mm] "bearing diameter" (example 48 mm)']))
    kinds = [statement.kind for statement in sheet.statements]
    assert kinds == ["given", "given", "formula", "require", "check", "test", "remark", "given"]
