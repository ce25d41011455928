"""Single-row deep groove ball bearing whose sizes follow from its designation; see the class below."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import numpy as np

from cad.ball_row import BallRow
from cad.deep_groove import (
    SIZES,
    Cage,
    bore_by_designation,
    dynamic_capacity_ISO_281_2007,
    outside_by_designation,
    static_capacity_ISO_76_2006,
    static_factor_ISO_76_2006,
    width_by_designation,
)
from cad.model import BRONZE, Part, mm
from cad.surfaces import PartSurfaces, Size, Z
from templates.core.language.template import Array, Truth, choice, derived, formula, require

BRASS_DENSITY = 8400.0  # kg/m³, CuZn39Pb3 (EN 12164: about 8.4 g/cm³)


class DeepGrooveBearing(BallRow):
    """Deep groove ball bearing with the sizes of its designation: rings, balls, cage, and load ratings.

    The designation, such as 6210, determines bore, outer diameter and width; series 618, 60, 62 and 63 are
    available. A size that you give replaces the size of the designation, for example to add a tolerance.

    The cage is a machined brass ring with a round pocket for each ball; a width of 0 omits the cage.

    Dynamic and static capacity are the load ratings of ISO 281 and ISO 76 for the balls in the model. With
    the calculation factor they are inputs of `rolling_bearing_life`.

    Limits
    ------
    The standard leaves the internal geometry to the maker. The default size and number of balls are common
    proportions; give the maker's values to get the maker's capacities, from which the defaults differ by up
    to a tenth. There are no seals, shields or snap rings, and no clearance between balls and grooves.
    Chamfers are proportional, not those of ISO 582. The tables of sizes and factors were compiled without
    access to the standards. The factors agree with their theory, and with makers' ratings of 16 bearings
    within 1 %. Of the sizes of series 618, only 61800 and 61801 were compared with a maker's catalogue.
    Compare the sizes with your edition of the standard before you order.

    References
    ----------
    ISO 15:2017, Rolling bearings, radial bearings, boundary dimensions, general plan.
    ISO 281:2007, Rolling bearings, dynamic load ratings and rating life.
    ISO 76:2006, Rolling bearings, static load ratings.
    Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, ch. 2: osculation.
    """

    example = {"designation": "6210", "ball_diameter": "12.7 mm", "balls": 10}
    toleranced = {
        "inner_diameter": {"datum": "A", "cylindricity": 0.5},
        "outer_diameter": {"cylindricity": 0.5},
        "width": {"perpendicularity": 1, "to": "A"},
        "ball_diameter": {},
        "cage_width": {},
        "cage_thickness": {},
        "pocket_bore": {},
    }

    designation: str = choice(*SIZES, words="designation")

    @derived("mm", "inner diameter", symbol="d", ge=1, le=2000, source="ISO 15",
             also=("bore", "shaft diameter"))  # fmt: skip
    def d(self) -> Array:
        return bore_by_designation(self.designation)

    @derived("mm", "outer diameter", symbol="D", ge=1, le=5000, source="ISO 15")
    def D(self) -> Array:
        return outside_by_designation(self.designation)

    @derived("mm", "width", symbol="B", ge=0.1, le=2000, also=("bearing width",), source="ISO 15")
    def B(self) -> Array:
        return width_by_designation(self.designation)

    @derived("mm", "ball diameter", symbol="D_w", ge=0.003, le=1000)
    def D_w(self) -> Array:
        return np.minimum(0.3 * (self.D - self.d), 0.66 * self.B)

    @derived("1", "balls", symbol="Z", integer=True, ge=3, le=100)
    def n(self) -> Array:
        return np.clip(np.round(0.58 * pi * self.D_pw / self.D_w), 3, 100)

    @derived("mm", "cage width", symbol="B_c", ge=0, le=2000)
    def B_c(self) -> Array:
        return np.minimum(1.35 * self.D_w, 0.95 * self.B)

    @derived("mm", "cage thickness", symbol="t_c", ge=0.001, le=500)
    def t_c(self) -> Array:
        """Return the default thickness in the radial direction."""
        return 0.25 * self.D_w

    @derived("mm", "pocket bore", symbol="D_p", ge=0.003, le=1100)
    def D_p(self) -> Array:
        """Return the default diameter of the cage's pockets."""
        return 1.04 * self.D_w

    @formula("kN", "dynamic capacity", symbol="C", source="ISO 281:2007, 5.1.1")
    def C(self) -> Array:
        return dynamic_capacity_ISO_281_2007(self.D_w, self.D_pw, self.n)

    @formula("1", "calculation factor", symbol="f_0", source="ISO 76:2006, table 1")
    def f_0(self) -> Array:
        return static_factor_ISO_76_2006(self.D_w, self.D_pw)

    @formula("kN", "static capacity", symbol="C_0", source="ISO 76:2006, 5.1")
    def C_0(self) -> Array:
        return static_capacity_ISO_76_2006(self.f_0, self.n, self.D_w)

    @require("ball_diameter", "outer_diameter", "inner_diameter", remedy="take balls of another size")
    def balls_are_rated(self) -> Truth:
        """The ball diameter is 1 % to 40 % of the pitch diameter, the range of ISO 281 and ISO 76."""
        return (self.D_w >= 0.01 * self.D_pw) & (self.D_w <= 0.4 * self.D_pw)

    @require("pocket_bore", "ball_diameter", "cage_width", remedy="make the pockets larger")
    def pockets_hold_balls(self) -> Truth:
        """The pockets are 1 % to 20 % larger than the balls."""
        return (self.B_c <= 0) | ((self.D_p >= 1.01 * self.D_w) & (self.D_p <= 1.2 * self.D_w))

    @require("cage_width", "pocket_bore", "width", remedy="make the cage wider, or 0 for none")
    def cage_closes_pockets(self) -> Truth:
        """The cage is at least 2 % wider than its pockets, and not wider than the bearing."""
        return (self.B_c <= 0) | ((self.B_c >= 1.02 * self.D_p) & (self.B_c <= self.B))

    @require("cage_thickness", "ball_diameter", "cage_width", remedy="change the cage's thickness")
    def cage_clears_rings(self) -> Truth:
        """The cage is 2 % to 50 % as thick as a ball, so that it clears the shoulders of both rings."""
        return (self.B_c <= 0) | ((self.t_c >= 0.02 * self.D_w) & (self.t_c <= 0.5 * self.D_w))

    @require("pocket_bore", "balls", "cage_thickness", "outer_diameter", "inner_diameter", "cage_width",
             remedy="take fewer balls or smaller pockets")  # fmt: skip
    def pockets_leave_bars(self) -> Truth:
        """The pockets occupy at most 97 % of the cage's bore, so that bars are left between them."""
        return (self.B_c <= 0) | (self.D_p <= (self.D_pw - self.t_c) * np.sin(0.97 * pi / self.n))

    def build(self) -> tuple[Part, ...]:
        """Return two rings, the balls, and the cage if the bearing has one."""
        shoulder, chamfer = 0.3 * mm(self.D_w), 0.05 * min(mm(self.h), mm(self.B))
        parts: list[Part] = [*self.rings_and_balls(self.ring(shoulder, chamfer))]
        if self.B_c > 0:
            radius, balls = mm(self.D_pw) / 2, round(float(self.n))
            cage = Cage(radius, mm(self.t_c), mm(self.B_c), mm(self.D_p) / 2, balls)
            parts.append(
                Part("cage", cage.solid(), cage.volume(), BRONZE, BRASS_DENSITY, material="CuZn39Pb3")
            )
        return tuple(parts)

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every length and the number of balls, as read from the parts.

        The sizes of the cage are included if there is one.
        """
        inner, outer, ball = seen["inner_ring"], seen["outer_ring"], seen["ball"]
        sizes: dict[str, float] = {
            "inner_diameter": inner.diameters(Z)[0],
            "outer_diameter": outer.diameters(Z)[-1],
            "width": inner.length(Z),
            "balls": ball.count,
            "ball_diameter": Size.sphere(ball.spheres),
        }
        if "cage" in seen:
            cage = seen["cage"]
            walls = cage.rings(Z)
            sizes["cage_width"] = cage.length(Z)
            sizes["cage_thickness"] = Size.wall(walls[0], walls[-1])
            sizes["pocket_bore"] = Size.diameter([c for c in cage.cylinders if not c.about(Z)])
        return sizes
