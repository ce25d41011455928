"""Plain bearing shell, half or full, with an oil groove around the bore and an oil hole at the crown.

For crankshaft main, big-end and small-end bearings. The bore is the finished one: the caller adds the
clearance. The half shell stands on the side +y, its joint in the plane y = 0; the hole points along +y in
either shell. A hole of no diameter is no hole, a groove of no width or no depth is no groove. No crush
height, locating lug or relief is drawn.

References
----------
ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: tolerances, design features and methods of
    test.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, cos, pi, sin, sqrt

import numpy as np
from cadquery import Shape, Solid, Vector
from cadquery.func import cut, face, polyline, revolve
from scipy.integrate import quad

from cad.model import BRONZE, Box, CadModel, Part, mm
from cad.surfaces import Seen, Y, Z
from templates.core.language.template import Array, Truth, choice, derived, formula, given, require, units


@dataclass(frozen=True)
class Shell:
    """What is drawn [mm]: radii from the axis of the bore."""

    bore: float
    groove: float  # radius of its bottom; that of the bore if there is no groove
    outside: float
    half_width: float
    half_groove: float  # half its width
    hole: float  # radius
    turn: float  # 180° or 360°

    def outline(self) -> list[tuple[float, float]]:
        """Return the cross-section as a closed line through (r, z)."""
        r, g, R, b, w = self.bore, self.groove, self.outside, self.half_width, self.half_groove
        groove = [(r, w), (g, w), (g, -w), (r, -w)] if g > r and w > 0 else []
        return [(r, -b), (R, -b), (R, b), (r, b), *groove, (r, -b)]

    def solid(self) -> Shape:
        """Return the outline turned about z from +x over +y.

        A full turn begins at -y, its seam off the hole.
        """
        start = (0, -1) if self.turn == 360 else (1, 0)
        points = (Vector(r * start[0], r * start[1], z) for r, z in self.outline())
        turned = revolve(face(polyline(*points)), (0, 0, 0), (0, 0, 1), self.turn)
        return cut(turned, self.drill()) if self.hole > 0 else turned

    def drill(self) -> Solid:
        """Return what the oil hole takes away, from the axis to beyond the crown."""
        return Solid.makeCylinder(self.hole, 1.1 * self.outside, Vector(0, 0, 0), Vector(0, 1, 0))

    def volume(self) -> float:
        """Return the turned outline less the hole [mm³]."""
        wall = (self.outside**2 - self.bore**2) * self.half_width
        groove = (self.groove**2 - self.bore**2) * self.half_groove
        return 2 * pi * (wall - groove) * self.turn / 360 - self.hole_volume()

    def hole_volume(self) -> float:
        """What the hole takes out of the wall [mm³]: its chords along y, summed over the hole's circle.

        With x = a sin t and z = a cos t on the circle of radius a the integrand is smooth; it has one kink,
        where the circle crosses the edge of the groove.
        """
        a, w = self.hole, self.half_groove
        if a == 0:
            return 0.0
        kink = acos(min(w / a, 1.0))
        pieces = ((0.0, kink), (kink, pi / 2))
        return 2 * sum(quad(self._slice, low, high, epsabs=0, epsrel=1e-11)[0] for low, high in pieces)

    def _slice(self, t: float) -> float:
        """Return the area of the hole's section at x = a sin t within the wall, times dx/dt [mm³]."""
        x, z = self.hole * sin(t), self.hole * cos(t)
        in_groove = min(z, self.half_groove)
        outside, groove, bore = (sqrt(R * R - x * x) for R in (self.outside, self.groove, self.bore))
        return 2 * z * (z * outside - in_groove * groove - (z - in_groove) * bore)


class PlainBearing(CadModel):
    """Plain bearing shell, half or full, with an oil groove and an oil hole.

    The shell is one solid of steel, by whose density its mass is computed. Its colour is that of the running
    surface: the lining is too thin to be a body of its own.
    """

    example = {"inner_diameter": "48 mm"}
    film_bore = "inner_diameter"
    toleranced = {
        "inner_diameter": {"of": "shell", "cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "wall": {"of": "shell", "walls": "z"},
        "width": {"of": "shell", "planes": "z", "perpendicularity": 1, "to": "A"},
        "oil_hole_diameter": {"of": "shell", "cylinders": "y"},
        "oil_groove_width": {"of": "shell", "planes": "z", "levels": [[1, 2]]},
    }

    d: Array = given("mm", "inner diameter", symbol="d", ge=1, le=5000, also=("bearing diameter", "bore"))

    @derived("mm", "wall", symbol="t", ge=0.04, le=1000)
    def t(self) -> Array:
        return 0.05 * self.d

    @derived("mm", "width", symbol="B", ge=0.1, le=5000, also=("bearing width",))
    def B(self) -> Array:
        return 0.5 * self.d

    shell: str = choice("full", "half", words="shell", default="half")

    @derived("mm", "oil hole diameter", symbol="d_h", ge=0, le=1000)
    def d_h(self) -> Array:
        return np.minimum(0.08 * self.d, 0.2 * self.B)

    @derived("mm", "oil groove width", symbol="w_g", ge=0, le=1000)
    def w_g(self) -> Array:
        return np.minimum(1.25 * self.d_h, 0.9 * self.B)

    @derived("mm", "oil groove depth", symbol="t_g", ge=0, le=500)
    def t_g(self) -> Array:
        return 0.3 * self.t * np.sign(self.w_g)

    @formula("mm", "outer diameter", symbol="D")
    def D(self) -> Array:
        return self.d + 2 * self.t

    @require("oil_groove_width", "width", remedy="make the groove narrower or the bearing wider")
    def groove_within_width(self) -> Truth:
        """The oil groove takes at most 90 % of the width."""
        return self.w_g <= 0.9 * self.B

    @require("oil_groove_depth", "wall", remedy="make the groove shallower or the wall thicker")
    def groove_within_wall(self) -> Truth:
        """The oil groove takes at most 80 % of the wall."""
        return self.t_g <= 0.8 * self.t

    @require("oil_groove_depth", "oil_groove_width", remedy="give the groove a width, or no depth")
    def groove_has_width(self) -> Truth:
        """An oil groove that has a depth has a width."""
        return (self.t_g == 0) | (self.w_g > 0)

    @require("oil_hole_diameter", "width", remedy="make the hole smaller or the bearing wider")
    def hole_within_width(self) -> Truth:
        """The oil hole takes at most 90 % of the width, so that the shell stays one piece."""
        return self.d_h <= 0.9 * self.B

    @require("oil_hole_diameter", "inner_diameter", remedy="make the hole smaller")
    def hole_within_bore(self) -> Truth:
        """The oil hole takes at most 80 % of the bore, so that it has a wall all around."""
        return self.d_h <= 0.8 * self.d

    @require(
        "oil_hole_diameter",
        "oil_groove_width",
        remedy="make the hole as wide as the groove, or change it by 1 %",
    )
    def hole_clears_groove_edge(self) -> Truth:
        """An oil hole wider than its groove is wider by 1 %; for less, OpenCASCADE returns wrong solids."""
        return (self.t_g == 0) | (self.w_g == 0) | (self.d_h <= self.w_g) | (self.d_h >= 1.01 * self.w_g)

    @require("oil_hole_diameter", "oil_groove_width", "oil_groove_depth", remedy="use 0 for none")
    def features_are_drawable(self) -> Truth:
        """The oil hole and the oil groove measure 0, or at least the 10 µm that the kernel draws reliably."""
        return drawable(self.d_h) & drawable(self.w_g) & drawable(self.t_g)

    def build(self) -> tuple[Part, ...]:
        """Return one shell."""
        shell = self.drawn()
        return (Part("shell", shell.solid(), shell.volume(), BRONZE),)

    def drawn(self) -> Shell:
        """Return the parameters as radii and halves."""
        return Shell(
            bore=mm(self.d) / 2,
            groove=mm(self.d) / 2 + mm(self.t_g),
            outside=mm(self.D) / 2,
            half_width=mm(self.B) / 2,
            half_groove=mm(self.w_g) / 2,
            hole=mm(self.d_h) / 2,
            turn=360 if self.shell == "full" else 180,
        )

    def bounding_box(self) -> Box:
        """A half shell fills only the side of its crown."""
        radius, half = mm(self.D) / 2, mm(self.B) / 2
        return Box((-radius, 0 if self.shell == "half" else -radius, -half), (radius, radius, half))

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """Return every length that the shell has; no groove and no hole show none."""
        shell = seen["shell"]
        diameters, levels, holes = shell.diameters(Z), shell.levels(Z), shell.diameters(Y)
        found = {
            "inner_diameter": diameters[0],
            "wall": (diameters[-1] - diameters[0]) / 2,
            "width": levels[-1] - levels[0],
            "oil_hole_diameter": holes[0] if holes else 0.0,
        }
        if len(levels) == 4:  # both ends, and both sides of a groove
            found["oil_groove_width"] = levels[2] - levels[1]
            found["oil_groove_depth"] = (diameters[1] - diameters[0]) / 2
        return found


@units("m", returns="1")
def drawable(length: Array) -> Truth:
    """Return whether a length [m] is none, or one that the kernel can tell from none."""
    return (length == 0) | (length >= 1e-5)
