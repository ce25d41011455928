"""docs/validation.md: each published case is calculated again, and the page shows the kept results.

A case that has moved by more than a thousandth, or a twentieth of its uncertainty, fails here: run
`python -m benchmarks.validation` and explain the change.
"""

import json

import pytest

from benchmarks.validation.gaps import NOT_FOUND
from benchmarks.validation.page import PAGE, PICTURES, page, pictures
from benchmarks.validation.results import RESULTS, kept
from templates.door import built_in
from templates.validate.case import numbers
from templates.validate.cases import CASES
from templates.validate.comparison import agrees, comparisons
from templates.validate.reference import KEYS, Uncertainty

EACH = pytest.mark.parametrize(
    "case",
    [pytest.param(case, id=case.key, marks=[pytest.mark.slow] if case.is_slow else []) for case in CASES],
)


@EACH
def test_a_case_gives_its_kept_results(case):
    found = case.calculate()
    for old, new in zip(comparisons(case, kept()[case.key]), comparisons(case, found), strict=True):
        for before, now, uncertainty in zip(old.ours, new.ours, new.uncertainties, strict=True):
            assert now == pytest.approx(before, rel=1e-3, abs=uncertainty / 20), new.column.name


def test_the_page_shows_the_kept_results():
    assert PAGE.read_text(encoding="utf-8") == page(kept())
    drawn = {path.name: path.read_text(encoding="utf-8") for path in PICTURES.glob("*.svg")}
    assert drawn == pictures(kept())
    assert sum(map(len, drawn.values())) < 1_000_000


def test_the_kept_results_are_those_of_the_cases():
    assert list(json.loads(RESULTS.read_text(encoding="utf-8"))) == [case.key for case in CASES]
    assert len({case.title for case in CASES}) == len(CASES)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.key)
def test_a_case_states_its_source_and_the_reason_of_a_difference(case):
    assert set(case.reference.head) == set(KEYS)
    assert case.selected
    assert {*case.rows, *case.columns} <= set(case.selected[0])
    assert all(numbers(row).keys() & {column.name for column in case.compared} for row in case.selected)
    if not agrees(comparisons(case, kept()[case.key])):
        assert case.because


def test_every_template_is_compared_or_the_page_says_that_nothing_was_found():
    every = {f"{template.id} {template.version}" for template in built_in()}
    compared = {case.subject for case in CASES}
    assert every - compared == set(NOT_FOUND)
    assert {subject for subject in compared if not subject.startswith("model ")} <= every


def test_an_uncertainty_is_a_sum_of_an_absolute_and_a_relative_part():
    assert Uncertainty.read("0.5 + 2 %").of(-100.0) == pytest.approx(2.5)
    assert Uncertainty.read("3 %").of(0.0) == 0.0
