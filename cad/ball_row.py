"""Rings and balls of a deep groove ball bearing: a group that its models share.

References
----------
Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, ch. 2: osculation, pitch
    diameter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, pi, sin

import numpy as np
from cadquery import Edge, Face, Location, Shape, Solid, Vector
from cadquery.func import face, segment, sphere, wire

from cad.model import BRIGHT_STEEL, Box, CadModel, Part, mm
from templates.core.language.template import Array, Truth, formula, require

INWARDS, OUTWARDS = -1, 1


@dataclass(frozen=True)
class Ring:
    """Cross-section of a ring [mm]: `s` runs from the pitch circle to the back, `z` from mid-width."""

    shoulder: float  # coordinate s of the shoulder
    back: float  # coordinate s of the bore or outside surface
    width: float
    chamfer: float  # of the edges at the back
    groove_radius: float
    groove_centre: float  # coordinate s of the arc's centre; the groove touches the ball at z = 0

    @property
    def _half_angle(self) -> float:
        """Return half the angle of the groove's arc [rad]."""
        return acos((self.shoulder - self.groove_centre) / self.groove_radius)

    @property
    def _segment(self) -> float:
        """Return the area of the circular segment that the groove removes [mm²]."""
        half = self._half_angle
        return self.groove_radius**2 * (half - sin(half) * cos(half))

    def solid(self, pitch_radius: float, side: int) -> Shape:
        """Return the section revolved about z as one profile.

        Cutting the groove with a torus would give bytes that vary between runs.
        """
        section = self._outline(lambda s, z: Vector(pitch_radius + side * s, 0, z))
        return Solid.revolve(section, 360, Vector(0, 0, 0), Vector(0, 0, 1))

    def volume(self, pitch_radius: float, side: int) -> float:
        """Return the volume [mm³]: the area times the path of its centroid (Pappus)."""
        area = (self.back - self.shoulder) * self.width - self.chamfer**2 - self._segment
        rectangle = (self.back**2 - self.shoulder**2) / 2 * self.width
        chamfers = self.chamfer**2 * (self.back - self.chamfer / 3)
        arc = 2 / 3 * (self.groove_radius * sin(self._half_angle)) ** 3
        moment = rectangle - chamfers - self._segment * self.groove_centre - arc
        return 2 * pi * (area * pitch_radius + side * moment)

    def _outline(self, place: Callable[[float, float], Vector]) -> Face:
        """Return the section as a face; `place` converts (s, z) to points in space."""
        half, edge = self.width / 2, self.groove_radius * sin(self._half_angle)
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
        groove = Edge.makeThreePointArc(ends[0], place(self.groove_centre + self.groove_radius, 0), ends[1])
        return face(wire(groove, *(segment(a, b) for a, b in pairwise(corners))))


class BallRow(CadModel):
    """Two rings and the balls between them; the model sets their sizes."""

    d: Array
    D: Array
    B: Array
    D_w: Array
    n: Array

    @formula("mm", "pitch diameter", symbol="D_{pw}")
    def D_pw(self) -> Array:
        """Return the mean of bore and outer diameter."""
        return (self.d + self.D) / 2

    @formula("mm", "ring section", symbol="h")
    def h(self) -> Array:
        """Return the radial height from bore to outer diameter."""
        return (self.D - self.d) / 2

    @formula("mm", "groove radius", symbol="r_g", source="conformity 0.52, Harris and Kotzalas 2006")
    def r_g(self) -> Array:
        """Return the groove radius: slightly more than half the ball diameter."""
        return 0.52 * self.D_w

    @require("outer_diameter", "inner_diameter", remedy="make the outer diameter larger, or omit it")
    def has_section(self) -> Truth:
        """The outer diameter is at least 2 % larger than the bore."""
        return self.D >= 1.02 * self.d

    @require("ball_diameter", "outer_diameter", "inner_diameter",
             remedy="take smaller balls or a larger outer diameter")  # fmt: skip
    def balls_fit_between_rings(self) -> Truth:
        """A ball is at most 90 % of the height from bore to outside, so that no groove cuts a ring."""
        return self.D_w <= 0.9 * self.h

    @require("ball_diameter", "width", remedy="take smaller balls or a wider bearing")
    def balls_fit_in_width(self) -> Truth:
        """The ball diameter is at most the bearing width, so that the rings contain the whole groove."""
        return self.D_w <= self.B

    @require("balls", "ball_diameter", "outer_diameter", "inner_diameter",
             remedy="take fewer or smaller balls")  # fmt: skip
    def balls_do_not_touch(self) -> Truth:
        """The gap between neighbouring balls on the pitch circle is at least 1 % of the ball diameter."""
        return 1.01 * self.D_w <= self.D_pw * np.sin(pi / self.n)

    def ring(self, shoulder: float, chamfer: float) -> Ring:
        """Return the cross-section of the rings; the two rings are mirror images of each other."""
        return Ring(
            shoulder=shoulder,
            back=mm(self.h) / 2,
            width=mm(self.B),
            chamfer=chamfer,
            groove_radius=mm(self.r_g),
            groove_centre=mm(self.D_w) / 2 - mm(self.r_g),
        )

    def rings_and_balls(self, ring: Ring) -> tuple[Part, Part, Part]:
        """Return the two rings and the balls as parts."""
        radius, balls = mm(self.D_pw) / 2, round(float(self.n))
        angles = (2 * pi * i / balls for i in range(balls))
        places = tuple(Location(Vector(radius * cos(a), radius * sin(a), 0)) for a in angles)
        ball = mm(self.D_w)
        return (
            Part("inner_ring", ring.solid(radius, INWARDS), ring.volume(radius, INWARDS)),
            Part("outer_ring", ring.solid(radius, OUTWARDS), ring.volume(radius, OUTWARDS)),
            Part("ball", sphere(ball), pi * ball**3 / 6, BRIGHT_STEEL, places=places),
        )

    def bounding_box(self) -> Box:
        """Return the bounding box of the outer ring, which contains all parts."""
        radius, half = mm(self.D) / 2, mm(self.B) / 2
        return Box((-radius, -radius, -half), (radius, radius, half))
