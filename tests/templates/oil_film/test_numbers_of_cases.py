"""Inputs that once gave wrong results, a missing warning or an exception now give the right result."""

import numpy as np
import pytest

from templates import get
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate


def answer(name, version=1, level=None, **changed):
    cls = get(name, version).template
    return evaluate(cls, {**cls.example, **changed}, level=level)


def codes(evaluation):
    return {notice.code for notice in evaluation.warnings}


def verdicts(evaluation):
    return {one.name: one.verdict for one in evaluation.criteria}


def test_a_journal_that_seizes_warns():
    """Both at −30 °C: 25 − 48 000 (2.3e-5 − 1.1e-5) 50 = −3.8 um."""
    cold = {"housing_temperature": "-30 degC", "journal_temperature": "-30 degC"}
    seized = answer("thermal_clearance", cold_diametral_clearance="25 um", **cold)
    assert seized.outputs["diametral_clearance"].value == pytest.approx(-3.8)
    assert "seized" in codes(seized)
    assert "seized" not in codes(answer("thermal_clearance"))


def test_a_turbulent_journal_warns():
    """Re = 875 · 15708 · 0.025 · 0.25e-3/0.011877 = 7232 above 41.3 √(25/0.25) = 413."""
    fast = answer("journal_friction", speed="150000 rpm")
    omega = 150_000 * np.pi / 30
    assert fast.outputs["film_reynolds_number"].value == pytest.approx(
        875 * omega * 0.025 * 0.25e-3 / 0.011877
    )
    assert fast.outputs["laminar_limit"].value == pytest.approx(413)
    assert "turbulent_flow" in codes(fast)
    assert "turbulent_flow" not in codes(answer("journal_friction"))


def test_oil_that_boils_in_a_pad_warns():
    hot = answer("hydrostatic_pad", speed="10000 rpm")
    assert hot.outputs["temperature_rise"].value == pytest.approx(1803, abs=1)
    assert (verdicts(hot)["warm_oil"], "oil_too_hot" in codes(hot)) == ("not_met", True)
    assert "oil_too_hot" not in codes(answer("hydrostatic_pad"))


def test_oil_that_burns_in_a_thrust_bearing_warns():
    hot = answer("thrust_bearing", taper="0.3 um")
    assert hot.outputs["outlet_temperature"].value == pytest.approx(211, abs=0.5)
    assert (verdicts(hot)["hot_oil"], "oil_too_hot" in codes(hot)) == ("not_met", True)
    assert "oil_too_hot" not in codes(answer("thrust_bearing"))


def test_a_thrust_bearing_that_barely_turns_is_refused_by_name():
    with pytest.raises(InvalidInputs, match="no film ratio"):
        answer("thrust_bearing", speed="1 rpm")
    with pytest.raises(InvalidInputs, match="level"):
        answer("thrust_bearing", level="mean_rectangle")


def test_the_regime_follows_from_what_the_contact_bears():
    """The film bears 96.5 % of 100 kN on 50 × 25 mm, though it is half as thick as the roughness."""
    rough = answer("mixed_friction", radial_load="100 kN").outputs
    assert rough["contact_load"].value / 100e3 == pytest.approx(0.035, abs=5e-4)
    assert rough["film_parameter"].value < 0.5
    assert rough["lubrication_regime"].value == "mixed"
    slow = answer("mixed_friction", speed="0.01 rpm").outputs
    assert slow["contact_load"].value > slow["film_load"].value
    assert slow["lubrication_regime"].value == "boundary"


def test_a_part_that_yields_warns_whatever_its_life():
    weak = answer("fatigue_life", yield_strength="65 MPa")
    assert weak.outputs["greatest_von_mises"].value.max() == pytest.approx(438, abs=1)
    assert (verdicts(weak)["strength"], "yields" in codes(weak)) == ("not_met", True)
    assert "yields" not in codes(answer("fatigue_life"))


@pytest.mark.parametrize(
    ("name", "values", "unit"),
    [
        ("groove_width", [2.0, 3.0], "mm"),
        pytest.param("groove_start", [-90.0, -60.0], "deg", marks=pytest.mark.slow),
        pytest.param("groove_extent", [120.0, 180.0], "deg", marks=pytest.mark.slow),
    ],
)
def test_grooves_of_several_sizes_are_answered_each(name, values, unit):
    """And so is every other size of the feeding that is a list."""
    many = answer("cycle_heat_balance", **{name: {"value": values, "unit": unit}}).outputs
    for k, value in enumerate(values):
        alone = answer("cycle_heat_balance", **{name: f"{value} {unit}"}).outputs
        for output in ("film_temperature", "minimum_film_thickness", "feed_flow"):
            assert many[output].value[k] == pytest.approx(alone[output].value, rel=1e-6), (name, output)


@pytest.mark.parametrize("level", ["mobility_grooved", pytest.param("supplied", marks=pytest.mark.slow)])
def test_what_the_supply_drives_through_the_groove_is_in_the_side_flow(level):
    flow = answer("oil_film_cycle", level=level, supply_pressure="96 bar").outputs["side_flow"]
    assert (flow.value, flow.unit) == (pytest.approx(8.42, rel=0.02), "l/min")


def test_a_width_beyond_the_map_is_refused_by_name():
    """Half a millimetre on 100 mm is 0.005: refused alone, and as the second of two points."""
    with pytest.raises(InvalidInputs, match="width ratio"):
        answer("thermal_film", level="field", bearing_width="0.5 mm")
    two = answer("thermal_film", level="field", bearing_width={"value": [80, 0.5], "unit": "mm"}).outputs
    film = two["minimum_film_thickness"]
    alone = answer("thermal_film", level="field").outputs["minimum_film_thickness"].value
    assert film.value[0] == pytest.approx(alone, rel=1e-9)
    assert np.isnan(film.value[1])
    assert "width_ratio must be" in film.reasons[1]
