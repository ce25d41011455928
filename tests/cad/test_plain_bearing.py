"""Plain bearings agree with closed forms for rings, grooves and holes, and refuse wrong parameters."""

from math import pi

import numpy as np
import pytest
from bare_shells import BUSH, HALF
from part21_reader import File
from seeds import seeded

from cad.catalogue import models
from cad.errors import GeometryError
from cad.model import CadModel
from cad.regenerate import Build, as_text, regenerate_class
from cad.revolution import drilled_volume
from templates.core.errors import InvalidInputs

CLS = models().get("plain_bearing", 1)
BARE = {
    "inner_diameter": "48 mm", "wall": "2.4 mm", "width": "24 mm", "oil_hole_diameter": "0 mm",
    "oil_groove_width": "0 mm", "tang_width": "0 mm", "relief_depth": "0 mm", "inner_chamfer": "0 mm",
    "outer_chamfer": "0 mm",
}  # fmt: skip


def build(**given: str) -> Build:
    return regenerate_class(CLS, as_text(CLS.from_quantities(given)))


def refused(**given: str) -> dict[str, str]:
    """Return what a refusal says, by each name."""
    with pytest.raises(InvalidInputs) as caught:
        as_text(CLS.from_quantities({"inner_diameter": "48 mm", **given}))
    return {name: fault.detail for fault in caught.value.faults for name in fault.names}


def test_property_a_groove_below_a_tang_is_refused_early_or_drawn() -> None:
    """A groove that came through the root of the tang was filled by it again, and its volume was wrong."""
    rng, drawn = np.random.default_rng(seeded(379)), 0
    for _ in range(25):
        given = {
            "oil_groove_width": f"{rng.uniform(10, 16):.6g} mm",
            "oil_groove_depth": f"{rng.uniform(0.9, 1.9):.6g} mm",
            "tang_length": f"{rng.uniform(2, 7):.6g} mm",
            "shells": "upper",
        }
        try:
            texts = as_text(CLS.from_quantities({**BARE, "tang_width": "3 mm", **given}))
        except InvalidInputs:
            continue
        assert regenerate_class(CLS, texts).step
        drawn += 1
    assert 5 < drawn < 25
    deep = {**BARE, "oil_groove_width": "14 mm", "oil_groove_depth": "1.9 mm", "tang_width": "4 mm"}
    message = refused(**{**deep, "tang_length": "5 mm", "shells": "upper"})["oil_groove_depth"]
    assert "Where a groove runs below the tang" in message


@pytest.mark.parametrize("wall", [2.4, 30.0])
@pytest.mark.parametrize("lining", ["0 mm", "0.6 mm"])
def test_analytic_a_bare_bush_is_a_ring(wall: float, lining: str) -> None:
    bush = build(**{**BARE, "wall": f"{wall} mm"}, shells="full", lining_thickness=lining)
    assert bush.measures["volume"] == pytest.approx(pi * ((24 + wall) ** 2 - 24**2) * 24, rel=1e-9)
    assert (bush.measures["low_y"], bush.measures["centre_y"]) == pytest.approx((-24 - wall, 0), abs=1e-6)
    assert set(bush.materials) == ({"full_back"} if lining == "0 mm" else {"full_back", "full_lining"})


def test_analytic_a_bare_half_is_half_a_ring() -> None:
    half = build(**HALF, inner_diameter="48 mm", oil_hole_diameter="0 mm", oil_groove_width="0 mm").measures
    outer, inner = 26.4, 24.0
    assert half["volume"] == pytest.approx(pi / 2 * (outer**2 - inner**2) * 24, rel=1e-9)
    centroid = 4 / (3 * pi) * (outer**3 - inner**3) / (outer**2 - inner**2)
    assert half["centre_y"] == pytest.approx(centroid, rel=1e-9)


@pytest.mark.parametrize("shells", ["upper", "full"])
@pytest.mark.parametrize("hole", ["0 mm", "3 mm", "5 mm", "5.1 mm", "12 mm"])
@pytest.mark.parametrize(("groove", "depth"), [("0 mm", "0 mm"), ("5 mm", "0 mm"), ("5 mm", "0.8 mm")])
@pytest.mark.sampled(8)
def test_every_combination_of_hole_and_groove_is_drawn(
    shells: str, hole: str, groove: str, depth: str
) -> None:
    oil = {"oil_hole_diameter": hole, "oil_groove_width": groove, "oil_groove_depth": depth}
    result = build(**{**HALF, **oil, "shells": shells}, inner_diameter="48 mm")
    assert f"{result.dimensions.get('oil_hole_diameter', 0.0):g} mm" == hole
    assert result.dimensions.get("oil_groove_depth", 0.0) == (0.8 if depth == "0.8 mm" else 0.0)
    assert result.measures["low_y"] == pytest.approx(0 if shells == "upper" else -26.4, abs=1e-6)


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


def test_two_halves_are_a_bush_and_the_hole_of_the_second() -> None:
    groove = {"oil_groove_width": "4.8 mm", "oil_groove_depth": "0.72 mm", "oil_hole_diameter": "3.84 mm"}
    bush, half = (build(**{**given, **groove}, inner_diameter="48 mm").measures for given in (BUSH, HALF))
    hole = drilled_volume(1.92, 26.4, 24, 24.72, 2.4)
    assert bush["volume"] == pytest.approx(2 * half["volume"] + hole, rel=1e-9)


def test_analytic_a_small_hole_is_a_cylinder_through_the_wall() -> None:
    assert drilled_volume(1e-4, 26, 24) == pytest.approx(pi * 1e-8 * 2, rel=1e-6)


def test_analytic_a_groove_wider_than_its_hole_is_a_larger_bore() -> None:
    assert drilled_volume(4, 26, 24, 25, 5) == pytest.approx(drilled_volume(4, 26, 25), rel=1e-10)


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
        ({"oil_groove_width": "0 mm", "oil_groove_depth": "1 mm"}, "oil_groove_depth"),
        ({"wall": "0 mm"}, "wall"),
        ({"wall": "-1 mm"}, "wall"),
        ({"oil_hole_diameter": "24 mm"}, "oil_hole_diameter"),
        ({"oil_hole_diameter": "24 mm"}, "width"),
        ({"oil_hole_diameter": "47 mm", "width": "100 mm"}, "inner_diameter"),
        ({"oil_hole_diameter": "5.00001 mm", "oil_groove_width": "5 mm"}, "oil_hole_diameter"),
        ({"oil_hole_diameter": "5.00001 mm", "oil_groove_width": "5 mm"}, "oil_groove_width"),
        ({"oil_hole_diameter": "1 nm"}, "oil_hole_diameter"),
        ({"oil_groove_depth": "2.4 mm"}, "oil_groove_depth"),
        ({"oil_groove_depth": "2.4 mm"}, "wall"),
        ({"oil_groove_width": "23 mm"}, "oil_groove_width"),
        ({"shells": "third"}, "shells"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_sizes_that_a_shell_cannot_have_are_refused_by_name(given: dict[str, str], named: str) -> None:
    assert named in refused(**given)


def test_a_refusal_says_the_values_and_the_remedy() -> None:
    detail = refused(oil_groove_depth="2.4 mm")["oil_groove_depth"]
    assert "2.4 mm" in detail
    assert "shallower" in detail


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


@pytest.mark.sampled(4)
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


Sizes = dict[str, float]


def anywhere(rng: np.random.Generator) -> Sizes:
    """Return sizes [mm] of a bare shell in all of their ranges, or by shares of the bore."""
    d, wide = 10 ** rng.uniform(0, np.log10(5000)), bool(rng.random() < 0.3)

    def length(name: str, low: float, high: float) -> float:
        bounds = CLS.inputs[name].meaning.domain_si
        smallest, largest = max(bounds.ge, 1e-5) * 1e3, bounds.le * 1e3
        least, most = (smallest, largest) if wide else (d * low, d * high)
        return float(np.clip(least * (most / least) ** rng.random(), smallest, largest))

    wall = length("wall", 0.03, 2)
    hole, groove = length("oil_hole_diameter", 0.02, 0.8), length("oil_groove_width", 0.02, 1)
    return {
        "inner_diameter": d,
        "wall": wall,
        "width": length("width", 0.1, 3),
        "oil_hole_diameter": 0.0 if rng.random() < 0.2 else hole,
        "oil_groove_width": 0.0 if rng.random() < 0.2 else groove,
        "oil_groove_depth": 0.0 if rng.random() < 0.3 else min(wall * rng.uniform(0.01, 0.9), 500.0),
    }


def is_possible(size: Sizes) -> bool:
    """Return whether groove and hole leave a shell in one piece, with edges that keep clear of each other."""
    hole, groove, depth = (size[f"oil_{name}"] for name in ("hole_diameter", "groove_width", "groove_depth"))
    return (
        groove <= 0.9 * size["width"]
        and depth <= 0.8 * size["wall"]
        and (depth == 0 or groove > 0)
        and hole <= min(0.9 * size["width"], 0.8 * size["inner_diameter"])
        and (depth == 0 or not groove < hole < 1.01 * groove)
        and all(length == 0 or length >= 0.01 for length in (hole, groove, depth))
    )


def bare(kind: dict[str, str], size: Sizes) -> CadModel:
    return CLS.from_quantities({**kind, **{name: f"{value:.9f} mm" for name, value in size.items()}})


def possible(sets: int, seed: int) -> list[Sizes]:
    rng = np.random.default_rng(seed)
    return [size for size in (anywhere(rng) for _ in range(sets)) if is_possible(size)]


def has_the_volume_of_its_ring(kind: dict[str, str], size: Sizes) -> None:
    """Compare the solid with a ring, or half of one, less its groove and its hole."""
    build = regenerate_class(CLS, as_text(bare(kind, size)))
    d, t, B, hole, groove, depth = size.values()
    r, R, half_groove = d / 2, d / 2 + t, groove / 2 if depth > 0 else 0.0
    ring = pi * ((R**2 - r**2) * B - ((r + depth) ** 2 - r**2) * 2 * half_groove)
    share = 1.0 if kind["shells"] == "full" else 0.5
    expected = share * ring - drilled_volume(hole / 2, R, r, r + depth, half_groove)
    # models draw in steps of 1e-9 mm, and the thinnest wall here has 0.04 mm
    assert build.measures["volume"] == pytest.approx(expected, rel=1e-7), size


def test_property_bare_shells_are_accepted_in_all_sizes() -> None:
    sizes = possible(400, seed=seeded(7))
    assert len(sizes) > 40
    for size in sizes:
        assert as_text(bare(BUSH, size))
        assert as_text(bare(HALF, size))


@pytest.mark.parametrize("kind", [BUSH, HALF], ids=["bush", "half"])
def test_property_some_bare_shells_have_the_volume_of_their_ring(kind: dict[str, str]) -> None:
    for size in possible(40, seed=8)[:3]:
        has_the_volume_of_its_ring(kind, size)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [BUSH, HALF], ids=["bush", "half"])
def test_property_many_bare_shells_have_the_volume_of_their_ring(kind: dict[str, str]) -> None:
    for size in possible(300, seed=seeded(9))[:40]:
        has_the_volume_of_its_ring(kind, size)
