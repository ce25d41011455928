"""Parameters and rules of the shape of a main bearing housing: crown and shoulders, bulkhead."""

from __future__ import annotations

import numpy as np

from cad.model import CadModel
from templates.core.language.template import Array, Truth, derived, formula, require


class SaddleShape(CadModel):
    """Parameters of cap and block, of which 0 omits shoulders and bulkhead."""

    D: Array  # bore of the housing
    A: Array  # breadth
    B: Array  # width
    H_b: Array  # height of the block
    H_c: Array  # height of the cap
    d_b: Array  # bolt hole diameter
    d_o: Array  # oil drilling diameter
    a_b: Array  # bolt spacing
    d_s: Array  # bolt diameter
    s_s: Array  # bolt head width
    d_p: Array  # dowel diameter
    l_p: Array  # dowel length

    @derived("mm", "shoulder depth", symbol="h_s", ge=0, le=5000)
    def h_s(self) -> Array:
        """Return the default: no shoulders."""
        return 0 * self.D

    @derived("mm", "crown width", symbol="W_c", ge=0.1, le=5000)
    def W_c(self) -> Array:
        """Return the default: the bore with a wall on each side."""
        return 1.1 * self.D

    @derived("mm", "bulkhead thickness", symbol="t_h", ge=0, le=2000)
    def t_h(self) -> Array:
        """Return the default: no bulkhead, the block is as wide as the cap."""
        return 0 * self.D

    @derived("mm", "saddle height", symbol="h_d", ge=0.1, le=5000)
    def h_d(self) -> Array:
        """Return the default height of the saddle below a bulkhead."""
        return 0.75 * self.D

    @formula("mm", "height of the bolts' seats", name="seat_height", symbol="h_e")
    def h_e(self) -> Array:
        """Distance of the seats from the joint."""
        return self.H_c - self.h_s

    @require("shoulder_depth", "cap_height", "crown_width", "housing_bore",
             remedy="make the shoulders less deep or the crown wider, or 0 for no shoulders")  # fmt: skip
    def shoulders_clear_bore(self) -> Truth:
        """The shoulders leave 10 % of the cap's height, and 5 % of the bore as a wall beside the crown."""
        away = np.hypot(self.W_c / 2, self.h_e)
        return (self.h_s <= 0) | ((self.h_e >= 0.1 * self.H_c) & (away >= 0.55 * self.D))

    @require("shoulder_depth", "crown_width", "housing_breadth", "housing_bore",
             remedy="make the crown narrower, or 0 for no shoulders")  # fmt: skip
    def crown_has_shoulders(self) -> Truth:
        """The crown's width is 20 % of the bore to 98 % of the breadth."""
        return (self.h_s <= 0) | ((self.W_c >= 0.2 * self.D) & (self.W_c <= 0.98 * self.A))

    @require("shoulder_depth", "crown_width", "bolt_spacing", "bolt_hole_diameter", "bolt_head_width",
             remedy="make the crown narrower or move the bolts outwards")  # fmt: skip
    def bolts_clear_crown(self) -> Truth:
        """Bolt holes and heads are clear of the crown by 1 % of its width."""
        widest = np.maximum(self.d_b, self.s_s * (self.d_s > 0))
        return (self.h_s <= 0) | (self.d_b <= 0) | (self.a_b - widest >= 1.01 * self.W_c)

    @require("bulkhead_thickness", "housing_width", remedy="make the bulkhead thinner, or 0 for none")
    def bulkhead_is_thinner(self) -> Truth:
        """The bulkhead is at most 98 % as thick as the housing is wide, and at least 5 %."""
        return (self.t_h <= 0) | ((self.t_h <= 0.98 * self.B) & (self.t_h >= 0.05 * self.B))

    @require("bulkhead_thickness", "saddle_height", "block_height", "housing_bore",
             remedy="make the saddle higher, or lower than the block")  # fmt: skip
    def saddle_holds_bore(self) -> Truth:
        """The saddle's height is at least 55 % of the bore and at most 98 % of the block."""
        return (self.t_h <= 0) | ((self.h_d >= 0.55 * self.D) & (self.h_d <= 0.98 * self.H_b))

    @require("bulkhead_thickness", "bolt_hole_diameter", "oil_drilling_diameter",
             remedy="make the holes smaller or the bulkhead thicker")  # fmt: skip
    def holes_keep_within_bulkhead(self) -> Truth:
        """The holes are at most 90 % as wide as the bulkhead is thick."""
        return (self.t_h <= 0) | (np.maximum(self.d_b, self.d_o) <= 0.9 * self.t_h)

    @require("bulkhead_thickness", "saddle_height", "dowel_diameter", "dowel_length",
             remedy="make the dowels shorter or the saddle higher")  # fmt: skip
    def dowels_keep_within_saddle(self) -> Truth:
        """Half of a dowel takes at most 90 % of the saddle's height."""
        return (self.t_h <= 0) | (self.d_p <= 0) | (self.l_p / 2 <= 0.9 * self.h_d)

    @require("shoulder_depth", "housing_bore", remedy="use 0 for none")
    def shoulders_are_drawable(self) -> Truth:
        """The shoulder depth is 0, or at least 0.1 % of the bore."""
        return (self.h_s <= 0) | (self.h_s >= 1e-3 * self.D)
