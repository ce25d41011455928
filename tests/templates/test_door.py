"""Templates from Python return the numbers of `evaluate`, as quantities."""

import numpy as np
import pint
import pytest

from templates import NoValue, get
from templates.core.errors import InvalidInputs, UnknownTemplate
from templates.core.language.evaluate import evaluate
from templates.core.units.units import registry
from templates.door import built_in

FILM = get("oil_film", 2)
CHEAP = [cls for cls in built_in() if cls.id != "oil_film_cycle"]  # whose example is the shortest to compute


@pytest.mark.parametrize("cls", CHEAP, ids=lambda cls: f"{cls.id}_v{cls.version}")
def test_every_output_is_that_of_evaluate(cls):
    answers = evaluate(cls, cls.example)
    calculation = get(cls.id, cls.version)(**cls.example)
    for name, answer in answers.outputs.items():
        if answer.value is None:
            with pytest.raises(NoValue, match=name):
                getattr(calculation, name)
        elif answer.unit is None:
            assert np.array_equal(getattr(calculation, name), answer.value)
        else:
            quantity = getattr(calculation, name)
            assert np.array_equal(quantity.magnitude, answer.value, equal_nan=True)
            assert quantity.units == registry.Unit("" if answer.unit == "1" else answer.unit)
    assert calculation.warnings == answers.warnings
    assert calculation.level == answers.level


def test_only_what_is_asked_for_is_computed():
    film = FILM(**FILM.example)
    assert film.sommerfeld_number.magnitude > 0
    assert "psi" in vars(film.template)
    assert "h_min" not in vars(film.template)
    assert set(film.error) == {"sommerfeld_number"}


def test_the_error_of_a_result_that_nobody_asked_for_is_computed():
    film = FILM(**FILM.example)
    expected = evaluate(FILM.template, FILM.example, outputs=["minimum_film_thickness"]).error
    assert film.error["minimum_film_thickness"] == expected["minimum_film_thickness"]


def test_quantities_of_any_registry_are_read_by_their_units():
    other = pint.UnitRegistry()
    loads = other.Quantity(np.array([20.0, 25.0]), "kN")
    film = FILM(**{**FILM.example, "radial_load": loads, "speed": other.Quantity(5000.0, "rpm")})
    written = {**FILM.example, "radial_load": {"value": [20, 25], "unit": "kN"}}
    expected = evaluate(FILM.template, written).outputs["minimum_film_thickness"].value
    assert np.array_equal(film.minimum_film_thickness.magnitude, expected)
    assert film.radial_load.to("kN").magnitude == pytest.approx([20.0, 25.0], rel=1e-15)


def test_a_quantity_in_hertz_is_refused_as_a_speed():
    speed = registry.Quantity(83.3, "Hz")
    with pytest.raises(InvalidInputs) as refused:
        FILM(**{**FILM.example, "speed": speed})
    assert [fault.name for fault in refused.value.faults] == ["speed"]


def test_all_wrong_inputs_are_named_at_once():
    with pytest.raises(InvalidInputs) as refused:
        FILM(**{**FILM.example, "radial_load": "3 mm", "bearing_diametre": "48 mm"})
    assert {fault.name for fault in refused.value.faults} == {"radial_load", "bearing_diametre"}


def test_a_tolerance_takes_the_cheapest_level_that_meets_it():
    levels = [
        FILM(**FILM.example, tolerance=wanted, outputs=["minimum_film_thickness"]).level
        for wanted in (1.0, 0.05, 1e-3)
    ]
    assert levels == ["short_bearing", "map", "map"]


def test_a_tolerance_is_about_the_outputs_named():
    film = FILM(**FILM.example, tolerance=0.05, outputs=["minimum_film_thickness"])
    assert film.error["minimum_film_thickness"] <= 0.05
    with pytest.raises(InvalidInputs, match="power_loss"):
        _ = film.power_loss
    with pytest.raises(InvalidInputs, match="tolerance"):
        FILM(**FILM.example, outputs=["power_loss"])


def test_points_without_a_value_say_why():
    film = FILM(**{**FILM.example, "radial_load": {"value": [0, 25], "unit": "kN"}})
    friction = film.friction_coefficient.magnitude
    assert np.array_equal(np.isnan(friction), [True, False])
    assert film.reasons("friction_coefficient")[0]
    assert film.reasons("friction_coefficient")[1] is None


def test_an_optional_input_that_was_not_given_has_no_value():
    with pytest.raises(NoValue, match="ambient_temperature"):
        _ = FILM(**FILM.example).ambient_temperature


def test_an_unknown_name_is_refused_with_the_nearest():
    with pytest.raises(AttributeError, match="minimum_film_thickness"):
        _ = FILM(**FILM.example).minimum_film_thicknes
    with pytest.raises(UnknownTemplate, match="oil_film"):
        get("oil_flim")
    with pytest.raises(InvalidInputs, match="reynolds"):
        FILM(**FILM.example, level="reynold")


def test_a_version_describes_itself():
    assert get("oil_film").template is built_in().latest("oil_film")
    assert FILM.inputs["radial_load"] == "N"
    assert FILM.inputs["viscosity_law"] is None
    assert FILM.outputs["minimum_film_thickness"] == "um"
    assert FILM.outputs["lubrication_regime"] is None
    assert FILM.levels == ("short_bearing", "fit", "map", "reynolds", "mass_conserving")
    film = FILM(**FILM.example)
    assert {"minimum_film_thickness", "radial_load", "error", "level"} <= set(dir(film))
    assert repr(film) == "<a calculation of oil_film 2 at level map>"
