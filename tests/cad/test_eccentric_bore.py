"""An eccentric bore has the wall reduction that was given, at its height, and the volume of its segments."""

from math import acos, hypot, pi, sqrt

import pytest
from bare_shells import HALF

from cad.catalogue import models
from cad.errors import GeometryError
from cad.inspect import look_at
from cad.regenerate import Build, as_text, regenerate_class
from cad.revolution import drilled_volume, outline, turned_volume
from cad.shells.eccentric import EccentricBore, offset_of, reduction_at
from cad.step import read_step
from cad.surfaces import Z
from templates.core.errors import InvalidInputs

CLS = models().get("plain_bearing", 1)
SIZES = {"inner_diameter": "48 mm", "wall": "2.4 mm", "width": "24 mm", "lining_thickness": "0.6 mm"}
BARE = {**HALF, **SIZES, "oil_hole_diameter": "0 mm", "oil_groove_width": "0 mm"}


def build(**given: str) -> Build:
    return regenerate_class(CLS, as_text(CLS.from_quantities(given)))


def circle_of(bore: float, reduction: float, height: float) -> tuple[float, float]:
    """Return offset and radius of the bore by halving, without its closed form."""
    low, high = 0.0, 10 * reduction
    for _ in range(80):
        offset = (low + high) / 2
        x = sqrt((bore + offset) ** 2 - (height + offset) ** 2)
        low, high = (offset, high) if hypot(x, height) - bore < reduction else (low, offset)
    return offset, bore + offset


@pytest.mark.parametrize("height", [0.0, 5.0, 9.5])
def test_analytic_the_offset_gives_the_reduction_at_its_height(height: float) -> None:
    offset, _ = circle_of(24.0, 0.05, height)
    assert offset_of(24.0, 0.05, height) == pytest.approx(offset, rel=1e-9)
    assert reduction_at(24.0, offset, height) == pytest.approx(0.05, rel=1e-9)


def test_the_file_has_the_wall_at_the_crown_and_at_the_height() -> None:
    file = build(**BARE, wall_reduction="0.05 mm", reduction_height="9.5 mm").step
    seen = look_at(read_step(file))
    (bore,) = (c for c in seen["upper_lining"].cylinders if c.along(Z) and not c.about(Z))
    radius, axis = bore.diameter / 2, bore.point.y
    assert axis + radius == pytest.approx(24, abs=1e-9)  # the crown is where it was
    across = sqrt(radius**2 - (9.5 - axis) ** 2)
    assert 26.4 - hypot(across, 9.5) == pytest.approx(2.35, abs=1e-9)


def test_analytic_the_lining_is_a_half_disc_less_a_segment() -> None:
    half = build(**BARE, wall_reduction="0.05 mm").measures["volume"]
    offset, radius = circle_of(24.0, 0.05, 9.6)
    segment = radius**2 * acos(offset / radius) - offset * sqrt(radius**2 - offset**2)
    assert half == pytest.approx(24 * (pi / 2 * 26.4**2 - segment), rel=1e-9)


def test_analytic_what_is_cut_from_a_nearly_concentric_bore_is_that_of_a_concentric_one() -> None:
    bore, ring = EccentricBore(24.0, 1e-9), EccentricBore(24.0, 0.0)
    assert bore.sector(24.6, pi) == pytest.approx(ring.sector(24.6, pi), rel=1e-6)
    triangle = outline((24.0, 0.0), (24.0, 0.48), (24.48, 0.0))
    assert bore.chamfered(0.48, 24.6) == pytest.approx(turned_volume(triangle, 180.0), rel=1e-7)
    assert drilled_volume(2.0, 26.4, 24.0, offset=1e-9) == pytest.approx(
        drilled_volume(2.0, 26.4, 24.0), rel=1e-8
    )


@pytest.mark.parametrize(
    "given",
    [
        {"shells": "pair"},
        {"oil_groove_angle": "100 deg", "oil_groove_depth": "0.4 mm"},
        {"crush_height": "0.06 mm", "inner_chamfer": "0.9 mm", "flange_diameter": "64 mm"},
    ],
)
def test_features_are_drawn_with_an_eccentric_bore(given: dict[str, str]) -> None:
    dimensions = build(**SIZES, wall_reduction="0.05 mm", **given).dimensions
    assert dimensions["wall_reduction"] == pytest.approx(0.05, abs=1e-6)
    assert (dimensions["inner_diameter"], dimensions["wall"]) == pytest.approx((48, 2.4), abs=1e-6)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"wall_reduction": "0.3 mm"}, "lining_thickness"),
        ({"wall_reduction": "0.1 um"}, "wall_reduction"),
        ({"lining_thickness": "0 mm"}, "lining_thickness"),
        ({"relief_depth": "0.02 mm"}, "relief_depth"),
        ({"shells": "full"}, "shells"),
        ({"state": "free"}, "state"),
        ({"reduction_height": "18 mm"}, "reduction_height"),
        ({"oil_groove_depth": "0.1 mm"}, "oil_groove_depth"),
        ({"inner_chamfer": "0.06 mm"}, "inner_chamfer"),
    ],
)
def test_what_an_eccentric_bore_excludes_is_refused_by_name(given: dict[str, str], named: str) -> None:
    with pytest.raises(InvalidInputs) as caught:
        as_text(CLS.from_quantities({**SIZES, "wall_reduction": "0.05 mm", **given}))
    assert named in {name for fault in caught.value.faults for name in fault.names}


def test_a_bore_that_no_face_has_carries_no_tolerance() -> None:
    with pytest.raises(GeometryError, match="inner_diameter"):
        build(**{**SIZES, "inner_diameter": "48 mm H7"}, wall_reduction="0.05 mm")
