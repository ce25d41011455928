"""Property: a calculation gets its pictures by what its outputs are called, and whether they are curves."""

from types import SimpleNamespace

import pytest

from app.web.pictures import Picture, painted, pictures

CYCLE = [0.0, 90.0, 180.0, 270.0]


def declared(**units):
    return {name: {"title": name.replace("_", " "), "unit": unit} for name, unit in units.items()}


def template(inputs=None, outputs=None):
    return {"inputs": {"properties": inputs or {}}, "outputs": {"properties": outputs or {}}}


def given(value, unit):
    return {"value": value, "unit": unit, "from": "given"}


def found(value, unit):
    return {"value": value, "unit": unit}


def kinds(shown):
    return [picture.kind for picture in shown]


def test_curves_over_the_crank_angle_are_drawn_by_unit():
    curves = declared(crank_angle="deg", torque="N*m", gas_torque="N*m", gas_pressure="bar")
    outputs = {**curves, **declared(mean_torque="N*m")}
    told = {
        "inputs": {},
        "outputs": {
            "crank_angle": found(CYCLE, "deg"),
            "torque": found([1.0, 2.0, 3.0, 4.0], "N*m"),
            "gas_torque": found([1.0, 2.0, 3.0, 4.0], "N*m"),
            "gas_pressure": found([1.0, 2.0, 3.0, 4.0], "bar"),
            "mean_torque": found(2.5, "N*m"),
        },
    }
    shown = pictures("engine", template(outputs=outputs), told)
    assert kinds(shown) == ["curves", "curves"]
    assert [picture.names["y"] for picture in shown] == [["torque", "gas_torque"], ["gas_pressure"]]
    assert {picture.names["x"] for picture in shown} == {"crank_angle"}
    assert shown[0].told("engine")["scope"] == "engine"


def test_loads_make_a_polar_diagram_and_eccentricities_an_orbit():
    names = declared(pin_load_x="N", pin_load_y="N", eccentricity_x="1", eccentricity_y="1", other_load_x="N")
    told = {"inputs": {}, "outputs": {name: found(CYCLE, about["unit"]) for name, about in names.items()}}
    shown = pictures("", template(outputs=names), told)
    assert kinds(shown) == ["polar", "orbit"]
    assert shown[0].title == "Polar diagram of the pin load"


def test_an_output_over_an_array_that_was_given_is_drawn_over_it():
    inputs, outputs = declared(speed="rpm", load="N"), declared(film="um")
    told = {
        "inputs": {"speed": given([1.0, 2.0, 3.0], "rpm"), "load": given(1.0, "N")},
        "outputs": {"film": found([3.0, 2.0, None], "um")},
    }
    (picture,) = pictures("", template(inputs, outputs), told)
    assert (picture.kind, picture.names) == ("curves", {"x": "speed", "y": ["film"]})


def test_a_profile_is_drawn_along_what_it_says():
    outputs = declared(place="mm", pressure="MPa")
    outputs["pressure"]["along"] = "place"
    told = {"inputs": {}, "outputs": {"place": found(CYCLE, "mm"), "pressure": found(CYCLE, "MPa")}}
    (picture,) = pictures("", template(outputs=outputs), told)
    assert picture.names == {"x": "place", "y": ["pressure"]}


def test_frequencies_make_a_campbell_diagram_and_mode_shapes():
    told = {
        "inputs": {"engine_orders": given([1.0, 2.0], "1")},
        "outputs": {
            "natural_frequencies": found([0.0, 80.0, 300.0], "Hz"),
            "mode_shapes": found([[1.0, 1.0], [1.0, -1.0]], "1"),
        },
    }
    outputs = declared(natural_frequencies="Hz", mode_shapes="1")
    assert kinds(pictures("", template(declared(engine_orders="1"), outputs), told)) == ["campbell", "modes"]


@pytest.mark.parametrize("value", [0.8, [0.8, 0.9, 0.95]])
def test_the_clearance_circle_is_drawn_for_one_point_only(value):
    outputs = declared(relative_eccentricity="1", minimum_film_thickness="um")
    told = {
        "inputs": {},
        "outputs": {
            "relative_eccentricity": found(value, "1"),
            "minimum_film_thickness": found(value, "um"),
        },
    }
    expected = ["clearance"] if value == 0.8 else []
    assert kinds(pictures("", template(outputs=outputs), told)) == expected


def test_nothing_is_drawn_of_what_waits_or_does_not_exist():
    outputs = declared(relative_eccentricity="1", minimum_film_thickness="um")
    none = {"value": None, "unit": "1", "reason": "no load"}
    told = {"inputs": {}, "outputs": dict.fromkeys(outputs, none)}
    assert pictures("", template(outputs=outputs), told) == []
    assert pictures("", template(outputs=outputs), {"inputs": {}, "outputs": {}}) == []
    assert painted([], []) is None


@pytest.mark.parametrize(
    ("bore", "relation", "expected"),
    [
        ("inner_diameter", "= film.bearing_diameter", "shell"),
        (None, "= film.bearing_diameter", None),
        ("inner_diameter", "= other.bearing_diameter", None),
    ],
)
def test_the_film_pressure_is_painted_on_a_bore_with_a_film_only(bore, relation, expected):
    film = {"name": "film", "pictures": [Picture("pressure", "Film pressure", {"inputs": {}})]}
    field = SimpleNamespace(name="shell.inner_diameter", text=relation)
    shown = painted([film], [{"name": "shell", "model": {"film_bore": bore}, "fields": [field]}])
    assert (shown or {}).get("model") == expected
