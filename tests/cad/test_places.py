"""A dimension belongs to the same faces in the STEP file and on the drawing, even if sizes are equal."""

import io
import itertools
from collections import defaultdict

import ezdxf
import numpy as np
import pytest
from part21_reader import File
from seeds import seeded
from sizes_of import sizes_of
from slow_models import DRAWN, quick_for
from undivided import TWO_THROWS

from cad.catalogue import models
from cad.errors import GeometryError
from cad.export import derive
from cad.header import read_header
from cad.regenerate import as_text, regenerate_class
from templates.core.errors import InvalidInputs
from templates.core.units.units import unit

CLOSE = 1e-4  # [mm]
UPS = (np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))


def lengths(model):
    """The names of the parameters that are one length."""
    return [
        name
        for name, declared in model.inputs.items()
        if hasattr(declared.meaning, "unit")
        and unit(declared.meaning.unit).base == unit("m").base
        and isinstance(as_text(model.from_quantities(model.example)).get(name), str)
        and not as_text(model.from_quantities(model.example))[name].startswith("[")
    ]


def places(model, texts):
    """The faces of every size of a solid, by parameter, and how many faces its parts have."""
    sizes, faces = sizes_of(model.from_quantities(texts))
    return {name: size.places for name, size in sizes.items()}, faces


def varied(model, rng, by):
    """The texts of a model's example, each length changed by up to a share of it; None if a rule refuses."""
    texts = as_text(model.from_quantities(model.example))
    for name in lengths(model):
        number, name_of_unit = texts[name].split(" ")
        texts[name] = f"{float(number) * (1 + rng.uniform(-by, by)):.9g} {name_of_unit}"
    try:
        return as_text(model.from_quantities(texts))
    except InvalidInputs:
        return None


@quick_for(*DRAWN, ("crank_throw", 1), ("bearing_housing", 1))
def test_property_no_place_moves_where_every_size_changes_a_little(model):
    if not model.toleranced:
        return
    rng, moved = np.random.default_rng(seeded(37)), 0
    expected, faces = places(model, as_text(model.from_quantities(model.example)))
    for texts in filter(None, (varied(model, rng, 0.006) for _ in range(3))):
        result, count = places(model, texts)
        if count == faces:
            assert result == expected
            moved += 1
    assert moved or model.id == "deep_groove_bearing"


@pytest.mark.slow
def test_property_no_place_moves_where_any_two_sizes_are_equal(model):
    texts = as_text(model.from_quantities(model.example))
    expected, faces = places(model, texts)
    compared = 0
    for one, other in itertools.permutations([n for n in lengths(model) if texts[n] != "0 mm"], 2):
        try:
            result, count = places(model, {**texts, one: texts[other]})
        except (InvalidInputs, GeometryError):
            continue
        if count == faces and result.keys() == expected.keys():
            assert result == expected, (one, other)
            compared += 1
    assert compared or not expected


def drawn(step):
    """Every DIMENSION that carries the name of a parameter: its kind, its points, its number."""
    document = ezdxf.read(io.StringIO(derive(step, "dxf").decode()))
    for entity in document.modelspace().query("DIMENSION"):
        if entity.has_xdata("CRANKWRIGHT"):
            name = entity.get_xdata("CRANKWRIGHT")[0].value
            points = [np.array(entity.dxf.get(key))[:2] for key in KEYS if entity.dxf.hasattr(key)]
            yield name, entity.dimtype & 7, float(entity.dxf.get("angle", 0.0)) % 180, points, entity.dxf.text


KEYS = ("defpoint2", "defpoint3")


def fits(angle, points, sides, up):
    """Whether a dimension line lies on the surfaces of a dimension in the file, in a view with that up.

    The section has the coordinates of the part; the view beside it is moved to the right.
    """
    level, upright = angle < 1, abs(angle - 90) < 1
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    ends = sorted(float(np.dot(point, direction)) for point in points)
    along = np.array([0.0, 0.0, 1.0]) if level else up
    surfaces = [surface for side in sides for surface in side]
    if len(sides) == 1:
        radius = surfaces[0][3]
        middles = {round(float(np.dot(up, p)), 4) for _, p, _, _ in surfaces}
        is_size = abs(ends[1] - ends[0] - 2 * radius) < CLOSE
        return is_size and (not upright or any(abs(sum(ends) / 2 - middle) < CLOSE for middle in middles))
    if {keyword for keyword, *_ in surfaces} == {"PLANE"}:
        across = abs(np.dot(surfaces[0][2], along)) > 0.99
        levels = [float(np.dot(point, along)) for _, point, _, _ in surfaces]
        return not across or all(any(abs(end - one) < CLOSE for one in levels) for end in ends)
    return True  # between cylinders: test_the_lining and the throw below


def toleranced(model, rng):
    texts, given = as_text(model.from_quantities(model.example)), {}
    carried, _ = sizes_of(model.from_quantities(texts))
    for name in lengths(model):
        if name in model.toleranced and name in carried and texts[name] != "0 mm" and rng.random() < 0.6:
            given[name] = f"{texts[name]} +{rng.integers(1, 9) / 100}/-0.01 mm"
    return {**texts, **given}, given


@quick_for(("connecting_rod", 1), ("crank_throw", 1))
def test_property_paper_shows_the_limits_that_the_file_states_and_no_others(model):
    """Every dimension with limits on paper is one of the file, with its limits, between the same faces."""
    rng = np.random.default_rng(seeded(3701))
    for _ in range(1 if model.id in ("connecting_rod", "crank_throw") else 20):
        texts, given = toleranced(model, rng)
        if not given:
            continue
        step = regenerate_class(model, texts).step
        stated = defaultdict(list)
        for one in File(step).dimensions():
            stated[one.name.removesuffix("/2")].append(one)  # a pitch circle is stated by its radius
        assert stated.keys() == given.keys()
        shown = set()
        for name, kind, angle, points, text in drawn(step):
            if name not in stated:
                assert "^" not in text
                assert "±" not in text
                continue
            one = stated[name][0]
            assert f"{one.upper * (2 if one.name.endswith('/2') else 1):g}" in text, (name, text)
            shown.add(name)
            sides = [one.places for one in stated[name] if one.kind in ("diameter", "linear distance")]
            if sides and kind == 0 and len(points) == 2:
                assert any(fits(angle, points, each, up) for up in UPS for each in sides), (name, points)
        assert shown == stated.keys()


def stated(id, changes):
    """The file's dimensions and those on paper of an example with changes, by parameter."""
    model = models().get(id, 1)
    step = regenerate_class(model, as_text(model.from_quantities({**model.example, **changes}))).step
    return {one.name: one for one in File(step).dimensions()}, {
        name: (kind, angle, points, text) for name, kind, angle, points, text in drawn(step)
    }


def test_limits_of_a_pin_as_thick_as_its_journal_stand_on_the_pin():
    file, paper = stated("crank_throw", {"journal_diameter": "50 mm", "pin_diameter": "50 mm -0.02/-0.04 mm"})
    ((_, point, _, radius),) = file["pin_diameter"].places[0]
    assert (point[0], radius) == (pytest.approx(42), 25)
    _, _, points, text = paper["pin_diameter"]
    assert sorted(y for _, y in points) == pytest.approx([42 - 25, 42 + 25])  # about the pin's axis
    assert "0.02" in text
    assert "0.02" not in paper["journal_diameter"][3]


def test_limits_of_a_pin_as_long_as_its_webs_are_thick_stand_on_the_pin():
    _, paper = stated("crank_throw", {"pin_length": "18 mm +0.1/0 mm", "web_thickness": "18 mm"})
    _, _, points, text = paper["pin_length"]
    assert sorted(x for x, _ in points) == pytest.approx([-9, 9])
    assert "0.1" in text
    assert "0.1" not in paper["web_thickness"][3]


def test_a_bolt_hole_and_an_oil_drilling_of_one_size_are_dimensioned_once_each():
    changes = {
        "bolt_hole_diameter": "8 mm +0.1/0 mm",
        "oil_drilling_diameter": "8 mm",
        "bolt_diameter": "0 mm",
    }
    file, paper = stated("bearing_housing", changes)
    axes = [abs(point[0]) for _, point, _, _ in file["bolt_hole_diameter"].places[0]]
    assert axes == pytest.approx([39] * len(axes))
    bolt, oil = paper["bolt_hole_diameter"], paper["oil_drilling_diameter"]
    assert "0.1" in bolt[3]
    assert "0.1" not in oil[3]
    assert abs(sum(p[0] for p in bolt[2]) - sum(p[0] for p in oil[2])) > 1


def test_a_lining_is_dimensioned_across_its_wall_and_no_flange_where_there_is_none():
    for bore in ("30 mm", "100 mm"):
        model = models().get("plain_bearing", 1)
        step = regenerate_class(model, as_text(model.from_quantities({"inner_diameter": bore}))).step
        paper = {name: (angle, points) for name, _, angle, points, _ in drawn(step)}
        assert "flange_thickness" not in paper
        angle, _ = paper["lining_thickness"]
        assert angle == pytest.approx(90)  # upright in the section: from bore to back of the lining


@pytest.mark.slow
def test_the_thickness_of_a_flange_runs_along_the_shaft():
    for angles in ([0.0], [0.0, 180.0, 180.0, 0.0]):
        changes = {"pin_angles": {"value": angles, "unit": "deg"}, "bolt_hole_diameter": "8 mm"}
        model = models().get("crankshaft", 1)
        example = {**TWO_THROWS, **changes, "counterweight_radius": "0 mm"}
        step = regenerate_class(model, as_text(model.from_quantities(example))).step
        paper = {name: (angle, points) for name, _, angle, points, _ in drawn(step)}
        angle, points = paper["flange_thickness"]
        header = read_header(step)
        assert header is not None
        assert angle == pytest.approx(0)
        assert abs(points[1][0] - points[0][0]) == pytest.approx(
            float(header.parameters["flange_thickness"].split(" ")[0])
        )
