"""Flanged bush of copper alloy: a cylinder with a flange, chamfers, an oil groove and an oil hole.

The docstring of the class below explains the parameters to users.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from cadquery import Shape
from cadquery.func import cut

from cad.model import BRONZE, Box, CadModel, Part, mm
from cad.revolution import Point, drill, drilled_volume, outline, turned, turned_volume
from cad.surfaces import PartSurfaces, Size, Y, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require, units


@units("m", returns="1")
def drawable(length: Array) -> Truth:
    """Return whether a length [m] is 0, or large enough for the kernel."""
    return (length <= 0) | (length >= 1e-5)


@dataclass(frozen=True)
class Bush:
    """Sizes of a bush [mm]: radii from the axis, levels from the face of the flange."""

    bore: float
    outside: float
    flange: float
    flange_thickness: float
    width: float
    inner_chamfer: float
    outer_chamfer: float
    groove: float  # radius of the groove's bottom; of the bore if there is no groove
    half_groove: float
    hole: float

    @property
    def middle(self) -> float:
        """Return the level of oil groove and oil hole: the middle of the length beyond the flange."""
        return (self.flange_thickness + self.width) / 2

    def section(self) -> list[Point]:
        """Return the cross-section as a closed line through (r, z)."""
        r, g, c, z, w = self.bore, self.groove, self.inner_chamfer, self.middle, self.half_groove
        groove: list[Point] = [(r, z + w), (g, z + w), (g, z - w), (r, z - w)] if g > r and w > 0 else []
        return outline(
            (r, c),
            (r + c, 0.0),
            (self.flange, 0.0),
            (self.flange, self.flange_thickness),
            (self.outside, self.flange_thickness),
            (self.outside, self.width - self.outer_chamfer),
            (self.outside - self.outer_chamfer, self.width),
            (r + c, self.width),
            (r, self.width - c),
            *groove,
        )

    def solid(self) -> Shape:
        """Return the section revolved about z, minus the hole at the crown."""
        body = turned(self.section())
        return cut(body, drill(self.hole, self.outside, self.middle)) if self.hole > 0 else body

    def volume(self) -> float:
        """Return the volume of the revolved section minus the hole [mm³]."""
        half_groove = self.half_groove if self.groove > self.bore else 0.0
        hole = drilled_volume(self.hole, self.outside, self.bore, self.groove, half_groove)
        return turned_volume(self.section()) - hole


class FlangedBush(CadModel):
    """Flanged bush of copper alloy, with chamfers, an oil groove round the bore and an oil hole.

    z is along the shaft; the outer face of the flange is at z = 0, and the bush extends from it towards +z.
    Oil groove and oil hole are at the middle of the length beyond the flange, the hole at the crown +y. There
    are chamfers of 45° on the bore at both ends, and on the outside at the end that is pressed in first. A
    size of 0 omits the hole, the groove or a chamfer.

    The bore is the finished bore after pressing in; it must already include the clearance.

    Limits
    ------
    The default proportions are close to ISO 4379, form F (flange about one wall wide and one wall thick). The
    table of the standard is not included, so give its dimensions if you need them. The model omits the
    undercut beneath the flange, the chamfers of the flange, and the seam of a wrapped bush of ISO 3547.

    References
    ----------
    ISO 4379:2018, Plain bearings, copper alloy bushes: the features of form F.
    ISO 3547-1:2017, Plain bearings, wrapped bushes, part 1: dimensions.
    """

    example = {
        "inner_diameter": "20 mm",
        "wall": "3 mm",
        "flange_diameter": "32 mm",
        "flange_thickness": "3 mm",
        "width": "30 mm",
        "inner_chamfer": "0.5 mm",
        "outer_chamfer": "0.8 mm",
        "oil_hole_diameter": "3 mm",
        "oil_groove_width": "4 mm",
        "oil_groove_depth": "0.8 mm",
    }
    film_bore = "inner_diameter"
    toleranced = {
        "inner_diameter": {"datum": "A", "cylindricity": 0.5},
        "flange_diameter": {},
        "flange_thickness": {},
        "width": {"perpendicularity": 1, "to": "A"},
        "oil_hole_diameter": {},
        "wall": {},
        "inner_chamfer": {},
        "outer_chamfer": {},
        "oil_groove_width": {},
        "oil_groove_depth": {},
    }

    d: Array = given("mm", "inner diameter", symbol="d", ge=1, le=5000, also=("bearing diameter", "bore"))

    @derived("mm", "wall", symbol="t", ge=0.04, le=1000)
    def t(self) -> Array:
        return 0.12 * self.d

    @derived("mm", "width", symbol="B", ge=0.1, le=10000, also=("bearing width",))
    def B(self) -> Array:
        """Return the default overall length, including the flange."""
        return self.d

    @derived("mm", "flange diameter", symbol="D_f", ge=1, le=10000)
    def D_f(self) -> Array:
        return self.d + 4 * self.t

    @derived("mm", "flange thickness", symbol="b_f", ge=0.02, le=1000)
    def b_f(self) -> Array:
        return self.t

    @derived("mm", "inner chamfer", symbol="c_i", ge=0, le=500)
    def c_i(self) -> Array:
        return 0.15 * self.t

    @derived("mm", "outer chamfer", symbol="c_o", ge=0, le=500)
    def c_o(self) -> Array:
        return 0.25 * self.t

    @derived("mm", "oil hole diameter", symbol="d_h", ge=0, le=1000)
    def d_h(self) -> Array:
        """Return the default: no oil hole."""
        return 0 * self.d

    @derived("mm", "oil groove width", symbol="w_g", ge=0, le=1000)
    def w_g(self) -> Array:
        return 1.25 * self.d_h

    @derived("mm", "oil groove depth", symbol="t_g", ge=0, le=500)
    def t_g(self) -> Array:
        return 0.3 * self.t * np.sign(self.w_g)

    @formula("mm", "outer diameter", symbol="D")
    def D(self) -> Array:
        return self.d + 2 * self.t

    @formula("mm", "length beyond the flange", name="shank", symbol="L")
    def L(self) -> Array:
        return self.B - self.b_f

    @require("flange_diameter", "inner_diameter", "wall", remedy="make the flange larger")
    def flange_stands_out(self) -> Truth:
        """The flange is at least 1 % larger than the outside of the bush."""
        return self.D_f >= 1.01 * self.D

    @require("flange_thickness", "width", remedy="make the flange thinner or the bush longer")
    def flange_leaves_a_bush(self) -> Truth:
        """The thickness of the flange is at most 80 % of the width."""
        return self.b_f <= 0.8 * self.B

    @require("inner_chamfer", "outer_chamfer", "wall", remedy="make the chamfers smaller")
    def chamfers_leave_a_face(self) -> Truth:
        """The chamfers together are at most 80 % of the wall."""
        return self.c_i + self.c_o <= 0.8 * self.t

    @require(
        "inner_chamfer", "outer_chamfer", "width", "flange_thickness", remedy="make the chamfers smaller"
    )
    def chamfers_leave_a_length(self) -> Truth:
        """A chamfer is at most 40 % of the length beyond the flange."""
        return (self.c_i <= 0.4 * self.L) & (self.c_o <= 0.4 * self.L)

    @require(
        "oil_groove_width", "inner_chamfer", "outer_chamfer", "width", "flange_thickness",
        remedy="make the groove narrower, the chamfers smaller or the bush longer",
    )  # fmt: skip
    def groove_keeps_off_the_ends(self) -> Truth:
        """The oil groove and the chamfers occupy at most 95 % of the length beyond the flange."""
        return self.w_g + 2 * np.maximum(self.c_i, self.c_o) <= 0.95 * self.L

    @require(
        "oil_hole_diameter", "inner_chamfer", "outer_chamfer", "width", "flange_thickness",
        remedy="make the hole smaller, the chamfers smaller or the bush longer",
    )  # fmt: skip
    def hole_keeps_off_the_ends(self) -> Truth:
        """The oil hole and the chamfers occupy at most 95 % of the length beyond the flange."""
        return self.d_h + 2 * np.maximum(self.c_i, self.c_o) <= 0.95 * self.L

    @require("oil_groove_depth", "wall", remedy="make the groove shallower or the wall thicker")
    def groove_within_wall(self) -> Truth:
        """The depth of the oil groove is at most 80 % of the wall."""
        return self.t_g <= 0.8 * self.t

    @require("oil_groove_depth", "oil_groove_width", remedy="give the groove a width, or no depth")
    def groove_has_width(self) -> Truth:
        """An oil groove with a depth also has a width."""
        return (self.t_g <= 0) | (self.w_g > 0)

    @require("oil_hole_diameter", "inner_diameter", remedy="make the hole smaller")
    def hole_within_bore(self) -> Truth:
        """The oil hole is at most 80 % as wide as the bore, so that there is a wall all around it."""
        return self.d_h <= 0.8 * self.d

    @require(
        "oil_hole_diameter", "oil_groove_width",
        remedy="make the hole as wide as the groove, or change it by 1 %",
    )  # fmt: skip
    def hole_clears_groove_edge(self) -> Truth:
        """An oil hole wider than its groove is wider by 1 %; for less, OpenCASCADE builds wrong solids."""
        return (self.t_g <= 0) | (self.w_g <= 0) | (self.d_h <= self.w_g) | (self.d_h >= 1.01 * self.w_g)

    @require(
        "oil_hole_diameter", "oil_groove_width", "oil_groove_depth", "inner_chamfer", "outer_chamfer",
        remedy="use 0 for none",
    )  # fmt: skip
    def features_are_drawable(self) -> Truth:
        """The sizes of hole, groove and chamfers are 0, or at least the 10 µm that the kernel can build."""
        hole = drawable(self.d_h) & drawable(self.w_g) & drawable(self.t_g)
        return hole & drawable(self.c_i) & drawable(self.c_o)

    def build(self) -> tuple[Part, ...]:
        """Return one bush."""
        bush = self.drawn()
        return (Part("bush", bush.solid(), bush.volume(), BRONZE, density=8800, material="CuSn8P"),)

    def drawn(self) -> Bush:
        """Return the parameters as radii and levels."""
        return Bush(
            bore=mm(self.d) / 2,
            outside=mm(self.D) / 2,
            flange=mm(self.D_f) / 2,
            flange_thickness=mm(self.b_f),
            width=mm(self.B),
            inner_chamfer=mm(self.c_i),
            outer_chamfer=mm(self.c_o),
            groove=mm(self.d) / 2 + mm(self.t_g),
            half_groove=mm(self.w_g) / 2,
            hole=mm(self.d_h) / 2,
        )

    def bounding_box(self) -> Box:
        """Return the box of the bush, which is as wide as the flange."""
        radius = mm(self.D_f) / 2
        return Box((-radius, -radius, 0.0), (radius, radius, mm(self.B)))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every length of the bush; sizes of groove and hole are omitted if the bush has none."""
        bush = seen["bush"]
        levels, holes = bush.levels(Z), [c for c in bush.cylinders if c.along(Y)]
        rings = bush.rings(Z)
        bore, outside, flange = rings[0], rings[-2], rings[-1]
        sizes: dict[str, float] = {
            "inner_diameter": Size.diameter(bore),
            "wall": Size.wall(bore, outside),
            "flange_diameter": Size.diameter(flange),
            "flange_thickness": bush.between(Z, 0, 1),
            "width": bush.length(Z),
            "inner_chamfer": bush.chamfer(min(c.reach[0] for c in bore) - levels[0], bore),
            "outer_chamfer": bush.chamfer(levels[-1] - max(c.reach[1] for c in outside), outside),
            "oil_hole_diameter": Size.diameter(holes) if holes else 0.0,
        }
        if len(levels) == 5:  # both ends, the back of the flange and both sides of a groove
            sizes["oil_groove_width"] = bush.between(Z, 2, 3)
            sizes["oil_groove_depth"] = Size.wall(bore, rings[1])
        return sizes
