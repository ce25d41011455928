"""Each face of a drawn part follows from exactly one path of dimensions (ISO 129-1)."""

import io
from dataclasses import replace

import cadquery as cq
import pytest
from ezdxf.filemanagement import read
from slow_models import DRAWN, quick_for

from benchmarks.drawing_completeness import faults, faults_of
from benchmarks.drawings import SIZES, latest, sized
from cad.catalogue import models
from cad.drafting.balloons import balloons
from cad.drafting.content import Content, content_of
from cad.drafting.labels import label_of
from cad.drafting.views import views
from cad.export import derive
from cad.file_kinds import bodies_of
from cad.header import Header, read_header
from cad.model import CadModel, Part
from cad.regenerate import as_text, regenerate_class
from cad.step import read_step, write_step


def content(step: bytes) -> Content:
    return content_of(read_step(step), read_header(step))


def drawn(id: str, **changes: object) -> Content:
    model = models().get(id, 1)
    texts = as_text(model.from_quantities({**model.example, **changes}))
    return content(regenerate_class(model, texts).step)


@quick_for(*DRAWN)
def test_nothing_is_missing_and_nothing_given_twice_at_three_sizes(model: type[CadModel]) -> None:
    if model not in latest():
        pytest.skip("an older version")
    for factor in SIZES:
        assert faults_of(sized(model, factor).step) == []


SHAPES: list[tuple[str, dict[str, object]]] = [
    ("thrust_washer", {"washer": "half", "oil_grooves": 4, "pin_hole_diameter": "0 mm"}),
    ("thrust_washer", {"oil_grooves": 8, "pin_hole_diameter": "0 mm", "lug_width": "0 mm"}),
    ("crank_throw", {"web_shape": "rectangular", "counterweight_radius": "0 mm"}),
    ("plain_bearing", {"shells": "pair", "crush_height": "0 mm"}),
    ("plain_bearing", {"wall_reduction": "0.05 mm", "relief_depth": "0 mm"}),
    ("flanged_bush", {"oil_hole_diameter": "0 mm"}),
    ("connecting_rod", {"pocket_width": "0 mm"}),
    ("connecting_rod", {"shank_taper": "0 deg", "bush_wall": "0 mm"}),
    ("connecting_rod", {"boss_height": "38 mm", "cap_boss_height": "36 mm", "pocket_corner_radius": "0 mm"}),
    ("connecting_rod", {"big_end_fillet": "0 mm", "small_end_fillet": "0 mm", "boss_corner_radius": "0 mm"}),
    ("bearing_housing", {"oil_drilling_diameter": "0 mm"}),
]


@pytest.mark.parametrize(("id", "changes"), SHAPES, ids=[f"{id} {min(c)}" for id, c in SHAPES])
def test_other_shapes_are_complete_too(id: str, changes: dict[str, object]) -> None:
    assert faults(drawn(id, **changes)) == []


@pytest.mark.slow
def test_six_throws_are_complete() -> None:
    angles = {"value": [0, 120, 240, 240, 120, 0], "unit": "deg"}
    radii = {"value": [70] * 12, "unit": "mm"}
    shaft = drawn("crankshaft", pin_angles=angles, pin_split="0 deg", counterweight_radius=radii)
    assert faults(shaft) == []


def test_the_list_names_a_dimension_that_is_left_out() -> None:
    rod = drawn("connecting_rod")
    pocket = next(one for one in rod.dimensions if one.name is None and one.measure.form == "up")
    left = replace(rod, dimensions=[one for one in rod.dimensions if one is not pocket])
    assert left.missing() == ["position of a plane of rod upright at 42.5 mm"]


def test_a_closed_chain_is_listed_unless_it_is_in_brackets() -> None:
    bush = drawn("flanged_bush")
    flange = next(one for one in bush.dimensions if one.name == "flange_thickness")
    width = next(one for one in bush.dimensions if one.name == "width")
    ends = flange.measure.points[1], width.measure.points[1]
    rest = replace(flange, measure=replace(flange.measure, points=ends, value=27.0), name="rest")
    doubled = replace(bush, dimensions=[*bush.dimensions, rest])
    assert "rest, 27, is given twice" in faults(doubled)
    in_brackets = replace(bush, dimensions=[*bush.dimensions, replace(rest, is_reference=True)])
    assert faults(in_brackets) == []


@quick_for(("connecting_rod", 1), ("ball_bearing", 1))
def test_each_part_has_a_sheet_and_the_first_sheet_lists_them(model: type[CadModel]) -> None:
    step = sized(model, 1.0).step
    whole = read_step(step)
    if len(whole) > 1:
        first = words_of(derive(step, "dxf"))
        own = words_of(derive(step, f"dxf#{whole[0].name}"))
        assert f"1/{len(whole) + 1}" in first
        assert {f"{n}  {body.name.replace('_', ' ')}" for n, body in enumerate(whole, 1)} <= first
        assert {str(n) for n in range(1, len(whole) + 1)} <= first  # in the balloons
        assert f"2/{len(whole) + 1}" in own
        assert whole[0].name.replace("_", " ") in own


def balloons_of(id: str) -> dict[str, tuple[bool, tuple[float, float]]]:
    """Of each part, whether its balloon points to the end view, and where."""
    bodies = read_step(sized(models().get(id, 1), 1.0).step)
    section, end = views(bodies)
    every = balloons(section, end, bodies)
    return {bodies[number - 1].name: (view is end, points[0]) for number, view, points in every}


def test_a_balloon_points_to_a_view_that_shows_its_part() -> None:
    """Dowels and bolts of a housing are beside its section, and in the broken-out section of the end view."""
    in_end = {name: is_in_end for name, (is_in_end, _) in balloons_of("bearing_housing").items()}
    assert in_end == {"block": False, "cap": False, "dowel": True, "bolt": True}


def test_a_balloon_points_into_the_material_of_a_thin_part() -> None:
    height = {name: y for name, (_, (_, y)) in balloons_of("plain_bearing").items()}
    assert 24.0 < height["upper_lining"] < 24.6 < height["upper_back"] < 26.4  # of a bore of 48 mm


def words_of(dxf: bytes) -> set[str]:
    space = read(io.StringIO(dxf.decode())).modelspace()
    return {text.dxf.text for text in space.query("TEXT")}


def test_a_sheet_of_one_part_has_only_its_own_tolerances() -> None:
    model = models().get("connecting_rod", 1)
    given = {"cap_height": "36 mm +0.1/0 mm", "centre_distance": "144 mm +0.2/0 mm"}
    step = regenerate_class(model, as_text(model.from_quantities({**model.example, **given}))).step
    whole, header = read_step(step), read_header(step)
    for part, shown in (("rod", "centre_distance"), ("cap", "cap_height")):
        sheet = content_of(bodies_of(f"dxf#{part}", whole), header, whole)
        assert {one.name for one in sheet.dimensions if one.limits} == {shown}


def test_a_grid_of_holes_has_one_pitch_with_a_count_in_each_direction() -> None:
    """ISO 129-1: equal distances are given once; the grid is centred, so nothing else locates it."""
    grid = cq.Workplane().box(100, 80, 10).faces(">Z").workplane().rarray(20, 15, 4, 3).hole(8)
    part = Part("plate", grid.val(), float(grid.val().Volume()))
    plate = content(write_step([part], Header("plate", 1, {}, "")))
    texts = sorted(label_of(one).text.replace("<>", f"{one.measure.value:g}") for one in plate.dimensions)
    assert texts == ["10", "100", "12×8", "2×15", "3×20", "80"]
    assert faults(plate) == []


@pytest.mark.slow
def test_the_overall_length_is_a_dimension_where_the_middle_of_a_groove_halves_it() -> None:
    """Width 20 and the groove's middle at 10, not 10 + 10 with the width in brackets."""
    model = models().get("ball_bearing", 1)
    step = regenerate_class(model, as_text(model.from_quantities(model.example))).step
    whole = read_step(step)
    ring = content_of(bodies_of("dxf#outer_ring", whole), read_header(step), whole)
    lengths = [one for one in ring.dimensions if one.measure.sort == "length"]
    assert sorted((one.measure.value, one.is_reference) for one in lengths) == [(10, False), (20, False)]
