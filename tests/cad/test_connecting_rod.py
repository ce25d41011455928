"""Connecting rods agree with closed forms of plain shapes; features without room are omitted or refused."""

from math import pi, tan

import numpy as np
import pytest
from seeds import seeded
from test_bearing_parts import drawn, refused

from cad.catalogue import models
from cad.contour import Arc, Contour, Line
from cad.regenerate import Build, as_text, regenerate_class
from cad.revolution import drilled_volume, sheet_under_arc
from templates.core.errors import InvalidInputs

CLS = models().get("connecting_rod", 1)
PLAIN = {
    "boss_height": "38 mm", "cap_boss_height": "36 mm", "boss_corner_radius": "0 mm", "shank_taper": "0 deg",
    "big_end_fillet": "0 mm", "small_end_fillet": "0 mm", "pocket_corner_radius": "0 mm", "bush_wall": "0 mm",
    "oil_hole_diameter": "0 mm", "oil_drilling_diameter": "0 mm", "bolt_hole_diameter": "0 mm",
    "pocket_width": "0 mm",
}  # fmt: skip
"""A square big end and a bar to the ring of the small end."""
SIZES = (
    "big_end_width", "big_end_breadth", "shoulder_height", "cap_height", "bolt_hole_diameter", "bolt_spacing",
    "bolt_hole_depth", "centre_distance", "small_end_bore", "small_end_diameter", "small_end_width",
    "shank_width", "shank_thickness", "pocket_width", "web_thickness",
)  # fmt: skip


def build(**given: str) -> Build:
    return regenerate_class(CLS, as_text(CLS.from_quantities({**CLS.example, **given})))


def volume(**given: str) -> float:
    return build(**{**PLAIN, **given}).measures["volume"]


def plain_volume() -> float:
    """The box of the big end with its bore, the bar up to the circle of the small end, and its ring."""
    big_end = 22 * (84 * (38 + 36) - pi * 25.9**2)
    bar = 14 * (22 * (144 - 38) - sheet_under_arc(17, 11))
    return big_end + bar + 23 * pi * (17**2 - 12**2)


class TestContours:
    def test_analytic_a_circle_and_a_rounded_square(self) -> None:
        half = Arc((0.0, -3.0), (0.0, 3.0), (0.0, 0.0), is_left=True)
        assert Contour([half, half.mirrored()]).area == pytest.approx(9 * pi, rel=1e-14)
        corners = [
            Line((0.0, 0.0), (4.0, 0.0)),
            Arc((4.0, 0.0), (5.0, 1.0), (4.0, 1.0), is_left=True),
            Line((5.0, 1.0), (5.0, 10.0)),
            Line((5.0, 10.0), (0.0, 10.0)),
        ]
        contour = Contour.symmetric(corners)
        assert contour.area == pytest.approx(100 - 2 * (1 - pi / 4), rel=1e-14)
        assert contour.prism(-1, 2).Volume() == pytest.approx(3 * contour.area, rel=1e-12)


class TestVolumes:
    def test_analytic_a_plain_rod_is_a_box_a_bar_and_a_ring(self) -> None:
        assert volume() == pytest.approx(plain_volume(), rel=1e-9)

    def test_analytic_fillets_on_a_square_shoulder_fill_its_corners(self) -> None:
        added = 14 * 2 * (1 - pi / 4) * 10**2
        assert volume(big_end_fillet="10 mm") == pytest.approx(plain_volume() + added, rel=1e-9)

    def test_analytic_round_ends_between_flat_sides(self) -> None:
        """Without bosses the halves are circles, cut off by the sides."""
        sizes = {"boss_height": "0 mm", "cap_boss_height": "0 mm", "big_end_breadth": "70 mm"}
        halves = sheet_under_arc(38, 35) + sheet_under_arc(36, 35) - pi * 25.9**2
        shank = 14 * (22 * 144 - sheet_under_arc(38, 11) - sheet_under_arc(17, 11))
        expected = 22 * halves + shank + 23 * pi * (17**2 - 12**2)
        assert volume(**sizes) == pytest.approx(expected, rel=1e-9)

    def test_analytic_bosses_add_what_is_outside_the_round(self) -> None:
        """A boss is a rectangle from the joint to its seat, less the part of the circle within it."""
        rod = volume(boss_height="22 mm")
        within = 84 * 22 + sheet_under_arc(38, (38**2 - 22**2) ** 0.5) - 22 * 2 * (38**2 - 22**2) ** 0.5
        shoulder = 22 * (within - 84 * 38)
        shank = 14 * (22 * 38 - sheet_under_arc(38, 11))
        assert rod == pytest.approx(plain_volume() + shoulder + shank, rel=1e-9)

    def test_analytic_rounded_bosses_and_pockets_lose_their_corners(self) -> None:
        seats = {"boss_height": "22 mm", "cap_boss_height": "24 mm"}
        sharp, rounded = volume(**seats), volume(**seats, boss_corner_radius="3 mm")
        assert sharp - rounded == pytest.approx(4 * (1 - pi / 4) * 9 * 22, rel=1e-6)
        pocket = {"pocket_width": "13 mm", "web_thickness": "5 mm"}
        length = 144 - 38 - 17 - 9
        assert volume() - volume(**pocket) == pytest.approx(9 * 13 * length, rel=1e-6)
        corners = volume(**pocket, pocket_corner_radius="4 mm") - volume(**pocket)
        assert corners == pytest.approx(9 * 4 * (1 - pi / 4) * 16, rel=1e-5)

    def test_analytic_a_taper_turns_pockets_about_their_middle(self) -> None:
        """A trapezoid has the area of the rectangle as wide as it is halfway."""
        pocket = {"pocket_width": "13 mm", "web_thickness": "5 mm", "shank_taper": "5 deg"}
        assert volume(shank_taper="5 deg") - volume(**pocket) == pytest.approx(9 * 13 * 80, rel=1e-6)

    def test_analytic_oil_runs_through_rod_and_bush(self) -> None:
        bush = {"bush_wall": "1.5 mm"}
        both = {**bush, "oil_hole_diameter": "4 mm"}
        assert volume(**bush) - plain_volume() == pytest.approx(23 * pi * (12**2 - 10.5**2), rel=1e-6)
        assert volume(**bush) - volume(**both) == pytest.approx(drilled_volume(2, 17, 10.5), rel=1e-4)
        drilled = volume() - volume(oil_drilling_diameter="1 mm")  # a thin cylinder from bore to bore
        assert drilled == pytest.approx(pi / 4 * (144 - 25.9 - 12), rel=2e-3)


class TestParts:
    def test_the_bush_is_a_part_of_its_own(self) -> None:
        assert [*build().materials] == ["rod", "cap", "bush"]
        assert [*build(bush_wall="0 mm").materials] == ["rod", "cap"]

    def test_the_taper_is_about_the_middle_of_the_shank(self) -> None:
        """Its sides are where the width and half the taper put them, at the shoulder and at the small end."""
        rod = CLS.from_quantities(CLS.example).drawn()  # type: ignore[attr-defined]
        low, high = rod.side()
        lean = tan(np.radians(2.5))
        middle = (38 + 144 - 17) / 2
        assert low == pytest.approx((11 + middle * lean) * np.cos(np.radians(2.5)), rel=1e-9)
        assert high == pytest.approx((11 - (144 - middle) * lean) * np.cos(np.radians(2.5)), rel=1e-9)
        assert build().dimensions["shank_width"] == pytest.approx(22)
        assert build().dimensions["shank_taper"] == pytest.approx(5)


def rejected(**given: str) -> set[str]:
    with pytest.raises(InvalidInputs) as caught:
        as_text(CLS.from_quantities({**CLS.example, **given}))
    return {name for fault in caught.value.faults for name in fault.names}


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"boss_height": "37.9 mm"}, "boss_height"),
        ({"boss_height": "40 mm"}, "shoulder_height"),
        ({"boss_height": "0 mm"}, "big_end_breadth"),
        ({"boss_height": "20 mm"}, "bolt_hole_depth"),
        ({"cap_boss_height": "15 mm"}, "bolt_spacing"),
        ({"cap_boss_height": "0 mm"}, "cap_boss_height"),
        ({"boss_corner_radius": "5 mm"}, "boss_corner_radius"),
        ({"shank_taper": "28 deg"}, "shank_taper"),
        ({"shank_taper": "0.01 deg"}, "shank_taper"),
        ({"big_end_fillet": "150 mm"}, "big_end_fillet"),
        ({"small_end_fillet": "600 mm"}, "small_end_fillet"),
        ({"pocket_corner_radius": "6 mm"}, "pocket_corner_radius"),
        ({"bush_wall": "6 mm"}, "bush_wall"),
        ({"oil_hole_diameter": "12 mm"}, "oil_hole_diameter"),
        ({"oil_drilling_diameter": "4.8 mm"}, "web_thickness"),
        ({"oil_hole_diameter": "1 um"}, "oil_hole_diameter"),
    ],
)
def test_features_that_have_no_room_are_refused_by_name(given: dict[str, str], named: str) -> None:
    assert named in rejected(**given)


def without_features(sizes: dict[str, float]) -> dict[str, float]:
    """The same sizes of a rod with square ends, parallel sides and nothing else."""
    heights = CLS.from_si({"big_end_bore": sizes["big_end_bore"]}).inputs_si() | sizes
    square = {"boss_height": heights["shoulder_height"], "cap_boss_height": heights["cap_height"]}
    none = ("shank_taper", "boss_corner_radius", "big_end_fillet", "small_end_fillet", "pocket_corner_radius")
    return {**sizes, **square, **dict.fromkeys((*none, "oil_hole_diameter"), 0.0)}


def main_sizes(rng: np.random.Generator) -> dict[str, float]:
    """Random sizes [m] of a rod whose features are left to their defaults."""
    bore, spread = float(10 ** rng.uniform(-2.5, 0.3)), rng.choice([0.3, 0.8, 1.5])
    defaults = CLS.from_si({"big_end_bore": bore}).inputs_si()
    chosen = {name: float(defaults[name]) for name in SIZES if rng.random() < 0.4}
    return {"big_end_bore": bore} | {
        name: v * 2 ** rng.uniform(-spread, spread) for name, v in chosen.items()
    }


def default_features(count: int, seed: int) -> list[dict[str, float]]:
    """Sets of main sizes that make a rod; where a plain rod is possible, one with default features is."""
    rng = np.random.default_rng(seed)
    possible = []
    for sizes in (main_sizes(rng) for _ in range(count)):
        if not refused(CLS, sizes):
            possible.append(sizes)
        else:
            assert refused(CLS, without_features(sizes)), sizes
    return possible


def test_property_default_features_have_room_wherever_a_plain_rod_has() -> None:
    possible = default_features(60, seeded(376))
    assert len(possible) > 5
    assert drawn(CLS, possible[0])


@pytest.mark.slow
def test_property_many_rods_with_default_features_are_drawn() -> None:
    possible = default_features(400, seeded(377))
    assert len(possible) > 60
    assert all(drawn(CLS, sizes) for sizes in possible[:60])
