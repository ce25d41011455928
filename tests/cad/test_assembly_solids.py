"""Clearances and interferences of fixed parts agree with a second method, without the service."""

import hashlib
from math import hypot, pi

import numpy as np
import pytest
from cadquery import Location, Solid, Vector, Workplane

from cad import overlaps
from cad.assemblies import Component, described
from cad.catalogue import models
from cad.checks import MOST_NAMED
from cad.errors import GeometryError
from cad.export import DERIVED, derive
from cad.header import Header
from cad.imported_models import ProgramResult
from cad.model import Part
from cad.model_classes import class_of, description_of
from cad.overlaps import clearances
from cad.regenerate import as_text, regenerate_shape
from cad.step import Body, read_step, write_step

COLOUR = (0.1, 0.2, 0.9)


def step_of(*shapes):
    parts = [Part(f"part{n}", shape, shape.Volume(), COLOUR) for n, shape in enumerate(shapes)]
    return write_step(parts, Header("bought", 1, {}, "0" * 64))


BOLT = step_of(Workplane().circle(4).extrude(30).val())


def assembly(step=BOLT, base=("bearing_assembly", 1), **component):
    sha = hashlib.sha256(step).hexdigest()
    one = Component("bolt", sha, "a file", **component)
    text = described("Assembly", "0" * 64, "a.json", base, {one: {}}).text
    return class_of(text, "with_bolt", 1), ProgramResult(fixed={sha: step})


def built(step=BOLT, base=("bearing_assembly", 1), datum="cap.low_y", may_overlap=(), **parameters):
    cls, drawn = assembly(step, base, datum=datum, may_overlap=may_overlap)
    shape = cls.from_quantities({**cls.example, **parameters} if base else parameters)
    shape.take(drawn)
    return regenerate_shape(shape, as_text(shape))


@pytest.fixture(scope="module")
def bolted():
    return built(bolt_z="2 mm")


def test_a_description_is_read_as_it_was_written():
    cls, _ = assembly(may_overlap=("cap", "block"), density=1200.0, material="PTFE")
    assert description_of(cls.imported.text) == cls.imported
    assert class_of(cls.imported.text, "with_bolt", 1) is cls


def test_equal_parameters_give_equal_bytes_and_the_clearance_is_in_closed_form(bolted):
    assert built(bolt_z="2000 um").step == bolted.step
    between = {(one.one, one.other): one.distance for one in bolted.clearances}
    journal, cap = bolted.dimensions["journal_diameter"], bolted.dimensions["cap_height"]
    assert between["cap", "bolt"] == pytest.approx(2, abs=1e-6)
    assert between["journal", "bolt"] == pytest.approx(cap + 2 - journal / 2, abs=1e-6)
    assert len(between) == 7


@pytest.mark.slow
@pytest.mark.parametrize("kind", DERIVED)
def test_every_kind_of_file_is_made_of_an_assembly(bolted, kind):
    assert len(derive(bolted.step, kind)) > 100


def test_a_fixed_part_of_two_solids_has_a_name_for_each_and_its_own_mass():
    step = step_of(Solid.makeBox(10, 10, 10), Solid.makeBox(5, 5, 5, Vector(0, 0, 10)))
    build = built(step, base=None, datum="origin", bolt_x="7 mm", bolt_turn_z="90 deg")
    assert [body.name for body in read_step(build.step)] == ["bolt:part0", "bolt:part1"]
    assert build.clearances == ()
    assert build.measures["volume"] == pytest.approx(1125, rel=1e-9)
    assert [build.measures[f"low_{axis}"] for axis in "xyz"] == pytest.approx([-3, 0, 0], abs=1e-6)


def test_a_datum_that_is_not_there_is_named_with_those_that_are():
    with pytest.raises(GeometryError, match="cap has 1 cylinder axes, so there is no axis_2"):
        built(datum="cap.axis_2")


def test_too_many_solids_are_refused(monkeypatch):
    monkeypatch.setattr("cad.assemblies.MOST_SOLIDS", 1)
    step = step_of(Solid.makeBox(1, 1, 1), Solid.makeBox(1, 1, 1, Vector(0, 0, 1)))
    with pytest.raises(GeometryError, match="more than 1 solids"):
        built(step, base=None, datum="origin")


def test_a_name_of_a_part_of_the_model_is_refused():
    step = BOLT
    sha = hashlib.sha256(step).hexdigest()
    text = described("A", "0" * 64, "a.json", ("bearing_assembly", 1), {Component("cap", sha, "a"): {}}).text
    cls = class_of(text, "two_caps", 1)
    shape = cls.from_quantities(cls.example)
    shape.take(ProgramResult(fixed={sha: step}))
    with pytest.raises(GeometryError, match="cap is the name of a part of bearing_assembly"):
        shape.build()


def body(name, shape, *place):
    return Body(name, shape, COLOUR, (Location(*place),))


def test_random_pairs_of_boxes_and_balls_are_as_far_apart_as_geometry_says():
    """A box and a ball: the distance from the centre to the box by clamping; boxes overlap by their edges."""
    random = np.random.default_rng(86)
    for _ in range(25):
        sides, radius = random.uniform(2, 10, 3), random.uniform(1, 4)
        centre = random.uniform(-16, 16, 3)
        box = body("box", Solid.makeBox(*sides), Vector())
        ball = body("ball", Workplane().sphere(radius).val(), Vector(*centre))
        (one,) = clearances([box, ball], str)
        nearest = np.linalg.norm(centre - np.clip(centre, 0, sides)) - radius
        if nearest > 1e-3:
            assert one.distance == pytest.approx(nearest, abs=1e-6)
            assert one.overlap == 0
        elif nearest < -1e-2:
            assert one.distance == 0
            assert one.overlap > 0
        shift = random.uniform(-12, 12, 3)
        other = body("other", Solid.makeBox(*sides), Vector(*shift))
        (two,) = clearances([box, other], str)
        shared = np.clip(sides - np.abs(shift), 0, None).prod()
        assert two.overlap == pytest.approx(shared, rel=1e-9, abs=1e-6)
        apart = np.clip(np.abs(shift) - sides, 0, None)
        assert two.distance == pytest.approx(np.linalg.norm(apart), abs=1e-6)


def test_parts_that_touch_do_not_interfere_and_turned_ones_are_measured():
    box = Solid.makeBox(10, 10, 10)
    (one,) = clearances([body("a", box, Vector()), body("b", box, Vector(10, 3, 4))], str)
    assert (one.distance, one.overlap) == (0, 0)
    pin = Solid.makeCylinder(2, 20, Vector(), Vector(1, 0, 0))
    (two,) = clearances([body("a", box, Vector()), body("pin", pin, Vector(-5, 14, 15))], str)
    assert two.distance == pytest.approx(hypot(4, 5) - 2, abs=1e-6)
    (three,) = clearances([body("a", box, Vector()), body("pin", pin, Vector(-5, 5, 5))], str)
    assert three.overlap == pytest.approx(pi * 4 * 10, rel=1e-9)


def test_what_the_kernel_does_not_intersect_is_not_taken_for_free_space(monkeypatch):
    """A common solid that comes out empty although a corner lies inside is an error, not a clearance."""

    class Empty:
        def __init__(self, one, other):
            pass

        def IsDone(self):
            return True

        def Shape(self):
            return Workplane().rect(1, 1).val().wrapped

    monkeypatch.setattr("cad.overlaps.BRepAlgoAPI_Common", Empty)
    box = Solid.makeBox(10, 10, 10)
    with pytest.raises(GeometryError, match="a and b overlap, but the shared volume"):
        list(clearances([body("a", box, Vector()), body("b", box, Vector(5, 5, 5))], str))
    (touching,) = clearances([body("a", box, Vector()), body("b", box, Vector(10, 0, 0))], str)
    assert touching.overlap == 0


def test_a_drawing_of_an_assembly_cuts_its_parts():
    """Shafts are drawn whole; an assembly that answers no finite elements is none."""
    from cad.drafting.declaration import _is_shaft

    cls, _ = assembly()
    assert not _is_shaft(cls)
    assert _is_shaft(models().get("crankshaft", 1))


def many(number, apart=0.0):
    """A file of balls that stand on one line."""
    return step_of(*(Solid.makeBox(1, 1, 1, Vector(n * apart, 0, 0)) for n in range(number)))


def two_components(step, **of_second):
    """The same file twice, with nothing beside it."""
    sha = hashlib.sha256(step).hexdigest()
    parts = {Component("one", sha, "a file"): {}, Component("two", sha, "a file", **of_second): {}}
    cls = class_of(described("Twice", "0" * 64, "a.json", None, parts).text, "twice", 1)
    shape = cls.from_quantities({})
    shape.take(ProgramResult(fixed={sha: step}))
    return shape


def test_too_many_pairs_that_meet_are_refused_before_a_file_is_written(monkeypatch):
    def written(*_, **__):
        raise AssertionError("it was written first")

    monkeypatch.setattr("cad.regenerate.write_step", written)
    monkeypatch.setattr("cad.overlaps.MOST_MEETING", 8)
    shape = two_components(many(3))
    with pytest.raises(
        GeometryError, match=r"9 pairs of solids .* at most 8 .* of one \(9\), two \(9\)"
    ) as refused:
        regenerate_shape(shape, as_text(shape))
    assert refused.value.code == "too_large"


def test_many_interferences_are_named_and_the_rest_is_not_compared(monkeypatch):
    compared = []
    between = overlaps._between
    monkeypatch.setattr("cad.overlaps._between", lambda *two: compared.append(two) or between(*two))
    shape = two_components(many(8))
    said = []
    with pytest.raises(
        GeometryError, match=r"one:part0 and two:part0 overlap by 1 mm³; .*; and at least one more"
    ) as refused:
        regenerate_shape(shape, as_text(shape), report=lambda done, what: said.append((done, what)))
    assert refused.value.code == "interference"
    assert len(compared) == MOST_NAMED + 1 < 64
    assert (0.8, "comparing one:part0 with two:part0, pair 1 of 64") in said


def test_every_pair_that_may_overlap_is_measured_and_counted():
    shape = two_components(many(5, apart=2.0), may_overlap=("one",))
    build = regenerate_shape(shape, as_text(shape))
    overlapping = [one for one in build.clearances if one.overlap]
    assert [(one.one, one.other) for one in overlapping] == [
        (f"one:part{n}", f"two:part{n}") for n in range(5)
    ]
    assert len(build.clearances) == 25


@pytest.mark.parametrize(
    ("name", "said"),
    [
        (
            "capp",
            "bolt: may_overlap names 'capp', which is not a part. Did you mean cap? The parts are journal",
        ),
        (
            "zz",
            "The parts are journal, upper_back, upper_lining, lower_back, lower_lining, block",
        ),
    ],
)
def test_a_part_that_is_not_there_may_not_be_overlapped(name, said):
    with pytest.raises(GeometryError, match=said.replace(".", "[.]").replace("?", "[?]")) as refused:
        built(bolt_z="2 mm", may_overlap=(name,))
    assert refused.value.code == "may_overlap"


def test_a_part_may_be_named_that_the_model_has_for_other_parameters():
    """Without a cage the bearing has no part of that name, and its user may switch it on."""
    cls = models().get("deep_groove_bearing", 1)
    usual = cls.from_quantities(cls.example)
    assert "cage" in {part.name for part in usual.build()}
    step = BOLT
    shape, drawn = assembly(step, ("deep_groove_bearing", 1), may_overlap=("cage", "ball"), datum="origin")
    without = shape.from_quantities({**shape.example, "cage_width": "0 mm", "bolt_x": "200 mm"})
    without.take(drawn)
    assert "cage" not in {part.name for part in without.build()}
    assert without.may_overlap("bolt", "ball_3")  # one of its places
    assert not without.may_overlap("bolt", "inner_ring")
