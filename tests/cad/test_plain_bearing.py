"""Full bushes, shells without lining, thick walls, and tolerances that join back and lining."""

from math import pi

import pytest
from part21_reader import File

from cad.catalogue import models
from cad.errors import GeometryError
from cad.regenerate import Build, as_text, regenerate_class
from templates.core.errors import InvalidInputs

CLS = models().get("plain_bearing", 1)
BARE = {
    "inner_diameter": "48 mm", "wall": "2.4 mm", "width": "24 mm", "oil_hole_diameter": "0 mm",
    "oil_groove_width": "0 mm", "tang_width": "0 mm", "relief_depth": "0 mm", "inner_chamfer": "0 mm",
    "outer_chamfer": "0 mm",
}  # fmt: skip


def build(**given: str) -> Build:
    return regenerate_class(CLS, as_text(CLS.from_quantities(given)))


def refused(**given: str) -> set[str]:
    with pytest.raises(InvalidInputs) as caught:
        as_text(CLS.from_quantities({"inner_diameter": "48 mm", **given}))
    return {name for fault in caught.value.faults for name in fault.names}


@pytest.mark.parametrize("wall", [2.4, 30.0])
@pytest.mark.parametrize("lining", ["0 mm", "0.6 mm"])
def test_analytic_a_bare_bush_is_a_ring(wall: float, lining: str) -> None:
    bush = build(**{**BARE, "wall": f"{wall} mm"}, shells="full", lining_thickness=lining)
    assert bush.measures["volume"] == pytest.approx(pi * ((24 + wall) ** 2 - 24**2) * 24, rel=1e-9)
    assert (bush.measures["low_y"], bush.measures["centre_y"]) == pytest.approx((-24 - wall, 0), abs=1e-6)
    assert set(bush.materials) == ({"full_back"} if lining == "0 mm" else {"full_back", "full_lining"})


@pytest.mark.parametrize(("angle", "share"), [("180 deg", 1.0), ("120 deg", 1 / 3)])
@pytest.mark.parametrize("depth", [0.3, 0.8])
def test_analytic_the_groove_of_a_bush_is_part_of_a_ring(angle: str, share: float, depth: float) -> None:
    groove = {"oil_groove_width": "5 mm", "oil_groove_depth": f"{depth} mm", "oil_groove_angle": angle}
    with_groove = build(**{**BARE, **groove}, shells="full", lining_thickness="0.5 mm")
    without = pi * (26.4**2 - 24**2) * 24
    taken = share * pi * ((24 + depth) ** 2 - 24**2) * 5
    assert with_groove.measures["volume"] == pytest.approx(without - taken, rel=1e-9)


def test_two_half_shells_without_a_hole_are_a_bush() -> None:
    groove = {"oil_groove_width": "5 mm", "oil_groove_depth": "0.8 mm"}
    bush, upper, lower = (
        build(**{**BARE, **groove}, lining_thickness="0 mm", shells=shells)
        for shells in ("full", "upper", "lower")
    )
    plain = pi / 2 * (26.4**2 - 24**2) * 24
    assert lower.measures["volume"] == pytest.approx(plain, rel=1e-9)  # it has no groove
    assert bush.measures["volume"] == pytest.approx(2 * upper.measures["volume"], rel=1e-9)


@pytest.mark.parametrize("shells", ["pair", "full"])
@pytest.mark.parametrize("size", ["1 mm", "5 m"])
def test_the_smallest_and_the_largest_bore_have_sizes_by_default(size: str, shells: str) -> None:
    shown = build(inner_diameter=size, shells=shells).dimensions
    assert shown["wall"] == pytest.approx(0.05 * {"1 mm": 1, "5 m": 5000}[size])


def test_a_hole_of_four_fifths_of_the_bore() -> None:
    wide = {"width": "60 mm", "oil_hole_diameter": "38.4 mm", "relief_height": "13 mm"}
    assert build(inner_diameter="48 mm", **wide).dimensions["oil_hole_diameter"] == pytest.approx(38.4)
    assert "relief_height" in refused(**{**wide, "relief_height": "14.4 mm"})


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"shells": "full", "tang_width": "2 mm"}, "tang_width"),
        ({"shells": "full", "relief_depth": "0.02 mm"}, "relief_depth"),
        ({"shells": "full", "crush_height": "0.05 mm"}, "crush_height"),
        ({"shells": "full", "state": "free"}, "state"),
        ({"shells": "full", "free_spread": "0.5 mm"}, "free_spread"),
        ({"state": "free", "wall": "10 mm", "inner_chamfer": "0.5 mm"}, "wall"),
        ({"lining_thickness": "1 um"}, "lining_thickness"),
        ({"oil_groove_width": "0 mm", "oil_groove_depth": "0.5 mm"}, "oil_groove_width"),
    ],
)
def test_sizes_that_a_shell_cannot_have_are_refused_by_name(given: dict[str, str], named: str) -> None:
    assert named in refused(**given)


def test_a_groove_with_a_width_and_no_depth_is_none() -> None:
    assert (
        "oil_groove_width"
        not in build(**{**BARE, "oil_groove_width": "5 mm", "oil_groove_depth": "0 mm"}).dimensions
    )


@pytest.mark.parametrize("shells", ["pair", "lower", "full"])
@pytest.mark.parametrize("lining", ["0 mm", "0.6 mm"])
def test_the_tolerance_of_a_wall_joins_bore_and_back(shells: str, lining: str) -> None:
    flange = {"flange_diameter": "60 mm"}
    build_ = build(
        **flange, inner_diameter="48 mm", wall="2.4 mm -0.01/-0.03 mm", shells=shells, lining_thickness=lining
    )
    (wall,) = File(build_.step).dimensions()
    assert (wall.name, wall.nominal, wall.lower, wall.upper) == ("wall", 2.4, -0.03, -0.01)
    assert wall.sides == (
        frozenset({("CYLINDRICAL_SURFACE", 24.0)}),
        frozenset({("CYLINDRICAL_SURFACE", 26.4)}),
    )


@pytest.mark.parametrize("shells", ["upper", "full"])
@pytest.mark.parametrize("angle", ["180 deg", "100 deg"])
@pytest.mark.parametrize(
    ("lining", "depth"), [("0 mm", "0.8 mm"), ("0.6 mm", "0.8 mm"), ("0.6 mm", "0.3 mm")]
)
def test_the_tolerance_of_a_groove_joins_its_sides(shells: str, angle: str, lining: str, depth: str) -> None:
    groove = {"oil_groove_width": "5 mm ±0.1 mm", "oil_groove_depth": depth, "oil_groove_angle": angle}
    build_ = build(inner_diameter="48 mm", **groove, shells=shells, lining_thickness=lining)
    (width,) = File(build_.step).dimensions()
    assert (width.name, width.nominal, width.lower, width.upper) == ("oil_groove_width", 5.0, -0.1, 0.1)
    assert [{keyword for keyword, _ in side} for side in width.sides] == [{"PLANE"}, {"PLANE"}]


def test_the_tolerance_of_a_groove_that_is_none_is_refused_by_name() -> None:
    with pytest.raises(GeometryError) as caught:
        build(inner_diameter="48 mm", oil_groove_width="5 mm ±0.1 mm", oil_groove_depth="0 mm")
    assert (caught.value.code, caught.value.parameters) == ("tolerance", ("oil_groove_width",))
