"""`cycle_heat_balance` 1: level supplied, the film of `oil_film_cycle` 1."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.heat.marched_heat import following

FILM, ETA = "minimum_film_thickness", "effective_viscosity"
PLAIN = {"groove_width": None, "supply_pressure": None, "oil_supply": "flooded_ends"}
HOLE = {**PLAIN, "pin_hole_length": "4 mm", "supply_pressure": "4 bar"}


def answer(raw=None, **options):
    merged = {**CycleHeatBalance.example, **(raw or {})}
    typed = {name: value for name, value in merged.items() if value is not None}
    return evaluate(CycleHeatBalance, typed, **options)


def outputs(raw=None, **options):
    return {name: one.value for name, one in answer(raw, **options).outputs.items()}


def of_cycle(eta, level, raw=None):
    """What oil_film_cycle 1 answers for the same duty at a viscosity [mPa s]."""
    merged = {**CycleHeatBalance.example, **(raw or {}), "dynamic_viscosity": f"{eta!r} mPa*s"}
    typed = {n: v for n, v in merged.items() if v is not None and n in OilFilmCycle.inputs}
    return {n: one.value for n, one in evaluate(OilFilmCycle, typed, level=level).outputs.items()}


@pytest.mark.parametrize("level", ["mobility_grooved", pytest.param("supplied", marks=pytest.mark.slow)])
def test_second_method_balance_by_hand(level):
    """Loss and flow of oil_film_cycle 1 at the viscosity found heat the oil to the temperature found."""
    found = outputs({"hths_viscosity": None}, level=level)
    film = of_cycle(float(found[ETA]), level)
    for name in (FILM, "power_loss", "maximum_pressure"):
        assert found[name] == pytest.approx(film[name], rel=1e-6), name
    assert (found["feed_flow"] is None) == (level == "supplied")
    driven = found["feed_flow"] or 0.0
    assert found["side_flow"] + driven == pytest.approx(film["side_flow"], rel=1e-6)
    rise = film["power_loss"] / (1.8e6 * film["side_flow"] / 60_000)
    assert found["temperature_rise"] == pytest.approx(rise, rel=1e-6)
    assert found["film_temperature"] == pytest.approx(90 + rise / 2, rel=1e-6)
    assert found[ETA] == pytest.approx(found["dynamic_viscosity"], rel=2e-3)


def test_second_method_formulas_on_paper_give_the_answer():
    """Shear rate, Cross's law and feed flow as the report writes them, from values that the answer has."""
    found = outputs(level="mobility_grooved")
    film = of_cycle(float(found[ETA]), "mobility_grooved")
    D, W, groove, c = 48e-3, 18e-3, 3e-3, 0.055e-3
    gap = np.asarray(found["film_thickness"]) * 1e-6 / (c / 2)
    sliding = 3000 * np.pi / 30
    rate = (D * sliding / (c * np.sqrt(gap * (2 - gap)))).mean()
    assert found["mean_shear_rate"] == pytest.approx(rate, rel=1e-6)
    eta, x = found["dynamic_viscosity"], found["hths_ratio"]
    thinned = 1 + (1 - x) / x * rate * eta / (1e6 * found["low_shear_viscosity_hot"])
    assert found[ETA] == pytest.approx(0.5 * eta + 0.5 * eta / thinned, rel=1e-6)
    phi = np.linspace(-np.pi / 2, np.pi / 2, 2001)[:, None]
    h = c / 2 * (1 - film["eccentricity_x"] * np.cos(phi) - film["eccentricity_y"] * np.sin(phi))
    driven = 4e5 * D / (6 * found[ETA] * 1e-3 * (W - groove)) * trapezoid(h**3, phi, axis=0).mean()
    assert found["feed_flow"] == pytest.approx(driven * 60_000, rel=1e-5)


def test_property_viscosity_that_no_shear_leaves_names_input_unit_and_what_is_right():
    with pytest.raises(InvalidInputs, match=r"give an .hths_viscosity. in mPa\*s below that at low shear"):
        answer({"hths_viscosity": "30 mPa*s"})


def test_analytic_no_heat_is_the_viscosity_of_the_supply():
    found = outputs({"heat_share": "0", "hths_viscosity": None})
    assert found["temperature_rise"] == pytest.approx(0, abs=1e-9)
    assert found[ETA] == pytest.approx(found["dynamic_viscosity"], rel=1e-9)


def test_property_inputs_that_a_level_does_not_read_are_named():
    def unused(raw, level=None):
        return {w.name for w in answer(raw, level=level).warnings if w.code == "unused_input"}

    assert unused({}) == set()
    assert unused({}, "mobility") == {"groove_width"}
    assert unused({**HOLE, "oil_supply": "groove_or_hole"}) == {"pin_hole_length", "supply_pressure"}


def test_property_level_supplied_needs_a_supply():
    with pytest.raises(InvalidInputs, match="pin_hole_length"):
        answer(PLAIN, level="supplied")


def test_analytic_secants_end_at_a_root():
    rounds = [(0.0, 0.7 - np.expm1(0.0))]
    for _ in range(8):
        x = following(rounds)
        rounds.append((x, 0.7 - np.expm1(x)))
        if abs(rounds[-1][1]) < 1e-12:
            break
    assert np.exp(rounds[-1][0]) == pytest.approx(1.7, rel=1e-9)


def test_property_a_secant_does_not_run_away():
    assert following([(0.0, 100.0)]) == pytest.approx(np.log(4))
    assert following([(0.0, 1.0), (0.5, 1.0)]) == pytest.approx(1.0)
