"""Analytic: sensitivities of explained values agree with closed forms; some values have none."""

import copy

import numpy as np
import pytest
from row_designs import CATALOGUES, CURVES, calculated, ref

from app.designs import sensitivities as module
from app.designs.document import Document
from app.designs.explanation import explained
from app.designs.slopes import Local, slopes_at
from app.schemas.slopes import slope_in
from app.storage.errors import NotFound

PETROV = {
    "name": "Petrov",
    "parameters": {"bore": "50 mm", "play": "0.5 mm", "turns": "1500 rpm", "most": "40 W", "other": "3 mm"},
    "steps": {
        "idle": {
            "template": "journal_friction",
            "version": 1,
            "inputs": {
                "journal_diameter": "= bore",
                "bearing_width": "100 mm",
                "radial_clearance": "= play / 2",
                "speed": "= turns",
                "dynamic_viscosity": "11.877 mPa*s",
                "radial_load": "10 N",
            },
        }
    },
    "criteria": {"loss": {"require": "idle.power_loss <= most"}},
}
EXPONENTS = {
    "bore": 3,
    "turns": 2,
    "idle.bearing_width": 1,
    "idle.dynamic_viscosity": 1,
    "play": -1,
}


def with_shell(diameter, **parameters):
    """The design with a shell whose bore is a relation."""
    raw = copy.deepcopy(PETROV)
    raw["parameters"] |= parameters
    raw["models"] = {
        "shell": {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": diameter}}
    }
    return raw


def asked(raw, name, calculation=None):
    """The explanation of a name."""
    return explained(Document.model_validate(raw), calculation or calculated(raw), CATALOGUES, name)


def of(raw, name):
    """Sensitivities by place, of a value of which no reason says that some are missing."""
    chain = asked(raw, name)
    assert chain.reason is None
    return {item.name: item for item in chain.sensitivities}


def test_a_power_law_through_a_step_and_relations_has_its_exponents():
    slopes = of(with_shell("= idle.power_loss * 1 mm/W"), "inner_diameter")
    assert {name: item.elasticity for name, item in slopes.items()} == pytest.approx(EXPONENTS, abs=1e-6)
    sizes = [abs(item.elasticity) for item in slopes.values()]
    assert sizes == sorted(sizes, reverse=True)
    chain = asked(with_shell("= idle.power_loss * 1 mm/W"), "inner_diameter")
    size, turns = chain.value.value, slopes["turns"]
    assert turns.slope.unit == "mm/rpm"
    assert turns.slope.value == pytest.approx(2 * size / 1500, rel=1e-6)
    viscosity = slopes["idle.dynamic_viscosity"]
    assert (viscosity.slope.unit, viscosity.slope.value) == (
        "mm/(mPa*s)",
        pytest.approx(size / 11.877, rel=1e-6),
    )


def test_a_criterion_has_the_slopes_of_its_value_and_what_helps_its_margin():
    slopes = of(PETROV, "loss")
    moving = {name: item.elasticity for name, item in slopes.items() if name != "most"}
    assert moving == pytest.approx(EXPONENTS, abs=1e-6)
    assert {name for name, item in slopes.items() if item.helps == "increase"} == {"play", "most"}
    assert {item.helps for name, item in slopes.items() if name not in ("play", "most")} == {"decrease"}
    assert (slopes["most"].elasticity, slopes["most"].slope.value, slopes["most"].slope.unit) == (0, 0, "W/W")


def test_a_place_that_does_not_matter_has_a_slope_of_zero():
    slopes = of(with_shell("= max(bore, other)"), "inner_diameter")
    assert slopes["bore"].elasticity == pytest.approx(1)
    assert (slopes["other"].slope.value, slopes["other"].elasticity, slopes["other"].helps) == (0, 0, None)


def test_a_value_of_zero_and_a_place_of_zero_have_no_elasticity():
    slopes = of(with_shell("= bore + 2 * offset", offset="0 mm"), "inner_diameter")
    assert slopes["bore"].elasticity == pytest.approx(1)
    assert slopes["offset"].elasticity is None
    assert slopes["offset"].slope.value == pytest.approx(2)
    raw = copy.deepcopy(PETROV)
    raw["criteria"] = {"alike": {"require": "bore - same <= 1 mm"}}
    raw["parameters"]["same"] = "50 mm"
    assert {n: (i.elasticity, round(i.slope.value, 6)) for n, i in of(raw, "alike").items()} == {
        "bore": (None, 1),
        "same": (None, -1),
    }


def test_temperatures_have_slopes_by_their_difference_and_no_elasticity():
    raw = copy.deepcopy(PETROV)
    raw["parameters"]["warm"] = "80 degC"
    raw["criteria"] = {
        "hot": {"require": "warm <= 100 degC"},
        "scaled": {"require": "bore * (warm / 300 K) <= 1 m"},
    }
    (warm,) = of(raw, "hot").values()
    assert (warm.elasticity, warm.slope.value, warm.helps) == (None, pytest.approx(1), "decrease")
    scaled = of(raw, "scaled")
    assert scaled["warm"].elasticity is None
    assert "delta_degC" in scaled["warm"].slope.unit
    assert scaled["bore"].elasticity == pytest.approx(1)


def test_a_place_at_the_end_of_its_range_has_the_slope_of_one_side():
    raw = copy.deepcopy(PETROV)
    raw["parameters"]["turns"] = "0 rpm"
    raw["criteria"] = {"force": {"require": "idle.friction_force <= 100 N"}}
    slopes = of(raw, "force")["turns"]
    assert slopes.elasticity is None
    assert slopes.reason.startswith("below: ")
    assert "0" in slopes.reason
    whole = copy.deepcopy(PETROV)
    whole["criteria"] = raw["criteria"]
    force = calculated(whole).value(ref("idle.friction_force"))
    assert (slopes.slope.unit, slopes.slope.value) == ("N/rpm", pytest.approx(float(force) / 1500))


def test_numbers_that_differences_cannot_tell_apart_have_a_reason():
    for least in ("4e-321 mm", "1e300 mm"):
        raw = with_shell("= bore + 0 * least", least=least)
        slopes = of(raw, "inner_diameter")
        assert slopes["bore"].elasticity == pytest.approx(1)
        assert slopes["least"].slope is None or slopes["least"].slope.value == 0
    assert of(with_shell("= bore + least", least="5e-321 m"), "inner_diameter")["least"].reason


def test_slopes_of_one_side_and_of_none():
    points = Local(np.array([1.0, 2.0]), np.array([0.1, 0.2]))
    estimated = slopes_at(points, np.array([5.0, np.nan, 4.0, np.nan, np.nan]))
    assert np.isnan(estimated.slopes[0])
    assert estimated.slopes[1] == pytest.approx(5)


def test_the_levels_are_those_of_the_design():
    raw = copy.deepcopy(PETROV)
    step = {
        "template": "oil_film",
        "version": 2,
        "inputs": dict(CATALOGUES.templates.get("oil_film", 2).example),
    }
    values = {}
    for level in ("short_bearing", "map"):
        raw["steps"]["film"] = {**step, "level": level}
        raw["criteria"] = {"thick": {"require": "film.minimum_film_thickness >= 1 um"}}
        values[level] = {n: i.elasticity for n, i in of(raw, "thick").items()}
    assert values["map"].keys() == values["short_bearing"].keys()
    assert values["map"] != pytest.approx(values["short_bearing"], rel=1e-3)


SHELL = {
    **PETROV,
    "models": {
        "shell": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {"inner_diameter": "= bore", "wall": "2 mm"},
        },
        "sleeve": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {"inner_diameter": "= play * 100 + shell.mass * 1 mm/kg"},
        },
    },
}


def test_a_value_that_waits_for_its_solid_has_no_slopes():
    chain = asked(SHELL, "sleeve.inner_diameter")
    assert chain.reason == "sleeve.inner_diameter waits for shell.mass"
    assert all(item.slope is None for item in chain.sensitivities)


def test_expensive_rows_are_left_to_a_study(monkeypatch):
    monkeypatch.setattr(module, "EXPENSIVE", 1e-9)
    chain = asked(PETROV, "loss")
    assert chain.sensitivities == []
    assert "13 rows would take too long to wait for" in chain.reason
    assert "study" in chain.reason


def test_a_criterion_along_a_curve_has_the_slopes_of_its_worst_place():
    raw = copy.deepcopy(CURVES)
    raw["criteria"] = {"loads": {"require": "loads.main_load_x <= bore * 1 MN/m"}}
    by_name = {item.name: item for item in asked(raw, "loads").sensitivities}
    where = int(np.argmax(calculated(raw).value(ref("loads.main_load_x"))))
    ends = []
    for bore in (85.9, 86.1):
        moved = {**raw, "parameters": {**raw["parameters"], "bore": f"{bore} mm"}}
        ends.append(calculated(moved).value(ref("loads.main_load_x"))[where])
    assert by_name["bore"].slope.unit == "N/mm"
    assert by_name["bore"].slope.value == pytest.approx((ends[1] - ends[0]) / 0.2, rel=1e-4)
    assert by_name["loads.strokes"].slope is None
    assert "whole number" in by_name["loads.strokes"].reason


def test_too_many_values_are_left_to_a_study(monkeypatch):
    monkeypatch.setattr(module, "MOST_VALUES", 100)
    chain = asked(PETROV, "loss")
    assert chain.sensitivities == []
    assert "13 rows with lists of this length would take too long; a study" in chain.reason


def test_a_literal_follows_from_nothing():
    assert of(with_shell("60 mm"), "inner_diameter") == {}


def test_more_places_than_are_listed_are_counted():
    many = {f"part_{n}": f"{1 + n} mm" for n in range(60)}
    chain = asked(with_shell(f"= {' + '.join(many)}", **many), "inner_diameter")
    assert len(chain.sensitivities) == module.MOST_SHOWN
    assert chain.reason == "the first 50 of 60 places are listed"
    assert chain.sensitivities[0].name == "part_59"


def test_an_unknown_name_is_not_found():
    with pytest.raises(NotFound):
        asked(PETROV, "nothing")


@pytest.mark.parametrize(
    ("over", "under", "name"),
    [
        ("um", "mm", "um/mm"),
        ("um", "N*m", "um/(N*m)"),
        ("W", "kg/m**3", "W*m**3/kg"),
        ("W/(m*K)", "mm**2/s", "W*s/(m*K*mm**2)"),
        ("1", "mm", "1/mm"),
        ("1", "1", "1"),
        ("degC", "degF", "delta_degC/delta_degF"),
        ("um", "mm²/s", "um*s/mm²"),
    ],
)
def test_the_unit_of_a_slope(over, under, name):
    assert slope_in(over, under, 1.0).unit == name


def test_the_unit_of_a_slope_is_in_base_units_where_names_are_long():
    long = "*".join(["kilogram"] * 4)
    slope = slope_in("N/" + "/".join(["millimeter"] * 4), long, 1.0)
    assert slope is not None
    assert slope.value == pytest.approx(1.0)
    assert len(slope.unit) < 40
