"""`crankshaft` 1, split pins: volume and unbalance in closed form, an engine's pins, refusals by name."""

from cmath import exp
from math import cos, pi, radians, remainder, sin
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize
from undivided import TWO_THROWS

from app.solids.analysis_process import throw_of
from app.solids.questions import Question
from benchmarks.in_line_four import IN_LINE_FOUR
from cad.cranks.chain_throw import shaft_of_throws, sizes_of_throw, throws_apart
from cad.cranks.split_parameters import least_gap
from cad.errors import AnalysisError
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import Build, as_text, regenerate
from cad.shaft import STEEL_DENSITY
from templates.bearing_load.engine_v1 import Engine
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from tests.references.throw_measures import rotating_couple, throws_measured

PLAIN: dict[str, Any] = {
    "journal_diameter": "55 mm", "journal_length": "26 mm", "pin_diameter": "48 mm", "pin_length": "24 mm",
    "throw": "43 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "2 mm",
}  # fmt: skip
MIDDLE = {"pin_split": "30 deg", "middle_web_thickness": "9 mm", "middle_web_width": "60 mm"}
PITCH = 2 * (24 + 18) + 9 + 26.0


def angles(*values: float) -> dict[str, Any]:
    return {"value": list(values), "unit": "deg"}


def loads_only(example: dict[str, Any]) -> dict[str, Any]:
    """The example of an engine without its mains, webs and elastic crank."""
    left_out = ("main", "web", "counterweights", "support", "journal", "crankpin")
    return {name: value for name, value in example.items() if not name.startswith(left_out)}


def build(given: dict[str, Any]) -> Build:
    return regenerate("crankshaft", 1, Crankshaft.from_quantities(given).inputs_si())


def refused(given: dict[str, Any]) -> dict[str, str]:
    with pytest.raises(InvalidInputs) as caught:
        as_text(Crankshaft.from_quantities(given))
    return {name: fault.detail for fault in caught.value.faults for name in fault.names}


def test_pins_split_by_a_whole_turn_are_undivided_to_the_byte() -> None:
    given = {**TWO_THROWS, "pin_angles": angles(0), "counterweight_radius": "70 mm"}
    none, turn = (build({**given, "pin_split": split}) for split in ("0 deg", "360 deg"))
    assert turn.step.split(b"ENDSEC;", 1)[1] == none.step.split(b"ENDSEC;", 1)[1]
    assert turn.measures == none.measures


@pytest.mark.parametrize(
    "split", [-60.0, *(pytest.param(one, marks=pytest.mark.slow) for one in (30.0, 180.0))]
)
def test_analytic_volume_is_that_of_its_parts(split: float) -> None:
    """Against the undivided shaft: a pin with its fillets more for each throw, and the middle web."""
    pins = {**PLAIN, "pin_angles": angles(10, 130)}
    divided = {**MIDDLE, "pin_split": {"value": split, "unit": "deg"}}
    fillets = 2 * 2 * pi * ((1 - pi / 4) * 2**2 * 24 + (5 / 6 - pi / 4) * 2**3)
    web = 9 * (pi * 30**2 + 60 * 2 * 43 * abs(sin(radians(split) / 2)))
    more = 2 * (pi * 24**2 * 24 + fillets + web)
    undivided = Crankshaft.from_quantities(pins).build()[0].volume
    assert build({**pins, **divided}).measures["volume"] == pytest.approx(undivided + more, rel=1e-9)


def test_throw_of_pins_and_webs_alone_has_the_unbalance_of_a_drawing() -> None:
    given = {**PLAIN, **MIDDLE, "fillet": "0 mm", "web_shape": "rectangular", "pin_angles": angles(20)}
    whole = build(given)
    (throw,) = throws_measured(whole.step, [])
    front, rear = (exp(1j * radians(angle)) for angle in (20, 50))
    h, R, t, d = 40.0, 43.0, 18.0, 2 * 43 * sin(radians(15))
    web, pin = 2 * h * (R + 2 * h) * t * R / 2, pi * 24**2 * 24 * R
    middle = (pi * 30**2 + 60 * d) * 9 * R * (front + rear) / 2
    density = STEEL_DENSITY * 1e-12
    assert abs(throw.unbalance / (density * ((web + pin) * (front + rear) + middle)) - 1) < 1e-9
    first, second = PITCH / 2 - 4.5 - 24, PITCH / 2 + 4.5 + 24  # [mm] inner faces of the outer webs
    couple = web * ((first - 9) * front + (second + 9) * rear)
    couple += pin * ((first + 12) * front + (second - 12) * rear) + middle * PITCH / 2
    assert abs(rotating_couple(whole.measures) / (density * couple * 1e-3) - 1) < 1e-9


def test_pins_stand_where_an_engine_has_them() -> None:
    """A V6 of 90° that fires evenly: pins 30° apart on each throw, read from the solid."""
    engine = {
        **loads_only(IN_LINE_FOUR), "firing_order": [1, 2, 3, 4, 5, 6],
        "bank_angles": angles(-45, 45, -45, 45, -45, 45),
        "throws": [1, 1, 2, 2, 3, 3], "pins_of_a_throw": "split", "cylinder_offset": "0 mm",
        "cylinder_positions": {"value": [30, 64, 147, 181, 264, 298], "unit": "mm"},
    }  # fmt: skip
    answer = evaluate(Engine, engine, outputs=["crankpin_angles", "pin_split"]).outputs
    pins = np.asarray(answer["crankpin_angles"].value)
    split = {"value": float(pins[1] - pins[0]), "unit": "deg"}
    assert abs(remainder(split["value"], 360)) == pytest.approx(30)
    given = {**PLAIN, "pin_angles": angles(*pins[::2].tolist()), "pin_split": split}
    made = build(given).dimensions
    front, apart = np.asarray(made["pin_angles"]), made["pin_split"]
    seen = np.ravel([[angle, angle + apart] for angle in front])
    assert [remainder(a - b, 360) for a, b in zip(seen, pins, strict=True)] == pytest.approx(
        [0] * 6, abs=1e-6
    )


def test_throws_apart_add_up_to_the_volume_between_the_mains() -> None:
    given = {**PLAIN, **MIDDLE, "pin_angles": angles(0, 120), "pin_bore": "14 mm", "journal_bore": "10 mm"}
    drawn = shaft_of_throws(Crankshaft.from_quantities(given))
    assert drawn
    apart = throws_apart(drawn)
    assert [place.solid for place in apart.places] == [0, 0]
    pin = apart.solids[0].pin
    assert (pin.middle, pin.length) == pytest.approx((-4.5 - 12, 20))
    (throw,) = throws_measured(apart.solids[0].step, [])
    ends = pi * (27.5**2 - 5**2) * 26 + pi * (drawn.nose.radius**2 - 5**2) * drawn.nose.length
    ends += pi * (drawn.flange.radius**2 - 5**2) * drawn.flange.length
    assert 2 * throw.mass == pytest.approx((drawn.volume() - ends) * STEEL_DENSITY * 1e-9, rel=1e-9)


def test_unit_loads_of_split_pins_are_refused() -> None:
    shape = Crankshaft.from_quantities({**PLAIN, **MIDDLE, "pin_angles": angles(0)})
    drawn = shaft_of_throws(shape)
    assert drawn
    assert sizes_of_throw(drawn) is None
    question = Question("unit_loads", "free_end", "coarse", None)
    with pytest.raises(AnalysisError, match="split pins"):
        throw_of(shape, question)


@pytest.mark.parametrize(("between", "rise"), [(90.0, 40.0), (-20.0, 15.0), (180.0, 60.0), (1.0, 30.0)])
def test_analytic_gap_of_drillings_is_the_least_distance_of_their_axes(between: float, rise: float) -> None:
    far, journal = 67.0, 27.5

    def at(share: float, angle: float, sign: int) -> Any:
        x = far - share * (far + journal)
        return np.array([x * cos(angle), x * sin(angle), sign * rise * (1 - share)])

    def distance(shares: Any) -> float:
        return float(np.linalg.norm(at(shares[0], 0.0, -1) - at(shares[1], radians(between), 1)))

    starts = [(a, b) for a in (0.2, 0.6, 0.95) for b in (0.2, 0.6, 0.95)]
    options = {"xatol": 1e-10, "fatol": 1e-12, "maxiter": 4000}
    least = min(minimize(distance, start, method="Nelder-Mead", options=options).fun for start in starts)
    pins = np.radians([0.0, 25.0 + between])
    found = least_gap(pins, np.radians(25.0), np.float64(far), np.float64(journal), np.float64(rise))
    assert found == pytest.approx(least, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"pin_split": "0.5 deg"}, {"pin_split"}),
        ({"pin_split": "400 deg"}, {"pin_split"}),
        ({"pin_split": {"value": [30, 40], "unit": "deg"}}, {"pin_split"}),
        ({"pin_split": "30 mm"}, {"pin_split"}),
        ({"middle_web_width": "45 mm"}, {"middle_web_width", "pin_diameter"}),
        ({"middle_web_thickness": "0 mm"}, {"middle_web_thickness"}),
        ({"journal_bore": "40 mm", "pin_split": "120 deg"}, {"middle_web_width", "journal_bore"}),
        ({"oil_drilling_diameter": "5 mm", "pin_angles": angles(0, 30)}, {"pin_angles"}),
    ],
    ids=lambda given: str(sorted(given)),  # the order of a set differs from worker to worker
)  # fmt: skip
def test_what_cannot_be_built_is_refused_by_name(given: dict[str, Any], named: set[str]) -> None:
    assert named <= set(refused({**PLAIN, **MIDDLE, "pin_angles": angles(0, 120), **given}))


def test_a_single_shaft_whose_list_breaks_a_rule_is_refused_and_not_masked() -> None:
    low = {"counterweight_radius": {"value": [70, 0, 0, 0, 0, 30], "unit": "mm"}}
    with pytest.raises(InvalidInputs, match="A counterweight reaches at least 2 % further"):
        evaluate(Crankshaft, {**Crankshaft.example, **low})


def test_box_holds_the_middle_web() -> None:
    """At 180° apart the middle web reaches to either side beyond the narrow outer webs."""
    given = {**PLAIN, "pin_angles": angles(0), "pin_split": "180 deg", "middle_web_width": "90 mm"}
    measures = build({**given, "flange_diameter": "60 mm"}).measures
    assert (measures["high_x"], measures["low_x"]) == pytest.approx((43 + 45, -43 - 45))
    assert (measures["high_y"], measures["low_y"]) == pytest.approx((45, -45))
