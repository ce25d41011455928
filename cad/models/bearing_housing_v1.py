"""Main bearing housing: a block and its cap with the bore between them; see the class below."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cad.model import STEEL, Box, Part, mm
from cad.shells.fastening import Fastening
from cad.shells.housing import Housing
from cad.shells.housing_readback import bolt_holes, fastener_sizes, saddle_sizes
from cad.shells.saddle import SaddleShape
from cad.shells.split_bore import bore_clearance_rule, breadth_rule, roof_rule, sides_rule
from cad.surfaces import PartSurfaces, Size, X, Y, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require

IRON: tuple[float, float, float] = (0.42, 0.44, 0.47)
IRON_DENSITY = 7200.0  # kg/m³, grey cast iron (EN 1561: 7.10 to 7.30 g/cm³)


class BearingHousing(SaddleShape, Fastening):
    """Housing of a main bearing: block and cap with the bore between them, bolts, dowels, oil drilling.

    z is along the shaft, and the joint is in the plane y = 0. The block is the half at +y, the cap the half
    at -y; each is a box of grey cast iron. Two bolt holes pass through the cap and end blind, with flat
    bottoms, in the block. The oil drilling runs from the top of the block to the bore.

    A size of 0 omits the feature:

    - shoulder depth: the cap has a crown in its middle and shoulders on both sides, the seats of the bolts.
    - bulkhead thickness: the block is a saddle as wide as the cap up to the saddle height, and a thinner
      bulkhead above it.
    - bolt diameter: two bolts with hexagon heads stand on their seats. Their holes in the block are then as
      wide as the bolts, because threads are not drawn, and those in the cap as wide as the bolt holes.
    - dowel diameter: two hollow dowels about the bolts hold the cap in its place, half in each counterbore.
    - bolt hole diameter and oil drilling diameter.

    Limits
    ------
    The part is for mating with shells; it is not a casting: it has no ribs, fillets, threads or tang notches.
    Default sizes are typical of engines and do not come from a standard. The bore has its nominal size; give
    its tolerance with the parameter. Finite elements take block, cap and dowels as one body of cast iron,
    without the bolts.

    References
    ----------
    ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: the housing bore.
    """

    example = {
        "housing_bore": "52.8 mm",
        "housing_width": "23 mm",
        "housing_breadth": "110 mm",
        "block_height": "70 mm",
        "cap_height": "45 mm",
        "bolt_hole_diameter": "11 mm",
        "bolt_spacing": "78 mm",
        "bolt_hole_depth": "50 mm",
        "oil_drilling_diameter": "5 mm",
        "shoulder_depth": "16 mm",
        "crown_width": "58 mm",
        "bulkhead_thickness": "15 mm",
        "saddle_height": "40 mm",
        "bolt_diameter": "10 mm",
        "bolt_length": "70 mm",
        "bolt_head_width": "16 mm",
        "bolt_head_height": "6.4 mm",
        "dowel_diameter": "14 mm",
        "dowel_length": "16 mm",
    }
    keeps_apart = True
    toleranced = {
        "housing_bore": {"datum": "A", "cylindricity": 0.5},
        "housing_width": {"perpendicularity": 1, "to": "A"},
        "housing_breadth": {},
        "block_height": {},
        "cap_height": {},
        "bolt_hole_diameter": {},
        "oil_drilling_diameter": {},
        "bolt_spacing": {},
        "bolt_hole_depth": {},
        "shoulder_depth": {},
        "crown_width": {},
        "bulkhead_thickness": {},
        "saddle_height": {},
        "bolt_diameter": {},
        "bolt_length": {},
        "bolt_head_width": {},
        "bolt_head_height": {},
        "dowel_diameter": {},
        "dowel_length": {},
    }

    D: Array = given("mm", "housing bore", symbol="D_h", ge=2, le=2000)

    @derived("mm", "housing width", symbol="B_h", ge=0.2, le=2000)
    def B(self) -> Array:
        """Return the default length along the shaft."""
        return 0.45 * self.D

    @derived("mm", "housing breadth", symbol="A_h", ge=2, le=5000)
    def A(self) -> Array:
        """Return the default breadth across the shaft."""
        return 2 * self.D

    @derived("mm", "block height", symbol="H_b", ge=1, le=5000)
    def H_b(self) -> Array:
        return 1.2 * self.D

    @derived("mm", "cap height", symbol="H_c", ge=1, le=5000)
    def H_c(self) -> Array:
        return 0.85 * self.D

    @derived("mm", "bolt hole diameter", symbol="d_b", ge=0, le=500)
    def d_b(self) -> Array:
        return 0.2 * self.D

    @derived("mm", "bolt spacing", symbol="a_b", ge=0.5, le=5000)
    def a_b(self) -> Array:
        return 1.5 * self.D

    @derived("mm", "bolt hole depth", symbol="l_b", ge=0.1, le=5000)
    def l_b(self) -> Array:
        return 0.8 * self.H_b

    @derived("mm", "oil drilling diameter", symbol="d_o", ge=0, le=500)
    def d_o(self) -> Array:
        return 0.1 * self.D

    @formula("mm", "wall beside the bore at the joint", name="joint_wall", symbol="s_j")
    def s_j(self) -> Array:
        return (self.A - self.D) / 2

    bore_has_sides = sides_rule("housing_breadth", "housing_bore")
    bore_has_a_roof = roof_rule("block_height", "cap_height", "housing_bore")
    bolts_clear_bore = bore_clearance_rule("housing_bore")
    bolts_keep_within = breadth_rule("housing_breadth")

    @require("bolt_hole_diameter", "oil_drilling_diameter", "housing_width",
             remedy="make the holes smaller or the housing wider")  # fmt: skip
    def holes_keep_within_width(self) -> Truth:
        """The holes are at most 90 % as wide as the housing."""
        return np.maximum(self.d_b, self.d_o) <= 0.9 * self.B

    @require("bolt_hole_depth", "block_height", remedy="make the holes less deep, or the block higher")
    def bolts_are_blind(self) -> Truth:
        """The depth of the bolt holes is at most 95 % of the block's height."""
        return (self.d_b <= 0) | (self.l_b <= 0.95 * self.H_b)

    @require("oil_drilling_diameter", "housing_bore", remedy="make the drilling smaller")
    def drilling_is_narrow(self) -> Truth:
        """The oil drilling is at most 40 % as wide as the bore."""
        return self.d_o <= 0.4 * self.D

    @require("bolt_hole_diameter", "oil_drilling_diameter", remedy="use 0 for none")
    def holes_are_drawable(self) -> Truth:
        """The diameters of the holes are 0, or at least 0.1 % of the bore."""
        least = 1e-3 * self.D
        return ((self.d_b <= 0) | (self.d_b >= least)) & ((self.d_o <= 0) | (self.d_o >= least))

    def build(self) -> tuple[Part, ...]:
        """Return the block and cap, with dowels and bolts if there are any."""
        housing = self.drawn()
        return (
            Part("block", housing.block(), housing.block_volume(), IRON, IRON_DENSITY, material="cast iron"),
            Part("cap", housing.cap(), housing.cap_volume(), STEEL, IRON_DENSITY, material="cast iron"),
            *self.fasteners(),
        )

    def drawn(self) -> Housing:
        """Return the parameters converted to radii and half lengths."""
        return Housing(
            bore=mm(self.D) / 2,
            half_width=mm(self.B) / 2,
            half_breadth=mm(self.A) / 2,
            block_height=mm(self.H_b),
            cap_height=mm(self.H_c),
            bolt=mm(self.d_b) / 2,
            bolt_axis=mm(self.a_b) / 2,
            bolt_depth=mm(self.l_b),
            drilling=mm(self.d_o) / 2,
            thread=mm(self.d_s) / 2,
            shoulder=mm(self.h_s),
            half_crown=mm(self.W_c) / 2,
            half_bulkhead=mm(self.t_h) / 2,
            saddle=mm(self.h_d),
            dowel=mm(self.d_p) / 2,
            dowel_depth=mm(self.l_p) / 2,
        )

    def bounding_box(self) -> Box:
        """Return the box of block and cap together, and of the heads of the bolts."""
        a, b = mm(self.A) / 2, mm(self.B) / 2
        head = mm(self.h_e) + mm(self.k_s) if self.d_s > 0 else 0.0
        return Box((-a, -max(mm(self.H_c), head), -b), (a, mm(self.H_b), b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; those of a feature only if there is one."""
        block, cap = seen["block"], seen["cap"]
        oil = [hole for hole in block.cylinders if hole.along(Y) and hole.about(Y)]
        return {
            "housing_bore": block.diameters(Z)[0],
            "housing_width": block.length(Z),
            "housing_breadth": block.length(X),
            "block_height": block.length(Y),
            "cap_height": cap.length(Y),
            "oil_drilling_diameter": Size.diameter(oil) if oil else 0.0,
            **bolt_holes(block, cap),
            **saddle_sizes(block, cap),
            **fastener_sizes(seen),
        }
