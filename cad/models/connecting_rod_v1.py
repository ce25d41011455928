"""Connecting rod with its cap; see the class below."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cad.model import BRIGHT_STEEL, STEEL, Box, CadModel, Part, mm
from cad.shells.housing import Housing
from cad.shells.rod import Rod
from cad.shells.split_bore import bore_clearance_rule, breadth_rule, roof_rule, sides_rule
from cad.surfaces import PartSurfaces, Size, X, Y, Z
from templates.core.language.template import Array, Truth, derived, formula, given, require


class ConnectingRod(CadModel):
    """Connecting rod: split big end with its cap and bolt holes, I-shaped shank, small end.

    z is along the crankpin; the axis of the big end passes through the origin, and that of the small end lies
    at +y. The joint is in the plane y = 0, the cap at -y. The big end is a box up to its shoulder, the small
    end a ring. The shank is a bar of constant width and thickness; a pocket on each side makes it an I
    section. Bolt holes pass through the cap and end blind, with flat bottoms, in the rod.

    A width of 0 omits pockets or bolt holes. Mass and centre of mass are measured on the solids.

    Limits
    ------
    The part is for mating with shells and for its mass; it is not a forging: it has no fillets, tapers,
    draft, bosses, oil holes, threads or tang notches. Default sizes are typical of engines and do not come
    from a standard. Bores have their nominal sizes; give tolerances with the parameters.

    References
    ----------
    ISO 3548-1:2014, Plain bearings, thin-walled half bearings, part 1: the housing bore.
    """

    example = {
        "big_end_bore": "51.8 mm",
        "big_end_width": "22 mm",
        "big_end_breadth": "84 mm",
        "shoulder_height": "38 mm",
        "cap_height": "36 mm",
        "bolt_hole_diameter": "9 mm",
        "bolt_spacing": "66 mm",
        "bolt_hole_depth": "26 mm",
        "centre_distance": "144 mm",
        "small_end_bore": "22 mm",
        "small_end_diameter": "34 mm",
        "small_end_width": "24 mm",
        "shank_width": "22 mm",
        "shank_thickness": "14 mm",
        "pocket_width": "13 mm",
        "web_thickness": "5 mm",
    }
    toleranced = {
        "big_end_bore": {"datum": "A", "cylindricity": 0.5},
        "small_end_bore": {"parallelism": 1, "to": "A"},
        "small_end_diameter": {},
        "centre_distance": {},
        "big_end_breadth": {},
        "cap_height": {},
        "bolt_hole_diameter": {},
        "big_end_width": {},
        "shoulder_height": {},
        "small_end_width": {},
        "shank_width": {},
        "shank_thickness": {},
        "pocket_width": {},
        "web_thickness": {},
        "bolt_spacing": {},
        "bolt_hole_depth": {},
    }

    sections = {
        "B": {  # halfway along the shank
            "of": "rod",
            "at": {"shoulder_height": 0.5, "centre_distance": 0.5, "small_end_diameter": -0.25},
            "shows": ["shank_width", "shank_thickness", "pocket_width", "web_thickness"],
        },
    }

    D: Array = given("mm", "big end bore", symbol="D_b", ge=2, le=2000)

    @derived("mm", "big end width", symbol="B_b", ge=0.2, le=2000)
    def B(self) -> Array:
        """Return the default length along the pin."""
        return 0.42 * self.D

    @derived("mm", "big end breadth", symbol="A_b", ge=2, le=5000)
    def A(self) -> Array:
        """Return the default breadth across the pin."""
        return 1.6 * self.D

    @derived("mm", "shoulder height", symbol="H_b", ge=1, le=5000)
    def H_b(self) -> Array:
        """Return the default height from the axis of the big end to its shoulder, where the shank begins."""
        return 0.72 * self.D

    @derived("mm", "cap height", symbol="H_c", ge=1, le=5000)
    def H_c(self) -> Array:
        return 0.7 * self.D

    @derived("mm", "bolt hole diameter", symbol="d_b", ge=0, le=500)
    def d_b(self) -> Array:
        return 0.17 * self.D

    @derived("mm", "bolt spacing", symbol="a_b", ge=0.5, le=5000)
    def a_b(self) -> Array:
        return 1.28 * self.D

    @derived("mm", "bolt hole depth", symbol="l_b", ge=0.1, le=5000)
    def l_b(self) -> Array:
        return 0.7 * self.H_b

    @derived("mm", "centre distance", symbol="L", ge=4, le=10000, also=("rod length",))
    def L(self) -> Array:
        """Return the default distance between the axes of both ends."""
        return 2.8 * self.D

    @derived("mm", "small end bore", symbol="D_s", ge=0.5, le=2000)
    def D_s(self) -> Array:
        return 0.43 * self.D

    @derived("mm", "small end diameter", symbol="A_s", ge=0.6, le=5000)
    def A_s(self) -> Array:
        """Return the default outer diameter of the small end."""
        return 1.5 * self.D_s

    @derived("mm", "small end width", symbol="B_s", ge=0.2, le=2000)
    def B_s(self) -> Array:
        """Return the default length along the pin."""
        return 0.45 * self.D

    @derived("mm", "shank width", symbol="b", ge=0.1, le=2000)
    def b(self) -> Array:
        """Return the default width across the pin."""
        return 0.65 * self.A_s

    @derived("mm", "shank thickness", symbol="h", ge=0.1, le=2000)
    def h(self) -> Array:
        """Return the default thickness along the pin."""
        return 0.6 * np.minimum(self.B, self.B_s)

    @derived("mm", "pocket width", symbol="b_p", ge=0, le=2000)
    def b_p(self) -> Array:
        return 0.6 * self.b

    @derived("mm", "web thickness", symbol="h_w", ge=0.02, le=2000)
    def h_w(self) -> Array:
        return 0.35 * self.h

    @formula("mm", "length of the shank, from shoulder to small end", name="shank_length", symbol="l_s")
    def l_s(self) -> Array:
        return self.L - self.H_b - self.A_s / 2

    @formula("mm**2", "section of the shank", name="shank_section", symbol="S")
    def S(self) -> Array:
        return self.b * self.h - self.b_p * (self.h - self.h_w)

    @formula("mm", "wall of the big end at the joint", name="joint_wall", symbol="s_j")
    def s_j(self) -> Array:
        return (self.A - self.D) / 2

    bore_has_sides = sides_rule("big_end_breadth", "big_end_bore")
    bore_has_a_roof = roof_rule("shoulder_height", "cap_height", "big_end_bore")
    bolts_clear_bore = bore_clearance_rule("big_end_bore")
    bolts_keep_within = breadth_rule("big_end_breadth")

    @require("bolt_hole_diameter", "big_end_width", remedy="make the holes smaller or the big end wider")
    def holes_keep_within_width(self) -> Truth:
        """The bolt holes are at most 90 % as wide as the big end."""
        return self.d_b <= 0.9 * self.B

    @require("bolt_hole_depth", "shoulder_height", remedy="make the holes less deep, or the shoulder higher")
    def bolts_are_blind(self) -> Truth:
        """The depth of the bolt holes is at most 95 % of the height to the shoulder."""
        return (self.d_b <= 0) | (self.l_b <= 0.95 * self.H_b)

    @require("small_end_diameter", "small_end_bore", remedy="make the small end larger or its bore smaller")
    def small_end_has_a_wall(self) -> Truth:
        """The small end is at least 5 % larger than its bore."""
        return self.A_s >= 1.05 * self.D_s

    @require("centre_distance", "shoulder_height", "small_end_diameter",
             remedy="make the rod longer, or its ends smaller")  # fmt: skip
    def shank_is_left(self) -> Truth:
        """The distance between shoulder and small end is at least 10 % of the centre distance."""
        return self.l_s >= 0.1 * self.L

    @require("shank_width", "small_end_diameter", "big_end_breadth", remedy="make the shank narrower")
    def shank_is_narrow(self) -> Truth:
        """The shank is at most 95 % as wide as the small end, and as the big end."""
        return (self.b <= 0.95 * self.A_s) & (self.b <= 0.95 * self.A)

    @require("shank_thickness", "big_end_width", "small_end_width", remedy="make the shank thinner")
    def shank_is_thin(self) -> Truth:
        """The shank is at most 98 % as thick as each end is wide."""
        return (self.h <= 0.98 * self.B) & (self.h <= 0.98 * self.B_s)

    @require("pocket_width", "shank_width", remedy="make the pockets narrower, or 0 for none")
    def pockets_leave_flanges(self) -> Truth:
        """The pockets are at most 90 % as wide as the shank."""
        return self.b_p <= 0.9 * self.b

    @require("pocket_width", "shank_width", "centre_distance", "shoulder_height", "small_end_diameter",
             remedy="make the pockets wider, the shank longer, or 0 for none")  # fmt: skip
    def pockets_have_a_length(self) -> Truth:
        """The pockets are at least a tenth of the shank long.

        They are as far from the ends of the shank as from its sides.
        """
        return (self.b_p <= 0) | (self.l_s - (self.b - self.b_p) >= 0.1 * self.l_s)

    @require("web_thickness", "shank_thickness", "pocket_width", remedy="make the web thinner")
    def web_is_thin(self) -> Truth:
        """The web between the pockets is at most 95 % as thick as the shank."""
        return (self.b_p <= 0) | (self.h_w <= 0.95 * self.h)

    @require("bolt_hole_diameter", "pocket_width", "big_end_bore", remedy="use 0 for none")
    def features_are_drawable(self) -> Truth:
        """The sizes of bolt holes and pockets are 0, or at least 0.1 % of the big end's bore."""
        least = 1e-3 * self.D
        return ((self.d_b <= 0) | (self.d_b >= least)) & ((self.b_p <= 0) | (self.b_p >= least))

    def build(self) -> tuple[Part, ...]:
        """Return the rod and cap."""
        rod = self.drawn()
        return (
            Part("rod", rod.body(), rod.volume(), STEEL),
            Part("cap", rod.big_end.cap(), rod.big_end.cap_volume(), BRIGHT_STEEL),
        )

    def drawn(self) -> Rod:
        """Return the parameters converted to radii and half lengths."""
        big_end = Housing(
            bore=mm(self.D) / 2,
            half_width=mm(self.B) / 2,
            half_breadth=mm(self.A) / 2,
            block_height=mm(self.H_b),
            cap_height=mm(self.H_c),
            bolt=mm(self.d_b) / 2,
            bolt_axis=mm(self.a_b) / 2,
            bolt_depth=mm(self.l_b),
        )
        return Rod(
            big_end,
            distance=mm(self.L),
            bore=mm(self.D_s) / 2,
            outside=mm(self.A_s) / 2,
            half_width=mm(self.B_s) / 2,
            shank_width=mm(self.b),
            thickness=mm(self.h),
            pocket_width=mm(self.b_p),
            web=mm(self.h_w),
        )

    def bounding_box(self) -> Box:
        """Return the box from the cap to the end of the small end."""
        a, b = max(mm(self.A), mm(self.A_s)) / 2, max(mm(self.B), mm(self.B_s)) / 2
        return Box((-a, -mm(self.H_c), -b), (a, mm(self.L) + mm(self.A_s) / 2, b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; sizes of bolt holes and pockets only if there are any."""
        rod, cap = seen["rod"], seen["cap"]
        across, along = rod.levels(X), [z for z in rod.levels(Z) if z > 0]
        bolts = [hole.turned(Y) for hole in rod.cylinders if hole.along(Y)]
        eyes = sorted((c for c in rod.cylinders if c.along(Z) and not c.about(Z)), key=lambda c: c.diameter)
        small = [c for c in eyes if c.diameter < eyes[-1].diameter - 1e-6]
        ring = [c for c in eyes if c not in small]
        bore = rod.about(Z)
        shoulder = rod.levels(Y)[2 if bolts else 1]
        has_pockets = len(across) == 6  # sides of big end, shank and pockets
        thick = along[1 if has_pockets else 0]
        sizes: dict[str, float] = {
            "big_end_bore": Size.diameter(bore),
            "big_end_width": rod.apart(Z, *bore[0].reach, bore[0].point),
            "big_end_breadth": rod.length(X),
            "shoulder_height": Size.distance(shoulder, bore, rod.planes_at(Y, shoulder)),
            "cap_height": cap.length(Y),
            "bolt_hole_diameter": Size.diameter(bolts) if bolts else 0.0,
            "centre_distance": Size.distance(eyes[0].point.y, bore, small),
            "small_end_bore": Size.diameter(small),
            "small_end_diameter": Size.diameter(ring),
            "small_end_width": rod.apart(Z, *small[0].reach, small[0].point),
            "shank_width": rod.between(X, 1, -2),
            "shank_thickness": rod.apart(Z, -thick, thick),
            "pocket_width": rod.between(X, 2, -3) if has_pockets else 0.0,
        }
        if bolts:
            left, right = [b for b in bolts if b.point.x < 0], [b for b in bolts if b.point.x > 0]
            spacing = max(b.point.x for b in right) - min(b.point.x for b in left)
            sizes["bolt_spacing"] = Size.distance(spacing, left, right)
            sizes["bolt_hole_depth"] = rod.apart(Y, 0.0, bolts[0].reach[1])
        if has_pockets:
            sizes["web_thickness"] = rod.apart(Z, -along[0], along[0])
        return sizes
