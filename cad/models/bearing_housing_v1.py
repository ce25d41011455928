"""Main bearing housing: a block and its cap with the bore between them; see the class below."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cad.model import STEEL, Box, CadModel, Part, mm
from cad.shells.housing import Housing
from cad.shells.split_bore import bore_clearance_rule, breadth_rule, roof_rule, sides_rule
from cad.surfaces import PartSurfaces, Size, X, Y, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require

IRON: tuple[float, float, float] = (0.42, 0.44, 0.47)
IRON_DENSITY = 7200.0  # kg/m³, grey cast iron (EN 1561: 7.10 to 7.30 g/cm³)


class BearingHousing(CadModel):
    """Housing of a main bearing: block, cap, bore, bolt holes and the drilling that feeds the oil.

    z is along the shaft, and the joint is in the plane y = 0. The block is the half at +y, the cap the half
    at -y; each is a box. Two bolt holes pass through the cap and end blind, with flat bottoms, in the block.
    The oil drilling runs from the top of the block to the bore. Block and cap are made of grey cast iron.

    A diameter of 0 omits the bolt holes or the drilling.

    Limits
    ------
    The part is for mating with shells; it is not a casting: it has no ribs, fillets, dowels, threads or tang
    notches. Default sizes are typical of engines and do not come from a standard. The bore has its nominal
    size; give its tolerance with the parameter.

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
    }
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
        """Return the block and cap."""
        housing = self.drawn()
        return (
            Part("block", housing.block(), housing.block_volume(), IRON, IRON_DENSITY, material="cast iron"),
            Part("cap", housing.cap(), housing.cap_volume(), STEEL, IRON_DENSITY, material="cast iron"),
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
        )

    def bounding_box(self) -> Box:
        """Return the box of block and cap together."""
        a, b = mm(self.A) / 2, mm(self.B) / 2
        return Box((-a, -mm(self.H_c), -b), (a, mm(self.H_b), b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; spacing and depth of bolt holes only if there are any."""
        block, cap = seen["block"], seen["cap"]
        holes = [hole.turned(Y) for hole in block.cylinders if hole.along(Y)]
        bolts = [hole for hole in holes if not hole.about(Y)]
        oil = [hole for hole in holes if hole.about(Y)]
        sizes: dict[str, float] = {
            "housing_bore": block.diameters(Z)[0],
            "housing_width": block.length(Z),
            "housing_breadth": block.length(X),
            "block_height": block.length(Y),
            "cap_height": cap.length(Y),
            "bolt_hole_diameter": Size.diameter(bolts) if bolts else 0.0,
            "oil_drilling_diameter": Size.diameter(oil) if oil else 0.0,
        }
        if bolts:
            left, right = [b for b in bolts if b.point.x < 0], [b for b in bolts if b.point.x > 0]
            spacing = max(b.point.x for b in right) - min(b.point.x for b in left)
            sizes["bolt_spacing"] = Size.distance(spacing, left, right)
            sizes["bolt_hole_depth"] = block.apart(Y, 0.0, bolts[0].reach[1])
        return sizes
