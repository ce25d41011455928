"""Rules that refuse a half shell; each names the parameters and a remedy.

The digest of a released model covers this file, so put a change into a new file. The rules are slightly
stricter than geometry requires, so that edges do not come too close to each other. The kernel can build every
shell that the rules accept, and the closed form of the volume is valid for it.
"""

from __future__ import annotations

import numpy as np

from cad.shells.parameters import ShellParameters, drawable, joints
from templates.core.language.template import Array, Truth, require


class ShellRules(ShellParameters):
    """Rules for the parameters of half shells or of a full bush."""

    @require("lining_thickness", "wall", remedy="make the lining thinner or the wall thicker")
    def back_is_steel(self) -> Truth:
        """The lining is at most 60 % of the wall."""
        return self.t_l <= 0.6 * self.t

    @require("oil_groove_width", "inner_chamfer", "width", remedy="make the groove narrower")
    def groove_within_width(self) -> Truth:
        """The oil groove and the chamfers of the bore occupy at most 90 % of the width."""
        return self.w_g + 2 * self.c_i <= 0.9 * self.B

    @require("oil_hole_diameter", "inner_chamfer", "width", remedy="make the hole smaller or the shell wider")
    def hole_within_width(self) -> Truth:
        """The oil hole and the chamfers of the bore occupy at most 90 % of the width."""
        return self.d_h + 2 * self.c_i <= 0.9 * self.B

    @require("oil_hole_diameter", "outer_chamfer", "flange_thickness", "flange_diameter", "width",
             remedy="make the hole smaller or the shell wider")  # fmt: skip
    def hole_within_seat(self) -> Truth:
        """The oil hole is clear of the chamfers of the back and of the flanges."""
        edge = np.maximum(self.c_o, np.sign(self.D_f) * self.b_f)
        taken: Array = self.d_h + 2 * edge
        return taken <= 0.95 * self.B

    @require("oil_hole_diameter", "inner_diameter", remedy="make the hole smaller")
    def hole_within_bore(self) -> Truth:
        """The oil hole is at most 80 % as wide as the bore, so that there is a wall all around it."""
        return self.d_h <= 0.8 * self.d

    @require("oil_hole_diameter", "relief_height", "relief_depth", "inner_diameter",
             remedy="make the hole smaller or the relief lower")  # fmt: skip
    def hole_clears_relief(self) -> Truth:
        """The oil hole ends above the joint relief: it is at most 99 % as wide as the bore is there."""
        above = np.sqrt(np.maximum(self.d**2 / 4 - self.h_r**2, 0.0))
        return (self.d_r <= 0) | (self.d_h / 2 <= 0.99 * above)

    @require("oil_groove_depth", "wall", remedy="make the groove shallower or the wall thicker")
    def groove_within_wall(self) -> Truth:
        """The depth of the oil groove is at most 80 % of the wall."""
        return self.t_g <= 0.8 * self.t

    @require("oil_groove_depth", "oil_groove_width", remedy="give the groove a width, or no depth")
    def groove_has_width(self) -> Truth:
        """An oil groove with a depth also has a width."""
        return (self.t_g <= 0) | (self.w_g > 0)

    @require("oil_groove_depth", "lining_thickness",
             remedy="end the groove within the lining or in the back, 5 % of the lining off")  # fmt: skip
    def groove_ends_clearly(self) -> Truth:
        """The bottom of the groove is at least 5 % of the lining thickness away from the lining's back."""
        return abs(self.t_g - self.t_l) >= 0.05 * self.t_l

    @require("oil_groove_depth", "relief_depth", remedy="make the groove deeper, or the relief shallower")
    def groove_is_deeper_than_relief(self) -> Truth:
        """A groove is at least 10 % deeper than the joint relief."""
        return (self.t_g <= 0) | (self.t_g >= 1.1 * self.d_r)

    @require("oil_hole_diameter", "oil_groove_width",
             remedy="make the hole as wide as the groove, or change it by 1 %")  # fmt: skip
    def hole_clears_groove_edge(self) -> Truth:
        """An oil hole wider than its groove is wider by 1 %; for less, OpenCASCADE builds wrong solids."""
        apart = (self.d_h <= self.w_g) | (self.d_h >= 1.01 * self.w_g)
        return (self.w_g <= 0) | (self.t_g <= 0) | apart

    @require("oil_groove_angle", "oil_hole_diameter", remedy="make the groove longer or the hole smaller")
    def groove_holds_the_hole(self) -> Truth:
        """A groove over a part of the bore is at least 10 % longer than the oil hole is wide."""
        return (self.t_g <= 0) | (self.d * np.sin(self.phi_g / 2) >= 1.1 * self.d_h)

    @require("oil_groove_angle", "relief_height",
             remedy="take 180°, or end the groove 5° above the relief")  # fmt: skip
    def groove_ends_above_relief(self) -> Truth:
        """A groove runs from joint to joint (180°), or is at most 160° and ends 5° above the joint relief."""
        end = np.arcsin(np.minimum(2 * self.h_r / self.d, 1.0)) + np.pi / 36
        return (self.t_g <= 0) | (self.phi_g > 3.14159) | (self.phi_g <= np.minimum(np.pi - 2 * end, 2.8))

    @require("relief_height", "inner_diameter", remedy="make the relief lower")
    def relief_is_low(self) -> Truth:
        """The height of the joint relief is at most 30 % of the bore."""
        return self.h_r <= 0.3 * self.d

    @require("relief_depth", "lining_thickness", remedy="make the relief shallower")
    def relief_within_lining(self) -> Truth:
        """The depth of the joint relief is at most 80 % of the lining."""
        return self.d_r <= 0.8 * self.t_l

    @require("relief_depth", "relief_height", remedy="make the relief shallower or higher")
    def relief_is_shallow(self) -> Truth:
        """The depth of the joint relief is at most a tenth of its height."""
        return self.d_r <= 0.1 * self.h_r

    @require("inner_chamfer", "outer_chamfer", "wall", remedy="make the chamfers smaller")
    def chamfers_leave_a_face(self) -> Truth:
        """The chamfers together are at most 80 % of the wall."""
        return self.c_i + self.c_o <= 0.8 * self.t

    @require("inner_chamfer", "lining_thickness", remedy="change the chamfer by 5 % of the lining")
    def chamfer_clears_lining(self) -> Truth:
        """The chamfer of the bore ends at least 5 % of the lining thickness away from the lining's back."""
        return abs(self.c_i - self.t_l) >= 0.05 * self.t_l

    @require("wall_reduction", "lining_thickness", "inner_diameter", "reduction_height",
             remedy="make the reduction smaller or the lining thicker, or 0 for none")  # fmt: skip
    def reduction_within_lining(self) -> Truth:
        """At the joint, an eccentric bore takes at most 40 % of the lining."""
        return (self.delta <= 0) | (self.drop <= 0.4 * self.t_l)

    @require("wall_reduction", remedy="use 0 for a concentric bore")
    def reduction_is_drawable(self) -> Truth:
        """The wall reduction is 0, or at least 1 µm."""
        return drawable(self.delta, 1.0)

    @require("reduction_height", "inner_diameter", remedy="measure the reduction nearer to the joint")
    def reduction_is_measured_low(self) -> Truth:
        """The wall reduction is measured at most 35 % of the bore above the joint."""
        return self.h_delta <= 0.35 * self.d

    @require("wall_reduction", "relief_depth", "shells", remedy="use 0 for one of them")
    def reduction_replaces_relief(self) -> Truth:
        """A shell with an eccentric bore has joints, and no joint relief."""
        return (self.delta <= 0) | ((self.d_r <= 0) & (joints(self.shells) > 0))

    @require("wall_reduction", "oil_groove_depth", "inner_diameter", "reduction_height",
             remedy="make the groove deeper or the reduction smaller")  # fmt: skip
    def groove_is_deeper_than_reduction(self) -> Truth:
        """A groove is at least 2.2 times as deep as an eccentric bore is below the crown at the joint."""
        return (self.delta <= 0) | (self.t_g <= 0) | (self.t_g >= 2.2 * self.drop)

    @require("wall_reduction", "inner_chamfer", "inner_diameter", "reduction_height",
             remedy="make the chamfer larger, or 0 for none")  # fmt: skip
    def chamfer_is_deeper_than_reduction(self) -> Truth:
        """A chamfer of the bore is at least 10 % deeper than an eccentric bore at the joint."""
        return (self.delta <= 0) | (self.c_i <= 0) | (self.c_i >= 1.1 * self.drop)

    @require("inner_chamfer", "relief_depth", remedy="make the chamfer larger, or 0 for none")
    def chamfer_is_deeper_than_relief(self) -> Truth:
        """A chamfer of the bore is at least 10 % deeper than the joint relief."""
        return (self.c_i <= 0) | (self.c_i >= 1.1 * self.d_r)

    @require(
        "outer_chamfer",
        "width",
        "flange_thickness",
        "flange_diameter",
        remedy="make the chamfers or flanges smaller",
    )
    def seat_is_left(self) -> Truth:
        """Chamfers and flanges leave at least 30 % of the width for the seat in the housing."""
        return self.B_s - 2 * self.c_o >= 0.3 * self.B

    @require("flange_diameter", "inner_diameter", "wall", remedy="make the flange larger, or 0 for none")
    def flange_stands_out(self) -> Truth:
        """A flange is at least 2 % larger than the outside of the shell, and at most twice as large."""
        return (self.D_f <= 0) | ((self.D_f >= 1.02 * self.D) & (self.D_f <= 2 * self.D))

    @require("flange_thickness", "flange_diameter", "inner_chamfer", "lining_thickness",
             remedy="make the flange thicker or the chamfer smaller")  # fmt: skip
    def flange_holds_chamfer(self) -> Truth:
        """A flange is thicker than the chamfer of the bore."""
        return (self.D_f <= 0) | (self.b_f >= 1.02 * (self.c_i - self.t_l))

    @require("tang_length", "wall", "lining_thickness", "inner_diameter", remedy="make the tang shorter")
    def tang_grows_out_of_the_back(self) -> Truth:
        """Along the tang the back curves away by at most 70 % of the thickness of its steel."""
        R = self.D / 2
        return (self.w_t <= 0) | (self.l_t <= np.sqrt(2 * R * 0.7 * self.t_s * (1 - 0.35 * self.t_s / R)))

    @require("tang_width", "width", "outer_chamfer", "flange_thickness", "flange_diameter",
             remedy="make the tang narrower")  # fmt: skip
    def tang_within_seat(self) -> Truth:
        """The tang is clear of the chamfers of the back and of the flanges, by 2 % of the width."""
        edge = np.maximum(self.c_o, np.sign(self.D_f) * self.b_f)
        return (self.w_t <= 0) | (self.w_t / 2 <= 0.23 * self.B - edge)

    @require("tang_width", "oil_groove_width", "width",
             remedy="change the tang or the groove by 1 % of the width")  # fmt: skip
    def tang_clears_groove_edge(self) -> Truth:
        """The sides of the tang are at least 0.5 % of the width off the planes of the groove's sides."""
        low, high, off = self.B / 4 - self.w_t / 2, self.B / 4 + self.w_t / 2, 0.005 * self.B
        clear = (abs(low - self.w_g / 2) >= off) & (abs(high - self.w_g / 2) >= off)
        return (self.w_t <= 0) | (self.t_g <= 0) | clear

    @require("oil_groove_depth", "tang_length", "tang_width", "oil_groove_width", "oil_groove_angle", "wall",
             remedy="make the groove shallower or narrower, or the tang shorter")  # fmt: skip
    def tang_has_a_root_beside_the_groove(self) -> Truth:
        """Where a groove runs below the tang, 5 % of the steel is left between its bottom and the tang."""
        R, bottom = self.D / 2, self.d / 2 + self.t_g
        root = np.sqrt(np.maximum(R**2 - self.l_t**2, 0 * R**2))
        beside = self.B / 4 - self.w_t / 2 >= self.w_g / 2
        above = self.d / 2 * np.sin((np.pi - self.phi_g) / 2) >= self.l_t
        none = (self.w_t <= 0) | (self.t_g <= 0) | beside | above
        return none | (bottom + 0.05 * self.t_s <= root)

    @require("tang_height", "wall", remedy="make the tang lower")
    def tang_is_low(self) -> Truth:
        """The height of the tang is at most the thickness of the wall."""
        return self.h_t <= self.t

    @require("tang_height", "flange_diameter", "inner_diameter", "wall", remedy="make the tang lower")
    def tang_is_lower_than_flange(self) -> Truth:
        """The tang is lower than a flange, by at least 1 % of the diameter."""
        return (self.D_f <= 0) | (self.w_t <= 0) | (self.D_f >= 1.01 * (self.D + 2 * self.h_t))

    @require("crush_height", "inner_diameter", remedy="make the crush height smaller")
    def crush_is_small(self) -> Truth:
        """The crush height is at most 1 % of the bore."""
        return self.a <= 0.01 * self.d

    @require("oil_hole_diameter", "oil_groove_width", "oil_groove_depth", "tang_width", "inner_chamfer",
             "outer_chamfer", "crush_height", remedy="use 0 for none")  # fmt: skip
    def features_are_drawable(self) -> Truth:
        """The sizes of features are 0, or at least the 10 µm that the kernel can build reliably."""
        sizes = (self.d_h, self.w_g, self.t_g, self.w_t, self.c_i, self.c_o)
        fits = drawable(self.a, 1.0)
        for size in sizes:
            fits = fits & drawable(size, 10.0)
        return fits

    @require("relief_depth", remedy="use 0 for none")
    def relief_is_drawable(self) -> Truth:
        """The depth of the relief is 0, or at least 1 µm."""
        return drawable(self.d_r, 1.0)

    @require("lining_thickness", remedy="use 0 for none")
    def lining_is_drawable(self) -> Truth:
        """The thickness of the lining is 0, or at least 5 µm."""
        return drawable(self.t_l, 5.0)

    @require("shells", "tang_width", "relief_depth", "crush_height", remedy="use 0 for none, or half shells")
    def full_bush_has_no_joint(self) -> Truth:
        """A full bush has no joint, so it has no tang, no joint relief and no crush height."""
        return (joints(self.shells) > 0) | ((self.w_t <= 0) & (self.d_r <= 0) & (self.a <= 0))
