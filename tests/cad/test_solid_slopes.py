"""Slopes of solids over their parameters.

Volumes: against differences of the closed forms, a second method. All measures: against Richardson's
extrapolation of differences of built and measured solids.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise

import numpy as np
import pytest
from cadquery import Workplane
from cadquery.selectors import RadiusNthSelector
from seeds import seeded
from slow_models import slow_for

from cad.catalogue import models
from cad.errors import GeometryError
from cad.inspect import measure, summarise
from cad.model import Box, CadModel, Part, mm
from cad.regenerate import Build
from cad.slopes.operands import operands
from cad.slopes.results import ParameterSlopes
from cad.slopes.solid_slopes import BOX, solid_slopes
from cad.step import Body
from templates.core.errors import InvalidInputs
from templates.core.language.template import Array, given

AIM = 1e-6
"""Largest error of a slope, relative to the larger of the slope and the value over the size of the solid."""
Measures = dict[str, float]


def model_of(id: str, **given: str | int) -> CadModel:
    cls = models().get(id, 1)
    return cls.from_quantities({**cls.example, **given})


def moved(model: CadModel, name: str, change: float) -> CadModel:
    """The model with another value of one parameter; all others keep theirs, defaults included."""
    si = model.inputs_si()
    return type(model).from_si({**si, name: float(si[name]) + change})


def measures_of(model: CadModel) -> Measures:
    """The measures of a built solid, by the kernel's own integration."""
    parts = model.build()
    bodies = [Body(part.name, part.solid, part.colour, part.places, part.called) for part in parts]
    measured = [measure(body) for body in bodies]
    for part, one in zip(parts, measured, strict=True):
        assert one.volume == pytest.approx(part.volume, rel=max(part.tolerance, 1e-6))
    densities = {part.name: part.density for part in parts}
    box = model.bounding_box()
    return summarise(bodies, measured, densities, Box(box.low, box.high))


def closed_volume(model: CadModel) -> float:
    """The volume by the closed forms of the parts."""
    return sum(part.volume * len(part.places) for part in operands(model))


def richardson(of: Callable[[float], Measures], step: float) -> tuple[Measures, Measures]:
    """The slopes by extrapolated central differences, and estimates of their errors."""
    tables = []
    for n in range(3):
        above, below, by = of(step / 2**n), of(-step / 2**n), step / 2**n
        tables.append({name: (above[name] - below[name]) / (2 * by) for name in above})
    first, second = (
        {name: (4 * fine[name] - coarse[name]) / 3 for name in fine} for coarse, fine in pairwise(tables)
    )
    best = {name: (16 * second[name] - first[name]) / 15 for name in first}
    return best, {name: abs(second[name] - first[name]) for name in first}


def scales(model: CadModel, name: str, measures: Measures) -> Measures:
    """For each measure its value over the size of the solid; an angle counts in radians."""
    box = model.bounding_box()
    size = math.dist(box.low, box.high)
    mass = measures["mass"]
    per = size * 1e-3 if model.inputs[name].meaning.unit == "mm" else 1.0
    whole = {"mass": mass, "volume": measures["volume"]}
    rotary = {axes: mass * size**2 * 1e-6 for axes in measures if "inertia" in axes}
    return {axis: value / per for axis, value in (dict.fromkeys(measures, size) | whole | rotary).items()}


def single(model: CadModel) -> list[str]:
    """The parameters that are single numbers above zero, but no counts."""
    si = model.inputs_si()
    numbers = (name for name, value in si.items() if not isinstance(value, str) and np.ndim(value) == 0)
    return [name for name in numbers if si[name] > 0 and not model.inputs[name].meaning.integer]


@slow_for(("crankshaft", 1))
def test_measures_and_slopes_of_volumes_agree_with_file_and_closed_forms(
    model: type[CadModel], example: Build
) -> None:
    asked = model.from_quantities(model.example)
    found = solid_slopes(asked)
    for name, value in found.measures.items():
        assert value == pytest.approx(example.measures[name], rel=1e-8, abs=2e-9), name
    checked = 0
    for name in single(asked):
        slopes = found.parameters[name]
        if slopes.side == "both" and "volume" in slopes.slopes:
            with suppress(InvalidInputs):  # a rule is nearer than the steps of the difference
                wanted = closed_slope(asked, name)
                scale = max(abs(wanted), scales(asked, name, found.measures)["volume"])
                assert abs(slopes.slopes["volume"] - wanted) <= 0.1 * AIM * scale, name
                checked += 1
    assert checked >= len(single(asked)) // 3


def test_a_ball_bearing_on_a_rule_of_its_chamfer_has_a_kink() -> None:
    """The chamfer is 5 % of the smaller of width and height of its section, which are equal here."""
    at_kink = solid_slopes(model_of("ball_bearing", outer_diameter="90 mm", width="20 mm"), ["width"])
    slopes = at_kink.parameters["width"]
    assert "another above the value than below" in slopes.reason("volume")
    assert slopes.slopes["high_z"] == pytest.approx(500)
    beside = solid_slopes(model_of("ball_bearing", outer_diameter="90 mm", width="20.2 mm"), ["width"])
    assert "volume" in beside.parameters["width"].slopes


def over(model: CadModel, name: str) -> ParameterSlopes:
    return solid_slopes(model, [name]).parameters[name]


def closed_slope(model: CadModel, name: str) -> float:
    """The slope of the closed volume by a difference of the fourth order."""
    step = 2e-3 * float(model.inputs_si()[name])
    volumes = {n: closed_volume(moved(model, name, n * step)) for n in (-2, -1, 1, 2)}
    return (8 * (volumes[1] - volumes[-1]) - (volumes[2] - volumes[-2])) / (12 * step)


def test_a_vanishing_fillet_has_slopes_down_to_the_least_one_and_none_at_zero() -> None:
    throw = {"oil_drilling_diameter": "0 mm", "counterweight_radius": "0 mm", "face_inclination": "0 deg"}
    slopes = {}
    for size in ("3 mm", "0.15 mm"):
        model = model_of("crank_throw", fillet=size, **throw)
        slopes[size] = over(model, "fillet").slopes["volume"]
        assert slopes[size] == pytest.approx(closed_slope(model, "fillet"), rel=1e-6)
    assert slopes["0.15 mm"] < 0.05 * slopes["3 mm"]
    none = over(model_of("crank_throw", fillet="0 mm", **throw), "fillet")
    assert not none.slopes
    assert "below: fillet" in none.whole
    assert "above: fillet" in none.whole


class Drilled(CadModel):
    """A block with a hole from above, blind or through, and a boss on it that may be absent."""

    a: Array = given("mm", "size", ge=1, le=1000)
    t: Array = given("mm", "depth", ge=1, le=2000)
    h: Array = given("mm", "boss", ge=0, le=100)

    def build(self) -> tuple[Part, ...]:
        size, depth, boss = mm(self.a), mm(self.t), mm(self.h)
        top = Workplane(origin=(0, 0, size / 2))
        block = Workplane().box(size, size, size).cut(top.circle(size / 4).extrude(-depth))
        if boss > 0:
            block = block.union(top.rect(size, size).circle(size / 3).extrude(boss))
        volume = size**3 - np.pi * (size / 4) ** 2 * min(depth, size)
        return (Part("block", block.val(), volume + (size**2 - np.pi * (size / 3) ** 2) * boss),)

    def bounding_box(self) -> Box:
        half = mm(self.a) / 2
        return Box((-half,) * 3, (half, half, half + mm(self.h)))


def test_a_hole_that_breaks_through_has_a_slope_before_and_after_and_none_between() -> None:
    def at(depth: str) -> ParameterSlopes:
        return over(Drilled.from_quantities({"size": "40 mm", "depth": depth, "boss": "2 mm"}), "depth")

    assert at("39 mm").slopes["volume"] == pytest.approx(-np.pi * 100 * 1e3, rel=1e-9)
    assert at("41 mm").slopes["volume"] == pytest.approx(0, abs=1e-6)
    assert not at("40 mm").slopes
    assert "faces of the shape coincide and move apart" in at("40 mm").whole


def test_a_boss_that_appears_has_no_slope() -> None:
    model = Drilled.from_quantities({"size": "40 mm", "depth": "20 mm", "boss": "0 mm"})
    slopes = over(model, "boss")
    assert not slopes.slopes
    assert slopes.whole.endswith("above: the solid has other faces")
    assert slopes.whole.startswith("below: boss is")
    assert over(model, "size").side == "both"


def test_a_parameter_at_the_end_of_its_rule_has_slopes_on_one_side() -> None:
    """Balls are at most 90 % as large as the section is high: 18 mm of 20 mm."""
    given = {"inner_diameter": "50 mm", "outer_diameter": "90 mm", "width": "25 mm", "balls": 8}
    tight = model_of("ball_bearing", **given, ball_diameter="17.9999999 mm")
    slopes = over(tight, "ball_diameter")
    assert slopes.side == "below"
    assert "90 % of the height from bore to outside" in slopes.one_sided
    step = 4e-5
    volumes = [closed_volume(moved(tight, "ball_diameter", -n * step)) for n in range(5)]
    weights = (-25 / 12, 4, -3, 4 / 3, -1 / 4)
    wanted = -sum(w * v for w, v in zip(weights, volumes, strict=True)) / step
    assert slopes.slopes["volume"] == pytest.approx(wanted, rel=1e-6)
    near = model_of("ball_bearing", **given, ball_diameter="17.99 mm")
    assert over(near, "ball_diameter").side == "both"


def test_what_is_no_single_number_has_a_reason() -> None:
    found = solid_slopes(model_of("crankshaft"), ["web_shape", "pin_angles", "bolt_holes"])
    reasons = {name: slopes.whole for name, slopes in found.parameters.items()}
    assert reasons == {
        "web_shape": "it is a choice",
        "pin_angles": "it is a list",
        "bolt_holes": "it is a whole number",
    }


class Rounded(CadModel):
    """A block with a hole whose rim is rounded: the rim is an edge that a Boolean operation made."""

    a: Array = given("mm", "size", ge=1, le=1000)
    r: Array = given("mm", "rounding", ge=0.1, le=10)

    def build(self) -> tuple[Part, ...]:
        size, radius = mm(self.a), mm(self.r)
        block = Workplane().box(size, size, size).faces(">Z").workplane().hole(size / 2)
        rounded = block.edges(RadiusNthSelector(0)).edges(">Z").fillet(radius).val()
        hole = size / 4
        rim = 2 * np.pi * radius**2 * ((1 - np.pi / 4) * hole + (5 / 6 - np.pi / 4) * radius)
        return (Part("block", rounded, size**3 - np.pi * hole**2 * size - rim),)

    def bounding_box(self) -> Box:
        half = mm(self.a) / 2
        return Box((-half,) * 3, (half,) * 3)


def test_a_fillet_on_an_edge_of_an_operation_is_traced_to_the_part_itself() -> None:
    model = Rounded.from_quantities({"size": "40 mm", "rounding": "2 mm"})
    found = solid_slopes(model)
    volume = found.measures["volume"]
    assert volume == pytest.approx(model.build()[0].volume, rel=1e-9)
    for name in ("size", "rounding"):
        step = 1e-3 * float(model.inputs_si()[name])
        above, below = (moved(model, name, change).build()[0].volume for change in (step, -step))
        wanted = (above - below) / (2 * step)
        assert found.parameters[name].slopes["volume"] == pytest.approx(wanted, rel=1e-6)


def random_model(rng: np.random.Generator, cls: type[CadModel]) -> CadModel:
    """The example in another size and other proportions; some features are left out."""
    si = cls.from_quantities(cls.example).inputs_si()
    while True:
        size, given = 2 ** rng.uniform(-1, 2), dict(si)
        for name, value in si.items():
            if not isinstance(value, str) and not cls.inputs[name].meaning.integer:
                factor = np.exp(rng.normal(0, 0.06, np.shape(value)))
                factor = factor * (size if cls.inputs[name].meaning.unit == "mm" else 1.0)
                absent = np.ndim(value) == 0 and rng.random() < 0.08
                given[name] = 0.0 if absent else value * factor
        try:
            return cls.from_si(given)
        except InvalidInputs:
            continue


def difference_of(model: CadModel, name: str) -> tuple[Measures, Measures] | None:
    """Richardson's slopes with the largest step whose error seems small; None if a rule is too near."""
    value = float(model.inputs_si()[name])
    limit = scales(model, name, measures_of(model))
    best: tuple[Measures, Measures] | None = None
    for share in (0.05, 0.02, 0.004):
        try:
            slopes, errors = richardson(lambda h: measures_of(moved(model, name, h)), share * value)
        except (InvalidInputs, GeometryError, AssertionError):
            continue
        best = slopes, errors
        if all(errors[axis] <= 0.1 * AIM * max(abs(slopes[axis]), limit[axis]) for axis in slopes):
            return best
    return best


@pytest.mark.slow
def test_slopes_of_200_random_solids_agree_with_differences() -> None:
    rng, checked, missing = np.random.default_rng(seeded(40)), 0, 0
    classes = list(models())
    worst: dict[str, float] = {}
    while checked < 200:
        model = random_model(rng, classes[(checked + missing) % len(classes)])
        name = str(rng.choice(single(model)))
        found = solid_slopes(model, [name])
        slopes = found.parameters[name]
        reference = difference_of(model, name) if slopes.side == "both" and slopes.slopes else None
        if reference is None:
            missing += 1
            continue
        limit = scales(model, name, found.measures)
        for axis, slope in slopes.slopes.items():
            if axis not in BOX:
                scale = max(abs(reference[0][axis]), limit[axis])
                error = abs(slope - reference[0][axis]) / scale
                assert error <= AIM + 2 * reference[1][axis] / scale, (model.id, name, axis)
                worst[model.id] = max(worst.get(model.id, 0.0), error)
        checked += 1
    assert missing <= 60
    assert sorted(worst.values())[len(worst) // 2] <= 0.1 * AIM
