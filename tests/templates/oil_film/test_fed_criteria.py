"""Each criterion of `oil_film_cycle` is met in one case and not in another, with the model's error ignored.

A table of errors may come to state one, or another: the verdicts with it are not held here.
"""

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from templates.core.language import levels
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.elastic.elastic_journal import deflection_in_steel

STIFF = {"dynamic_viscosity": "1 Pa*s"}
THIN = {"dynamic_viscosity": "0.02 mPa*s"}
PUSHED = hypot(14.4, 1.9) * 1e3 / (48 * 18)  # MPa
# A load that turns with the pin, and so with its hole.
HOLE = {
    "pin_hole_length": "4 mm",
    "load_x": {"value": [10 * cos(k * pi / 12) for k in range(24)], "unit": "kN"},
    "load_y": {"value": [10 * sin(k * pi / 12) for k in range(24)], "unit": "kN"},
}
EXACT = [
    ("specific_load", {"bearing_material": "tin_bronze"}, {}, "met", PUSHED, 30),
    ("specific_load", {"bearing_material": "copper_lead"}, {}, "not_met", PUSHED, 10.3),
    ("hole_leaves_the_load", {}, {**HOLE, "pin_hole_angle": "180 deg"}, "met", 0, 0.6),
    ("hole_leaves_the_load", {}, HOLE, "not_met", 1, 0.6),
]
VALUES = {"film": 2.85682, "pressure": 76.0541, "thin_film": 0.0142912, "thin_pressure": 673.865}
VALUES |= {"deflection": 3.824594, "thick_deflection": 1.851124}
CASES = [
    ("film", {"permissible_film": "2 um"}, "met", "film", 2),
    ("film", {"permissible_film": "3 um"}, "not_met", "film", 3),
    ("pressure", {"permissible_pressure": "80 MPa"}, "met", "pressure", 80),
    ("pressure", {"permissible_pressure": "70 MPa"}, "not_met", "pressure", 70),
    ("film_exists", {}, "met", "film", 0.05),
    ("film_exists", THIN, "not_met", "thin_film", 0.05),
    ("rigid", STIFF, "met", "thick_deflection", 22.782389 / 2),
    ("rigid", {}, "not_met", "deflection", 2.85682 / 2),
    ("isoviscous", {}, "met", "pressure", 500),
    ("isoviscous", THIN, "not_met", "thin_pressure", 500),
]


@pytest.mark.parametrize(("name", "changes", "verdict", "value", "limit"), CASES)
def test_both_verdicts_of_the_film(monkeypatch, name, changes, verdict, value, limit):
    monkeypatch.setitem(levels._cache, OilFilmCycle, None)
    result = evaluate(OilFilmCycle, {**OilFilmCycle.example, **changes})
    judgement = next(one for one in result.criteria if one.name == name)
    assert (judgement.verdict, judgement.is_certain) == (verdict, False)
    warned = judgement.warning in {notice.code for notice in result.warnings}
    assert warned == (verdict == "not_met" and judgement.warning is not None)
    assert judgement.value == pytest.approx(VALUES[value], rel=2e-5)
    assert judgement.limit == pytest.approx(limit, rel=2e-5)


@pytest.mark.parametrize(("name", "limits", "changes", "verdict", "value", "limit"), EXACT)
def test_both_verdicts_where_the_level_is_no_matter(name, limits, changes, verdict, value, limit):
    example = {n: v for n, v in OilFilmCycle.example.items() if not (changes and n.startswith("groove"))}
    result = evaluate(OilFilmCycle, {**example, **changes}, limits=limits)
    judgement = next(one for one in result.criteria if one.name == name)
    assert judgement.verdict == verdict
    assert (judgement.value, judgement.limit) == (pytest.approx(value, abs=1e-9), pytest.approx(limit))


def test_every_criterion_has_a_case_of_both_verdicts():
    declared = {criterion.name for criterion in OilFilmCycle.declared_criteria}
    for wanted in ("met", "not_met"):
        shown = {name for name, _, verdict, *_ in CASES if verdict == wanted}
        assert shown | {name for name, _, _, verdict, *_ in EXACT if verdict == wanted} == declared


def test_literature_deflection_of_a_bore_under_even_pressure_is_that_of_lame():
    """Of a bore in an endless body: (1 + nu) p R/E. A cosine squared has half its height as mean."""
    radius, width, pressure = 0.024, 0.018, 60e6
    around = 10 * pressure * radius * width  # more than the pressed zone can bear: all of the bore is pressed
    found = deflection_in_steel(*(np.asarray(v) for v in (pressure, around, radius, width)))
    assert found == pytest.approx(1.3 / 210e9 * (2 / 3 * pressure / 2) * radius, rel=1e-5)
