"""rolling_bearing_life 1: a catalogue's example, the standard's table of reliability, limits and refusals."""

import numpy as np
import pytest

from templates.bearing_load.rolling_bearing_life_v1 import RollingBearingLife
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.rolling.rating_life import mean_load

PLAIN = {
    "radial_load": "10 kN", "speed": "3000 rpm", "dynamic_capacity": "55.3 kN", "static_capacity": "31.5 kN",
}  # fmt: skip


def values(raw):
    return {name: answer.value for name, answer in evaluate(RollingBearingLife, raw).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(RollingBearingLife, raw)
    return {name: fault.detail for fault in refusal.value.faults for name in fault.names}


def test_literature_example_of_the_catalogue():
    """SKF Rolling bearings, calculation example 1: bearing 6309 lives 169 million turns, 940 hours."""
    out = values(PLAIN)
    assert round(out["basic_rating_life"] / 1e6) == 169
    assert out["basic_life_in_hours"] == pytest.approx(940, rel=1e-3)
    assert out["life_in_hours"] == pytest.approx(out["basic_life_in_hours"], rel=1e-12)


@pytest.mark.parametrize(
    ("reliability", "factor", "digits"),
    [(0.9, 1, 2), (0.95, 0.64, 2), (0.96, 0.55, 2), (0.97, 0.47, 2), (0.98, 0.37, 2), (0.99, 0.25, 2),
     (0.994, 0.19, 2), (0.996, 0.16, 2), (0.998, 0.12, 2), (0.999, 0.093, 3), (0.9995, 0.077, 3)],
)  # fmt: skip
def test_literature_reliability_factors_of_the_table(reliability, factor, digits):
    """ISO 281:2007, table of a1, to its last digit."""
    out = values({**PLAIN, "reliability": reliability})
    assert round(out["reliability_factor"], digits) == factor


@pytest.mark.parametrize(
    ("relative", "limit", "Y"),
    [(0.172, 0.19, 2.30), (1.03, 0.28, 1.55), (6.89, 0.44, 1.00), (0.517, 0.24, 1.85)],
)
def test_literature_axial_factors(relative, limit, Y):
    """At rows of the table, and half-way between two; below e the radial load counts alone."""
    f_0, C_0 = 14, 30e3
    F_a = relative * C_0 / f_0
    raw = {
        **PLAIN,
        "static_capacity": "30 kN",
        "calculation_factor": f_0,
        "axial_load": {"value": F_a, "unit": "N"},
    }
    high = {"value": 0.5 * F_a / limit, "unit": "N"}
    assert values({**raw, "radial_load": high})["equivalent_load"] == pytest.approx(
        0.56 * 0.5 * F_a / limit + Y * F_a, rel=1e-3
    )
    low = {"value": 1.1 * F_a / limit, "unit": "N"}
    assert values({**raw, "radial_load": low})["equivalent_load"] == pytest.approx(
        1.1 * F_a / limit, rel=1e-12
    )


def test_analytic_varying_load_counts_by_its_power():
    """Half the time at 2 kN, half at nothing: 2 (1/2)^(1/p) kN."""
    loads = {"value": [2.0, 0.0] * 6, "unit": "kN"}
    assert values({**PLAIN, "radial_load": loads})["equivalent_load"] == pytest.approx(
        2000 * 0.5 ** (1 / 3), rel=1e-12
    )
    rollers = values({**PLAIN, "radial_load": loads, "rolling_elements": "roller"})
    assert rollers["equivalent_load"] == pytest.approx(2000 * 0.5**0.3, rel=1e-12)
    assert rollers["basic_rating_life"] == pytest.approx(
        1e6 * (55.3e3 / (2000 * 0.5**0.3)) ** (10 / 3), rel=1e-12
    )


def test_limit_steady_curve_is_a_constant_load():
    steady = values({**PLAIN, "radial_load": {"value": [10.0] * 12, "unit": "kN"}})
    for name, value in values(PLAIN).items():
        assert steady[name] == pytest.approx(value, rel=1e-12), name


def test_analytic_static_load_is_the_greatest_of_the_cycle():
    raw = {**PLAIN, "radial_load": {"value": [1.0, 4.0, 2.0] * 4, "unit": "kN"}, "axial_load": "6 kN",
           "calculation_factor": 13}  # fmt: skip
    out = values(raw)
    assert out["static_equivalent_load"] == pytest.approx(0.6 * 4000 + 0.5 * 6000, rel=1e-12)
    assert out["static_safety"] == pytest.approx(31500 / 5400, rel=1e-12)


def test_property_more_load_never_lives_longer():
    loads = np.linspace(0.1, 25, 60)
    raw = {**PLAIN, "axial_load": "2 kN", "calculation_factor": 13}
    lives = [
        values({**raw, "radial_load": {"value": load, "unit": "kN"}})["basic_rating_life"] for load in loads
    ]
    assert np.all(np.diff(lives) <= 1e-9 * np.array(lives[1:]))


def test_property_heavy_loads_are_warned_of_and_no_load_has_a_reason():
    heavy = evaluate(RollingBearingLife, {**PLAIN, "radial_load": "40 kN"})
    assert {(warning.code, warning.name) for warning in heavy.warnings} == {
        ("outside_published_range", "load_ratio")
    }
    idle = evaluate(RollingBearingLife, {**PLAIN, "radial_load": "0 N"}).outputs
    assert idle["basic_rating_life"].value is None
    assert "without load" in idle["basic_rating_life"].reason


@pytest.mark.parametrize(
    ("change", "name", "words"),
    [
        ({"axial_load": "1 kN"}, "calculation_factor", "catalogue"),
        (
            {"axial_load": "1 kN", "calculation_factor": 13, "rolling_elements": "roller"},
            "axial_load",
            "radial_load",
        ),
        ({"axial_load": "30 kN", "calculation_factor": 13}, "relative_axial_load", "larger bearing"),
        ({"reliability": 0.5}, "reliability", "0.9"),
        ({"speed": "0 rpm"}, "speed", "> 0"),
    ],
)
def test_property_refusals_name_the_input(change, name, words):
    faults = refused({**PLAIN, **change})
    assert name in faults, faults
    assert words in faults[name]


def test_property_a_mean_load_scales_with_its_loads():
    """A half turn at P and one without load: (P^p/2)^(1/p), for a millionth of a newton as for a million."""
    for size in (1e-6, 0.5, 1.0, 1e6):
        assert mean_load(np.array([size, 0.0]), 3.0) == pytest.approx(size * 0.5 ** (1 / 3), rel=1e-12)
