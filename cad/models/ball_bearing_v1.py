"""Single-row deep groove ball bearing: two rings and their balls, with standard boundary dimensions.

For main and big-end bearings of small engines, and as the placeholder of a bought part in an assembly. At a
standard bore the outer diameter and the width are those of dimension series 02 of ISO 15 (50 mm: 6210, 90 ×
20). Between standard bores they are interpolated; beyond the table they keep the proportions of its ends. The
standard leaves the internal geometry to the maker: balls, grooves and chamfers are drawn in proportions
common among makers, suitable for appearance, mass and clearances, not for a life calculation. There is no
cage.

References
----------
ISO 15:2017, Rolling bearings, radial bearings, boundary dimensions, general plan.
Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, ch. 2: osculation, pitch
    diameter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, pi, sin
from pathlib import Path

import numpy as np
from cadquery import Edge, Face, Location, Solid, Vector
from cadquery.func import face, segment, sphere, wire

from cad.model import BRIGHT_STEEL, Box, CadModel, Part, mm
from cad.surfaces import PartSurfaces, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require, units

SIZES = np.genfromtxt(
    Path(__file__).with_name("deep_groove_sizes.csv"),
    skip_header=2, delimiter=",", names=True, dtype=None, encoding="utf-8",
)  # fmt: skip
SERIES_02 = SIZES[SIZES["series"] == 62]
INWARDS, OUTWARDS = -1, 1


@dataclass(frozen=True)
class Section:
    """Cross-section of a ring [mm]: `s` counts from the pitch circle towards its back, `z` from mid-width."""

    shoulder: float  # s of the shoulder
    back: float  # s of the bore or the outside
    width: float
    chamfer: float  # of the edges at the back
    groove_radius: float
    groove_centre: float  # s of the centre of the groove's arc; the groove touches the ball at z = 0

    @property
    def groove_angle(self) -> float:
        """Return half the angle of the groove's arc [rad]."""
        return acos((self.shoulder - self.groove_centre) / self.groove_radius)

    @property
    def area(self) -> float:
        """Return a rectangle less two chamfers and the circular segment of the groove [mm²]."""
        return (self.back - self.shoulder) * self.width - self.chamfer**2 - self._segment

    @property
    def moment(self) -> float:
        """Return the first moment of the area about the pitch circle [mm³]."""
        rectangle = (self.back**2 - self.shoulder**2) / 2 * self.width
        chamfers = self.chamfer**2 * (self.back - self.chamfer / 3)
        arc = 2 / 3 * (self.groove_radius * sin(self.groove_angle)) ** 3
        return rectangle - chamfers - self._segment * self.groove_centre - arc

    @property
    def _segment(self) -> float:
        half = self.groove_angle
        return self.groove_radius**2 * (half - sin(half) * cos(half))

    def outline(self, place: Callable[[float, float], Vector]) -> Face:
        """Return the section as a face; `place` puts (s, z) into space."""
        half, edge = self.width / 2, self.groove_radius * sin(self.groove_angle)
        bottom = self.groove_centre + self.groove_radius
        ends = place(self.shoulder, -edge), place(self.shoulder, edge)
        corners = [
            ends[1],
            place(self.shoulder, half),
            place(self.back - self.chamfer, half),
            place(self.back, half - self.chamfer),
            place(self.back, self.chamfer - half),
            place(self.back - self.chamfer, -half),
            place(self.shoulder, -half),
            ends[0],
        ]
        groove = Edge.makeThreePointArc(ends[0], place(bottom, 0), ends[1])
        return face(wire(groove, *(segment(a, b) for a, b in pairwise(corners))))


def ring(section: Section, pitch_radius: float, side: int) -> Solid:
    """Return the section turned about z as one profile: a cut by a torus would vary between runs."""
    outline = section.outline(lambda s, z: Vector(pitch_radius + side * s, 0, z))
    return Solid.revolve(outline, 360, Vector(0, 0, 0), Vector(0, 0, 1))


def ring_volume(section: Section, pitch_radius: float, side: int) -> float:
    """Return the area times the path of its centroid [mm³] (Pappus)."""
    return 2 * pi * (section.area * pitch_radius + side * section.moment)


@units("m", returns="m")
def standard_outer_diameter(bore: Array) -> Array:
    """Return the outer diameter [m] for a bore [m], ISO 15, dimension series 02."""
    return _standard("outer_diameter", bore)


@units("m", returns="m")
def standard_width(bore: Array) -> Array:
    """Return the width [m] for a bore [m], ISO 15, dimension series 02."""
    return _standard("width", bore)


def _standard(column: str, bore: Array) -> Array:
    """From the table, straight between its rows, and in proportion to the bore beyond its ends."""
    bores = SERIES_02["inner_diameter"] / 1e3
    nearest = np.clip(bore, bores[0], bores[-1])
    return np.interp(nearest, bores, SERIES_02[column] / 1e3) * (bore / nearest)


class BallBearing(CadModel):
    """Deep groove ball bearing, of standard outside dimensions at a standard bore, and of any other size."""

    example = {"inner_diameter": "50 mm"}
    toleranced = {
        "inner_diameter": {"of": "inner_ring", "cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "outer_diameter": {"of": "outer_ring", "cylinders": "z", "cylindricity": 0.5},
        "width": {"of": "inner_ring", "planes": "z", "perpendicularity": 1, "to": "A"},
        "ball_diameter": {"of": "ball", "spheres": True},
    }

    d: Array = given(
        "mm", "inner diameter", symbol="d", ge=1, le=2000, also=("bearing diameter", "bore", "shaft diameter")
    )

    @derived("mm", "outer diameter", symbol="D", ge=1, le=5000, source="ISO 15, dimension series 02")
    def D(self) -> Array:
        return standard_outer_diameter(self.d)

    @derived(
        "mm",
        "width",
        symbol="B",
        ge=0.1,
        le=2000,
        also=("bearing width",),
        source="ISO 15, dimension series 02",
    )
    def B(self) -> Array:
        return standard_width(self.d)

    @derived("mm", "ball diameter", symbol="D_w", ge=0.003, le=1000)
    def D_w(self) -> Array:
        return np.minimum(np.maximum(0.3 * (self.D - self.d), 0.004 * self.d), 0.9 * self.B)

    @derived("1", "balls", symbol="Z", integer=True, ge=3, le=200)
    def n(self) -> Array:
        return np.clip(np.round(0.58 * pi * self.D_pw / self.D_w), 3, 200)

    @formula("mm", "pitch diameter", symbol="D_{pw}")
    def D_pw(self) -> Array:
        return (self.d + self.D) / 2

    @formula("mm", "ring section", symbol="h")
    def h(self) -> Array:
        return (self.D - self.d) / 2

    @formula("mm", "groove radius", symbol="r_g", source="conformity 0.52, Harris and Kotzalas 2006")
    def r_g(self) -> Array:
        return 0.52 * self.D_w

    @formula("mm", "shoulder height over the ball's centre", name="shoulder", symbol="s")
    def s(self) -> Array:
        return 0.3 * self.D_w

    @formula("mm", "chamfer", symbol="r_s")
    def c(self) -> Array:
        return 0.05 * np.minimum(self.h, self.B)

    @require("outer_diameter", "inner_diameter", remedy="make the outer diameter larger, or leave it out")
    def has_section(self) -> Truth:
        """The outer diameter is at least 2 % larger than the bore."""
        return self.D >= 1.02 * self.d

    @require(
        "ball_diameter",
        "outer_diameter",
        "inner_diameter",
        remedy="take smaller balls or a larger outer diameter",
    )
    def balls_fit_between_rings(self) -> Truth:
        """A ball takes at most 90 % of the height from bore to outside, so that no groove cuts a ring."""
        return self.D_w <= 0.9 * self.h

    @require("ball_diameter", "width", remedy="take smaller balls or a wider bearing")
    def balls_fit_in_width(self) -> Truth:
        """A ball is not wider than the bearing, so that the rings hold the whole groove."""
        return self.D_w <= self.B

    @require(
        "balls", "ball_diameter", "outer_diameter", "inner_diameter", remedy="take fewer or smaller balls"
    )
    def balls_do_not_touch(self) -> Truth:
        """Between neighbouring balls on the pitch circle there is at least 1 % of a ball's diameter."""
        return 1.01 * self.D_w <= self.D_pw * np.sin(pi / self.n)

    def build(self) -> tuple[Part, ...]:
        """Return two rings and the balls."""
        section, radius, balls = self.section(), mm(self.D_pw) / 2, round(float(self.n))
        angles = (2 * pi * i / balls for i in range(balls))
        places = tuple(Location(Vector(radius * cos(a), radius * sin(a), 0)) for a in angles)
        ball = mm(self.D_w)
        return (
            Part("inner_ring", ring(section, radius, INWARDS), ring_volume(section, radius, INWARDS)),
            Part("outer_ring", ring(section, radius, OUTWARDS), ring_volume(section, radius, OUTWARDS)),
            Part("ball", sphere(ball), pi * ball**3 / 6, BRIGHT_STEEL, places=places),
        )

    def section(self) -> Section:
        """Return the cross-section that both rings share; one is turned inwards, one outwards."""
        return Section(
            shoulder=mm(self.s),
            back=mm(self.h) / 2,
            width=mm(self.B),
            chamfer=mm(self.c),
            groove_radius=mm(self.r_g),
            groove_centre=mm(self.D_w) / 2 - mm(self.r_g),
        )

    def bounding_box(self) -> Box:
        """Return the outside of the outer ring; no ball stands out of the width."""
        radius, half = mm(self.D) / 2, mm(self.B) / 2
        return Box((-radius, -radius, -half), (radius, radius, half))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter, as the parts show it."""
        inner, outer, ball = seen["inner_ring"], seen["outer_ring"], seen["ball"]
        return {
            "inner_diameter": inner.diameters(Z)[0],
            "outer_diameter": outer.diameters(Z)[-1],
            "width": outer.length(Z),
            "balls": ball.count,
            "ball_diameter": ball.spheres[0],
        }
