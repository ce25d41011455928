"""Errors of upstream steps in verdicts of rows: which values are calculated at both ends of a band."""

import copy
from types import SimpleNamespace

import pytest
from row_designs import BEARING, CURVES, FILM, LOSS
from test_design_engine_verdicts import assert_judged_as_designs, chained

from app.designs.engine import shifts
from app.designs.engine.columns import RowEstimate
from app.designs.engine.shifts import Origins, Shifts
from templates.core.criteria.bands import Estimate

VARIED = ("clearance", "load")


def expensive(monkeypatch, seconds):
    """Have steps count as expensive that take longer than so many seconds."""
    monkeypatch.setattr(shifts, "EXPENSIVE", seconds)


@pytest.mark.parametrize("seconds", [0.0, 1e9])
@pytest.mark.sampled(1)
def test_property_no_error_is_carried_through_an_expensive_step(monkeypatch, seconds):
    expensive(monkeypatch, seconds)
    assert assert_judged_as_designs(chained(), VARIED, 6)


def test_property_errors_are_carried_along_curves(monkeypatch):
    """The clearance of a cycle follows from an uncertain film; values of a row and along its curve meet."""
    expensive(monkeypatch, 1e9)
    raw = copy.deepcopy(CURVES)
    raw["parameters"] |= {"width": "18 mm", "load": "25 kN", "diameter": "48 mm"}
    raw["steps"]["static"] = copy.deepcopy(BEARING["steps"]["film"]) | {"level": "fit"}
    cycle = raw["steps"]["film"]["inputs"]
    cycle["diametral_clearance"] = "= clearance + static.minimum_film_thickness"
    raw["criteria"] = {
        "thickness": {"require": "film.film_thickness >= 0.1 * clearance"},
        "places": {"require": "film.minimum_film_thickness * factor >= 6 um"},
    }
    assert assert_judged_as_designs(raw, VARIED, 4)


def test_property_a_long_chain_of_relations_is_followed():
    """Beyond what Python follows by calls that call each other."""
    raw = chained()
    raw["parameters"]["p0"] = "= film.minimum_film_thickness * 1"
    for n in range(1, 400):
        raw["parameters"][f"p{n}"] = f"= p{n - 1} * 1"
    raw["criteria"] = {"end": {"require": "p399 >= 1.9 um"}}
    assert assert_judged_as_designs(raw, VARIED, 3)


@pytest.mark.parametrize("error", [0.0, float("nan")])
def test_an_output_without_an_error_is_not_calculated_again(error):
    """Of an unknown error there is no end either."""
    exact = Shifts(SimpleNamespace(count=1), lambda _: RowEstimate(Estimate(1.0, error)))
    assert not exact.by_error(Origins(frozenset({FILM, LOSS}))).uncertain
