"""`crankshaft` 1 with undivided pins: closed forms, measurements, separate throws, lists, refusals."""

import json
from cmath import exp
from math import cos, pi, radians, sin
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest
from undivided import TWO_THROWS

import templates
from benchmarks.in_line_four import IN_LINE_FOUR
from cad.cranks.outline import Outline, reach
from cad.lists import LONGEST_TEXT, listed, written
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import Build, as_text, build_key, regenerate
from cad.shaft import STEEL_DENSITY
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template
from tests.references.throw_measures import rotating_couple, throws_measured

PLAIN: dict[str, Any] = {
    "journal_diameter": "55 mm", "journal_length": "26 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "throw": "43 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "2 mm",
}  # fmt: skip
PITCH = 94.0


def degrees(*angles: float) -> dict[str, Any]:
    return {"value": list(angles), "unit": "deg"}


def build(given: dict[str, Any]) -> Build:
    return regenerate("crankshaft", 1, Crankshaft.from_quantities(given).inputs_si())


def refused(given: dict[str, Any]) -> dict[str, str]:
    with pytest.raises(InvalidInputs) as caught:
        as_text(Crankshaft.from_quantities(given))
    return {name: fault.detail for fault in caught.value.faults for name in fault.names}


@pytest.fixture(scope="module")
def cross() -> Build:
    """A cross-plane shaft of four throws with unequal counterweights, drilled and bored."""
    radii = {"value": [70, 0, 0, 72, 70, 0, 0, 70], "unit": "mm"}
    return build({**TWO_THROWS, "pin_angles": degrees(0, 90, 270, 180), "counterweight_radius": radii})


@pytest.mark.parametrize("angles", [(0,), (0, 180), (0, 120, 240), (30, 102, 174, 246, 318)])
def test_analytic_volume_is_that_of_its_parts(angles: tuple[float, ...]) -> None:
    """The closed form against one put together here from the volumes of throws from mid-main to mid-main."""
    ends = {"nose_length": "30 mm", "nose_diameter": "40 mm", "flange_thickness": "12 mm",
            "flange_diameter": "80 mm"}  # fmt: skip
    throw = CrankThrow.from_quantities(PLAIN).build()[0].volume
    wanted = len(angles) * throw + pi * (27.5**2 * 26 + 20**2 * 30 + 40**2 * 12)
    measured = build({**PLAIN, **ends, "pin_angles": degrees(*angles)}).measures["volume"]
    assert measured == pytest.approx(wanted, rel=1e-9)


def test_analytic_one_throw_and_its_cylinders() -> None:
    """A bored throw with counterweights, half a main more on either side, a nose and a plain flange."""
    inside = {**PLAIN, "journal_bore": "12 mm", "pin_bore": "10 mm", "web_shape": "rectangular"}
    inside |= {"counterweight_radius": "70 mm", "counterweight_angle": "130 deg", "face_inclination": "6 deg"}
    ends = {"nose_length": "45 mm", "nose_diameter": "30 mm", "flange_thickness": "12 mm"}
    whole = build({**inside, **ends, "flange_diameter": "70 mm", "pin_angles": degrees(0)}).measures
    throw = regenerate("crank_throw", 1, CrankThrow.from_quantities(inside).inputs_si()).measures
    cylinders = [(27.5, 13.0, -6.5), (15.0, 45.0, -35.5), (27.5, 13.0, 100.5), (35.0, 12.0, 113.0)]
    masses = [STEEL_DENSITY * 1e-9 * pi * (r**2 - 6**2) * length for r, length, _ in cylinders]
    polar = sum(m * (r**2 + 6**2) / 2 * 1e-6 for m, (r, *_) in zip(masses, cylinders, strict=True))
    along = sum(m * z for m, (*_, z) in zip(masses, cylinders, strict=True))
    mass = throw["mass"] + sum(masses)
    assert whole["mass"] == pytest.approx(mass, rel=1e-9)
    assert whole["polar_inertia"] == pytest.approx(throw["polar_inertia"] + polar, rel=1e-9)
    assert whole["mass"] * whole["centre_x"] == pytest.approx(throw["mass"] * throw["centre_x"], rel=1e-9)
    assert whole["mass"] * whole["centre_z"] == pytest.approx(throw["mass"] * 47.0 + along, rel=1e-9)
    assert (whole["low_z"], whole["high_z"]) == pytest.approx((-13 - 45, 94 + 13 + 12), abs=1e-6)


@pytest.mark.slow
def test_analytic_rotating_couple_of_any_angles(cross: Build) -> None:
    """Throws of the same shape, turned: each adds what one throw has, at its place and angle."""
    angles = (17.0, 105.0, 260.0)
    given = {**PLAIN, "flange_diameter": "80 mm"}
    alone = build({**given, "pin_angles": degrees(0)}).measures
    unbalance = alone["mass"] * alone["centre_x"] * 1e-3
    couple = build({**given, "pin_angles": degrees(*angles)}).measures
    places = [(k + 0.5) * PITCH * 1e-3 for k in range(3)]
    wanted = sum(unbalance * z * exp(1j * radians(a)) for z, a in zip(places, angles, strict=True))
    assert abs(rotating_couple(couple) - wanted) < 1e-8 * abs(unbalance) * places[-1]
    centre = couple["mass"] * complex(couple["centre_x"], couple["centre_y"]) * 1e-3
    assert abs(centre - unbalance * sum(exp(1j * radians(a)) for a in angles)) < 1e-8 * unbalance


def test_symmetric_shaft_of_an_in_line_four_has_no_couple() -> None:
    four = build({**PLAIN, "pin_angles": degrees(0, 180, 180, 0)}).measures
    middle = complex(four["centre_x"], four["centre_y"]) * four["mass"] * 2 * PITCH * 1e-6
    scale = four["mass"] * 43e-3 * 4 * PITCH * 1e-3
    assert abs(rotating_couple(four) - middle) < 1e-9 * scale
    assert abs(complex(four["centre_x"], four["centre_y"])) < 1e-9 * 43


def test_rotating_couple_is_that_of_the_engine() -> None:
    """Mass moments of the solid's throws as unbalance of `engine` 1: its couple over ω² is the solid's."""
    angles = (0.0, 90.0, 270.0, 180.0)
    throws = throws_measured(
        build({**PLAIN, "pin_angles": degrees(*angles)}).step, [k * PITCH for k in range(1, 4)]
    )
    engine = find([Path(templates.__file__).parent], Template).get("engine", 1)
    without = {name: value for name, value in IN_LINE_FOUR.items() if not name.startswith(("web", "count"))}
    without |= {"speed": "3000 rpm", "pin_angles": degrees(*angles), "reference_position": "0 mm"}
    unbalance = {"value": [abs(one.unbalance) * 1e3 for one in throws], "unit": "kg*mm"}
    names = "shaking_moment_x", "shaking_moment_y"
    moments = [
        [np.array(evaluate(engine, given, outputs=names).outputs[name].value)[0] for name in names]
        for given in (without, {**without, "crank_unbalance": unbalance})
    ]
    x, y = np.subtract(moments[1], moments[0])  # at crank angle 0, where the line of reference stands at x
    couple = (x + 1j * y) / 1j / (3000 * pi / 30) ** 2
    wanted = sum(one.couple for one in throws)
    assert abs(wanted) > 0.1 * abs(throws[0].unbalance) * PITCH * 1e-3
    assert abs(couple - wanted) < 1e-8 * abs(wanted)


@pytest.mark.slow
def test_throws_cut_at_the_mains_add_up_to_the_whole(cross: Build) -> None:
    throws = throws_measured(cross.step, [k * PITCH for k in range(1, 4)])
    assert len(throws) == 4
    measures = cross.measures
    assert sum(t.mass for t in throws) == pytest.approx(measures["mass"], rel=1e-9)
    assert sum(t.polar_inertia for t in throws) == pytest.approx(measures["polar_inertia"], rel=1e-9)
    scale = sum(abs(t.unbalance) for t in throws)
    whole = measures["mass"] * complex(measures["centre_x"], measures["centre_y"]) * 1e-3
    assert abs(sum(t.unbalance for t in throws) - whole) < 1e-9 * scale
    couple = rotating_couple(measures)
    assert abs(sum(t.couple for t in throws) - couple) < 1e-9 * scale * 4 * PITCH * 1e-3


def test_throw_of_pins_and_webs_alone_has_the_unbalance_of_a_drawing() -> None:
    given = {**PLAIN, "fillet": "0 mm", "web_shape": "rectangular", "pin_angles": degrees(0)}
    (throw,) = throws_measured(build(given).step, [])
    h, R, t = 40.0, 43.0, 18.0
    web = 2 * h * (R + 2 * h) * t * (R / 2)
    wanted = STEEL_DENSITY * 1e-12 * (2 * web + pi * 24**2 * 32 * R)
    assert throw.unbalance == pytest.approx(wanted, rel=1e-9)


def test_counterweights_move_the_unbalance_of_their_web_alone() -> None:
    radii = {"value": [70, 0, 0, 0], "unit": "mm"}
    given = {**PLAIN, "pin_angles": degrees(0, 90), "counterweight_angle": "120 deg"}
    plain = throws_measured(build(given).step, [PITCH])
    heavy = throws_measured(build({**given, "counterweight_radius": radii}).step, [PITCH])
    a, t = radians(60), 18.0
    sector = 2 / 3 * sin(a) * (70**3 - 40**3) * t  # about the axis, beyond the round end of the web
    assert plain[0].unbalance - heavy[0].unbalance == pytest.approx(sector * STEEL_DENSITY * 1e-12, rel=1e-8)
    assert heavy[1].unbalance == pytest.approx(plain[1].unbalance, rel=1e-9)


@pytest.mark.parametrize("rectangular", [False, True])
@pytest.mark.parametrize("counterweight", [0.0, 75.0])
def test_analytic_reach_is_that_of_points_along_the_outline(rectangular: bool, counterweight: float) -> None:
    outline = Outline(42, 40, rectangular, counterweight, radians(50))
    turn = np.linspace(0, 2 * pi, 100_001)
    tips = [42 + 40 * np.exp(1j * turn), 40 * np.exp(1j * turn)] if not rectangular else []
    corners = [np.array([82 + 40j, 82 - 40j, -40 + 40j, -40 - 40j])] if rectangular else []
    rim = [-75 * np.exp(1j * np.linspace(-radians(50), radians(50), 50_001))] if counterweight else []
    points = np.concatenate([*tips, *corners, *rim])
    for direction in np.linspace(0, 2 * pi, 37):
        wanted = float((points * np.exp(-1j * direction)).real.max())
        assert reach(outline, float(direction)) == pytest.approx(wanted, abs=1e-5)
        assert reach(outline, float(direction) + 2 * pi) == pytest.approx(wanted, abs=1e-5)


class TestLists:
    def test_text_and_object_are_the_same_build(self) -> None:
        one = Crankshaft.from_quantities({**PLAIN, "pin_angles": "[0, 180] deg"})
        other = Crankshaft.from_quantities({**PLAIN, "pin_angles": degrees(0, 180)})
        assert build_key(one) == build_key(other)
        assert as_text(one)["pin_angles"] == "[0, 180] deg"

    def test_noise_is_the_same_build_and_another_angle_is_not(self) -> None:
        keys = {build_key(Crankshaft.from_quantities({**PLAIN, "pin_angles": degrees(*pair)}))
                for pair in ((0, 180), (3e-14, 180.00000000000003))}  # fmt: skip
        assert len(keys) == 1
        other = Crankshaft.from_quantities({**PLAIN, "pin_angles": degrees(0, 180.0001)})
        assert build_key(other) not in keys

    @pytest.mark.parametrize("values", [[0.0], [1 / 3, -2.5e-7, 1e5], [720.0] * 16])
    def test_written_lists_come_back(self, values: list[float]) -> None:
        quantity = listed(written(values, "deg"))
        assert quantity["unit"] == "deg"
        assert quantity["value"] == pytest.approx(values, rel=1e-11, abs=1e-11)

    @pytest.mark.parametrize("text", ["[]", "[1, x] deg", "[[1]] deg", "1 deg", "[1" * 900, "[1, 2] deg]"])
    def test_other_texts_stay_as_they_are(self, text: str) -> None:
        assert listed(text) == text

    def test_long_text_is_no_list(self) -> None:
        text = "[" + "1, " * LONGEST_TEXT + "1] deg"
        assert listed(text) == text

    @pytest.mark.slow
    def test_long_list_stands_in_several_strings_of_the_header(self) -> None:
        radii = [70 + n / 7 for n in range(32)]
        given = {**PLAIN, "pin_angles": degrees(*(22.5 * n for n in range(16)))}
        given |= {"counterweight_radius": {"value": radii, "unit": "mm"}}
        shaft = build(given)
        header = shaft.step.split(b"ENDSEC;")[0].decode()
        assert max(map(len, header.split(",\n"))) <= 258 + 4
        again = regenerate("crankshaft", 1, Crankshaft.from_quantities(given).inputs_si())
        assert again.key == shaft.key
        assert json.loads(json.dumps(shaft.parameters)) == shaft.parameters

    @pytest.mark.parametrize(
        ("given", "named"),
        [
            ({}, {"pin_angles"}),
            ({"pin_angles": "0 deg"}, {"pin_angles"}),
            ({"pin_angles": []}, {"pin_angles"}),
            ({"pin_angles": [0, 180]}, {"pin_angles"}),
            ({"pin_angles": {"value": [[0, 180]], "unit": "deg"}}, {"pin_angles"}),
            ({"pin_angles": degrees(0, 721)}, {"pin_angles"}),
            ({"pin_angles": {"value": [0, 180], "unit": "mm"}}, {"pin_angles"}),
            ({"pin_angles": degrees(*range(17))}, {"pin_angles"}),
            ({"pin_angles": degrees(*([0.0] * 10_000))}, {"pin_angles"}),
            ({"throw": {"value": [40, 41], "unit": "mm"}}, {"throw"}),
            ({"counterweight_radius": {"value": [70, 0, 0], "unit": "mm"}}, {"counterweight_radius"}),
            ({"counterweight_radius": {"value": [70, 0, 0, 40.5], "unit": "mm"}}, {"counterweight_radius"}),
            ({"counterweight_radius": {"value": [70, 0, 0, -1], "unit": "mm"}}, {"counterweight_radius"}),
            ({"bolt_hole_diameter": "40 mm"}, {"bolt_hole_diameter"}),
            ({"bolt_hole_diameter": "9 mm", "bolt_holes": 40}, {"bolt_holes"}),
            ({"bolt_hole_diameter": "9 mm", "bolt_hole_depth": "90 mm"}, {"bolt_hole_depth"}),
            ({"bolt_holes": 2.5}, {"bolt_holes"}),
            ({"fillet": "12 mm"}, {"fillet"}),
        ],
        ids=str,
    )
    def test_what_cannot_be_built_is_refused_by_name(self, given: dict[str, Any], named: set[str]) -> None:
        pins = {} if given == {} else {"pin_angles": degrees(0, 180)}
        assert named <= set(refused({**PLAIN, **pins, **given}))

    def test_refusal_says_how_many_are_right(self) -> None:
        radii = {"value": [70, 0, 0], "unit": "mm"}
        detail = refused({**PLAIN, "pin_angles": degrees(0, 180), "counterweight_radius": radii})
        assert "two for each throw" in detail["counterweight_radius"]


def test_turned_pin_is_where_it_should_be() -> None:
    measures = build({**PLAIN, "pin_angles": degrees(90), "flange_diameter": "70 mm"}).measures
    assert (measures["high_y"], measures["low_y"]) == (83, -40)
    measures = build({**PLAIN, "pin_angles": degrees(30), "flange_diameter": "70 mm"}).measures
    assert measures["high_x"] == pytest.approx(40 + 43 * cos(pi / 6), abs=1e-5)


@pytest.mark.slow
def test_four_throws_take_less_than_two_seconds_of_the_processor() -> None:
    """Drawn, written, read again, measured and checked; the better of two, as the machine has other work."""
    radii = {"value": [70, 0, 0, 70, 70, 0, 0, 70], "unit": "mm"}
    given = {**TWO_THROWS, "pin_angles": degrees(0, 180, 180, 0), "counterweight_radius": radii}
    times = []
    for _ in range(2):
        started = process_time()
        build(given)
        times.append(process_time() - started)
    assert min(times) < 2
