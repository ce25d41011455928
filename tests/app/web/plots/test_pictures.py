"""Property: names of outputs, and whether they are curves, determine the pictures of a calculation."""

from types import SimpleNamespace

import pytest

from app.calculations.schemas.evaluations import Output, UsedInput
from app.reports.pictures import Picture, pictures
from app.reports.plots import drawn
from app.web.shared.blocks import painted

CYCLE = [0.0, 90.0, 180.0, 270.0]


def declared(**units):
    return {name: {"title": name.replace("_", " "), "unit": unit} for name, unit in units.items()}


def template(inputs=None, outputs=None):
    return SimpleNamespace(inputs={"properties": inputs or {}}, outputs={"properties": outputs or {}})


def given(value, unit):
    return UsedInput(value=value, unit=unit, source="given")


def computed(value, unit):
    return Output(value=value, unit=unit)


def answer(outputs, inputs=None):
    return SimpleNamespace(inputs=inputs or {}, outputs=outputs)


def kinds(shown):
    return [picture.kind for picture in shown]


def test_curves_over_the_crank_angle_are_drawn_by_unit():
    curves = declared(crank_angle="deg", torque="N*m", gas_torque="N*m", gas_pressure="bar")
    outputs = {**curves, **declared(mean_torque="N*m")}
    evaluated = answer(
        {
            "crank_angle": computed(CYCLE, "deg"),
            "torque": computed([1.0, 2.0, 3.0, 4.0], "N*m"),
            "gas_torque": computed([1.0, 2.0, 3.0, 4.0], "N*m"),
            "gas_pressure": computed([1.0, 2.0, 3.0, 4.0], "bar"),
            "mean_torque": computed(2.5, "N*m"),
        }
    )
    shown = pictures(template(outputs=outputs), evaluated)
    assert kinds(shown) == ["curves", "curves"]
    assert [picture.names["y"] for picture in shown] == [["torque", "gas_torque"], ["gas_pressure"]]
    assert {picture.names["x"] for picture in shown} == {"crank_angle"}
    assert shown[0].for_script("engine")["scope"] == "engine"


def test_loads_make_a_polar_diagram_and_eccentricities_an_orbit():
    names = declared(pin_load_x="N", pin_load_y="N", eccentricity_x="1", eccentricity_y="1", other_load_x="N")
    evaluated = answer({name: computed(CYCLE, about["unit"]) for name, about in names.items()})
    shown = pictures(template(outputs=names), evaluated)
    assert kinds(shown) == ["polar", "orbit"]
    assert shown[0].title == "Polar diagram of the pin load"


def test_an_output_over_an_array_that_was_given_is_drawn_over_it():
    inputs, outputs = declared(speed="rpm", load="N"), declared(film="um")
    used = {"speed": given([1.0, 2.0, 3.0], "rpm"), "load": given(1.0, "N")}
    evaluated = answer({"film": computed([3.0, 2.0, None], "um")}, used)
    (picture,) = pictures(template(inputs, outputs), evaluated)
    assert (picture.kind, picture.names) == ("curves", {"x": "speed", "y": ["film"]})


def test_a_profile_is_drawn_along_what_it_says():
    outputs = declared(place="mm", pressure="MPa")
    outputs["pressure"]["along"] = "place"
    evaluated = answer({"place": computed(CYCLE, "mm"), "pressure": computed(CYCLE, "MPa")})
    (picture,) = pictures(template(outputs=outputs), evaluated)
    assert picture.names == {"x": "place", "y": ["pressure"]}


def test_a_list_by_members_is_not_drawn_over_another_list():
    """Loads of cylinders are no curve over the firing order, though both have four items."""
    loads = {"largest_load": {"title": "largest load", "unit": "N", "along": "cylinders"}}
    evaluated = answer({"largest_load": computed(CYCLE, "N")}, {"firing_order": given([1, 3, 4, 2], "1")})
    assert pictures(template(declared(firing_order="1"), loads), evaluated) == []
    del loads["largest_load"]["along"]
    assert kinds(pictures(template(declared(firing_order="1"), loads), evaluated)) == ["curves"]


def test_frequencies_make_a_campbell_diagram_and_mode_shapes():
    frequencies, shapes = computed([0.0, 80.0, 300.0], "Hz"), computed([[1.0, 1.0], [1.0, -1.0]], "1")
    used = {"engine_orders": given([1.0, 2.0], "1")}
    evaluated = answer({"natural_frequencies": frequencies, "mode_shapes": shapes}, used)
    outputs = declared(natural_frequencies="Hz", mode_shapes="1")
    assert kinds(pictures(template(declared(engine_orders="1"), outputs), evaluated)) == ["campbell", "modes"]


@pytest.mark.parametrize("value", [0.8, [0.8, 0.9, 0.95]])
def test_the_clearance_circle_is_drawn_for_one_point_only(value):
    outputs = declared(relative_eccentricity="1", minimum_film_thickness="um")
    evaluated = answer(
        {
            "relative_eccentricity": computed(value, "1"),
            "minimum_film_thickness": computed(value, "um"),
        }
    )
    expected = ["clearance"] if value == 0.8 else []
    assert kinds(pictures(template(outputs=outputs), evaluated)) == expected


def test_nothing_is_drawn_of_what_waits_or_does_not_exist():
    outputs = declared(relative_eccentricity="1", minimum_film_thickness="um")
    none = Output(value=None, unit="1", reason="no load")
    evaluated = answer(dict.fromkeys(outputs, none))
    assert pictures(template(outputs=outputs), evaluated) == []
    assert pictures(template(outputs=outputs), answer({})) == []
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
    film = SimpleNamespace(name="film", pictures=[Picture("pressure", "Film pressure", {"inputs": {}})])
    field = SimpleNamespace(name="shell.inner_diameter", text=relation)
    part = SimpleNamespace(name="shell", model=SimpleNamespace(film_bore=bore), fields=[field])
    shown = painted([film], [part])
    assert (shown or {}).get("model") == expected


SPEEDS = [1000.0, 2000.0, 3000.0, 4000.0]


def responses(table, speeds=None):
    names = declared(speeds="rpm")
    outputs = {"vibratory_torque": {"title": "vibratory torque", "unit": "N*m", "along": "speeds"}}
    evaluated = answer(
        {"vibratory_torque": computed(table, "N*m")}, {"speeds": speeds or given(SPEEDS, "rpm")}
    )
    return template(names, outputs), evaluated


def test_rows_over_given_speeds_are_responses():
    shown = pictures(*responses([[1.0, 5.0, 2.0, 1.0], [2.0, 3.0, None, 2.0]]))
    assert kinds(shown) == ["rows"]
    assert shown[0].for_script("torsion") == {
        "kind": "rows", "scope": "torsion", "x": "speeds", "y": "vibratory_torque", "rows": [1, 2],
    }  # fmt: skip


def test_of_many_rows_the_largest_are_shown_by_their_numbers():
    table = [[float(size)] * 4 for size in (3, 9, 1, 8, 7, -6, 5, 4)]
    (picture,) = pictures(*responses(table))
    assert picture.names["rows"] == [2, 4, 5, 6, 7, 8]


def test_a_report_draws_a_line_for_each_row():
    (plot,) = drawn(*responses([[1.0, 5.0, 2.0, 1.0], [2.0, 3.0, None, 2.0]]))
    assert plot.title == "vibratory torque over speeds, by number"
    assert ">no. 1<" in plot.svg
    assert ">no. 2<" in plot.svg
    lines = [part for part in plot.svg.split("<path ") if 'stroke-width="1.6"' in part]
    assert [line.count("L") + line.count("M") for line in lines] == [4, 3]


@pytest.mark.parametrize("table", [[], None, [[1.0, 2.0]], [[[1.0], [2.0], [3.0], [4.0]]], 3.0, [["a"] * 4]])
def test_what_is_no_table_over_the_speeds_is_not_drawn(table):
    assert "rows" not in kinds(pictures(*responses(table)))


def test_rows_over_a_computed_axis_are_not_drawn():
    """An engine has eight such arrays over the crank angle; its polar diagrams and films show them."""
    assert pictures(*responses([[1.0] * 4] * 2, computed(SPEEDS, "rpm"))) == []


def test_the_campbell_diagram_ends_at_the_last_speed():
    names = declared(natural_frequencies="Hz", engine_orders="1")
    evaluated = answer(
        {
            "natural_frequencies": computed([50.0, 90.0, 400.0], "Hz"),
            "engine_orders": computed([0.5, 1.0], "1"),
        },
        {"speeds": given(SPEEDS, "rpm")},
    )
    shown = pictures(template(declared(speeds="rpm"), names), evaluated)
    assert [one.names["range"] for one in shown if one.kind == "campbell"] == ["speeds"]
    plot = next(
        one for one in drawn(template(declared(speeds="rpm"), names), evaluated) if "Campbell" in one.title
    )
    assert ">4000<" in plot.svg
    assert ">5000<" not in plot.svg


def test_a_measurement_is_drawn_over_its_own_angles_and_as_measured_beside_the_calculation():
    """Also where there are as many angles of the one as of the other."""
    inputs = declared(crank_angle="deg", measured_angle="deg", calculated_film="um", measured_film="um")
    outputs = {"film_as_measured": {"title": "film as measured", "unit": "um", "along": "crank_angle"}}
    film = [3.0, 4.0, 5.0, 4.0]
    evaluated = answer(
        {"film_as_measured": computed(film, "um")},
        {
            "crank_angle": given(CYCLE, "deg"),
            "measured_angle": given([10.0, 100.0, 190.0, 280.0], "deg"),
            "calculated_film": given(film, "um"),
            "measured_film": given(film, "um"),
        },
    )
    shown = pictures(template(inputs, outputs), evaluated)
    assert [(one.names["x"], one.names["y"]) for one in shown] == [
        ("crank_angle", ["calculated_film", "film_as_measured"]),
        ("measured_angle", ["measured_film"]),
    ]
