"""Connecting rod with its cap and bush; see the class below. Parameters and rules are in `cad.shells`."""

from __future__ import annotations

from collections.abc import Mapping

from cad.model import BRIGHT_STEEL, BRONZE, STEEL, Box, Part, mm
from cad.shells.big_end import BigEnd, EndHalf
from cad.shells.rod import Rod
from cad.shells.rod_readback import RodReadback
from cad.shells.rod_rules import RodRules
from cad.surfaces import PartSurfaces

_ANGLE_DIGITS = 12  # decimals of an angle [rad], so that equal parameters give equal bytes
BUSH_DENSITY = 8800.0  # kg/m³, of CuSn8P


class ConnectingRod(RodRules):
    """Connecting rod: split round big end with bolt bosses, tapered I-shaped shank, small end with a bush.

    z is along the crankpin; the axis of the big end passes through the origin, and that of the small end lies
    at +y. The joint is in the plane y = 0, the cap at -y.

    - *Big end*: a circle about the crankpin on each side of the joint, between flat sides. The shoulder
      height is the radius of the circle of the rod, the cap height that of the cap. Bosses with rounded
      corners carry the bolts; bosses as high as the shoulder make it a square box.
    - *Bolt holes* pass through the cap, from seat to joint, and end blind, with flat bottoms, in the rod.
    - *Shank*: its width and that of the pockets are measured halfway between shoulder and small end. The
      taper is the angle between its sides, which are farther apart at the big end. Fillets join the sides to
      both ends. A pocket on each side makes an I section; its sides are parallel to those of the shank, and
      it ends as far from the ends of the shank as from the sides.
    - *Small end*: a ring. A bush in its bore is a part of its own; the pin runs in the bush.
    - *Oil*: a hole from the top of the small end to the pin; a drilling through the shank from bore to bore.

    A size of 0 omits bosses, corners, fillets, pockets, bolt holes, bush, oil hole or drilling; a taper of 0
    makes the sides parallel. Mass and centre of mass are measured on the solids.

    Limits
    ------
    Seen along the pin, the part has the shape of a forged rod. It has no draft, and no fillets at the floor
    of the pockets and where shank and ends differ in thickness. It has no threads, bolts, dowels or tang
    notches. Default sizes are typical of engines and do not come from a standard; a feature that has no room
    is omitted by default. Bores have their nominal sizes; give tolerances with the parameters.

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
        "bolt_hole_depth": "20 mm",
        "boss_height": "22 mm",
        "cap_boss_height": "24 mm",
        "boss_corner_radius": "3 mm",
        "centre_distance": "144 mm",
        "small_end_bore": "24 mm",
        "small_end_diameter": "34 mm",
        "small_end_width": "23 mm",
        "bush_wall": "1.5 mm",
        "shank_width": "22 mm",
        "shank_taper": "5 deg",
        "shank_thickness": "14 mm",
        "big_end_fillet": "18 mm",
        "small_end_fillet": "12 mm",
        "pocket_width": "13 mm",
        "pocket_corner_radius": "4 mm",
        "web_thickness": "5 mm",
        "oil_hole_diameter": "3.5 mm",
        "oil_drilling_diameter": "3 mm",
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
        "boss_height": {},
        "cap_boss_height": {},
        "boss_corner_radius": {},
        "big_end_fillet": {},
        "small_end_fillet": {},
        "pocket_corner_radius": {},
        "bush_wall": {},
        "oil_hole_diameter": {},
        "oil_drilling_diameter": {},
    }

    sections = {
        "B": {  # halfway along the shank
            "of": "rod",
            "at": {"shoulder_height": 0.5, "centre_distance": 0.5, "small_end_diameter": -0.25},
            "shows": ["shank_width", "shank_thickness", "pocket_width", "web_thickness"],
        },
    }

    def build(self) -> tuple[Part, ...]:
        """Return the rod, its cap, and its bush if it has one."""
        rod = self.drawn()
        end = rod.big_end
        parts = [
            Part("rod", rod.body(), rod.volume(), STEEL),
            Part("cap", end.cap_body(), end.cap_volume(), BRIGHT_STEEL),
        ]
        if rod.bush > 0:
            bush, volume, places = rod.bush_body(), rod.bush_volume(), (rod.bush_place,)
            parts.append(Part("bush", bush, volume, BRONZE, BUSH_DENSITY, places, material="CuSn8P"))
        return tuple(parts)

    def drawn(self) -> Rod:
        """Return the parameters converted to radii and half lengths."""
        return Rod(
            self._big_end(),
            distance=mm(self.L),
            bore=mm(self.D_s) / 2,
            outside=mm(self.A_s) / 2,
            half_width=mm(self.B_s) / 2,
            shank_width=mm(self.b),
            thickness=mm(self.h),
            lean=round(float(self.tau) / 2, _ANGLE_DIGITS),
            big_fillet=mm(self.r_b),
            small_fillet=mm(self.r_s),
            pocket_width=mm(self.b_p),
            web=mm(self.h_w),
            pocket_corner=mm(self.r_p),
            bush=mm(self.t_b),
            oil_hole=mm(self.d_o) / 2,
            drilling=mm(self.d_d) / 2,
        )

    def _big_end(self) -> BigEnd:
        bore, breadth, corner = mm(self.D) / 2, mm(self.A) / 2, mm(self.r_c)
        rod, cap = (
            EndHalf(bore, breadth, mm(height), mm(seat), corner if seat > 0 else 0.0)
            for height, seat in ((self.H_b, self.h_b), (self.H_c, self.h_c))
        )
        return BigEnd(
            rod,
            cap,
            half_width=mm(self.B) / 2,
            bolt=mm(self.d_b) / 2,
            bolt_axis=mm(self.a_b) / 2,
            bolt_depth=mm(self.l_b),
        )

    def bounding_box(self) -> Box:
        """Return the box from the cap to the end of the small end."""
        a, b = max(mm(self.A), mm(self.A_s)) / 2, max(mm(self.B), mm(self.B_s)) / 2
        return Box((-a, -mm(self.H_c), -b), (a, mm(self.L) + mm(self.A_s) / 2, b))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter; of a feature that is not there only the size of 0."""
        return RodReadback(seen, self.drawn()).sizes()
