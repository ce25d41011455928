"""Rules that refuse a connecting rod; each names the parameters and a remedy.

The rules are slightly stricter than geometry requires, so that edges do not come too close to each other. The
kernel can build every rod that the rules accept, and the closed form of the volume is valid for it.
"""

from __future__ import annotations

import numpy as np

from cad.shells.rod_parameters import RodParameters, drawable
from cad.shells.split_bore import bore_clearance_rule, breadth_rule, roof_rule, sides_rule
from templates.core.language.template import Truth, require


class RodRules(RodParameters):
    """Rules for the parameters of a connecting rod."""

    bore_has_sides = sides_rule("big_end_breadth", "big_end_bore")
    bore_has_a_roof = roof_rule("shoulder_height", "cap_height", "big_end_bore")
    bolts_clear_bore = bore_clearance_rule("big_end_bore")
    bolts_keep_within = breadth_rule("big_end_breadth")

    @require("bolt_hole_diameter", "big_end_width", remedy="make the holes smaller or the big end wider")
    def holes_keep_within_width(self) -> Truth:
        """The bolt holes are at most 90 % as wide as the big end."""
        return self.d_b <= 0.9 * self.B

    @require("bolt_hole_depth", "boss_height", "shoulder_height",
             remedy="make the holes less deep, or the bosses higher")  # fmt: skip
    def bolts_are_blind(self) -> Truth:
        """The bolt holes are at most 95 % as deep as the bosses are high, or end within the round."""
        corner = ((self.a_b + self.d_b) / 2) ** 2 + self.l_b**2
        return (self.d_b <= 0) | (self.l_b <= 0.95 * self.h_b) | (corner <= (0.97 * self.H_b) ** 2)

    @require("boss_height", "shoulder_height", remedy="make the bosses lower, or as high as the shoulder")
    def bosses_end_below_shoulder(self) -> Truth:
        """The bosses are at most 98 % as high as the shoulder, or as high as it: a square shoulder."""
        return (self.h_b <= 0.98 * self.H_b) | (abs(self.h_b / self.H_b - 1) <= 1e-9)

    @require("cap_boss_height", "cap_height", remedy="make the bosses lower, or as high as the cap")
    def bosses_end_within_cap(self) -> Truth:
        """The bosses of the cap are at most 98 % as high as the cap, or as high as it: a square cap."""
        return (self.h_c <= 0.98 * self.H_c) | (abs(self.h_c / self.H_c - 1) <= 1e-9)

    @require("boss_height", "big_end_breadth", "shoulder_height",
             remedy="make the bosses higher or the big end broader, or use 0 for none")  # fmt: skip
    def bosses_stand_out(self) -> Truth:
        """The bosses stand out of the round by 1 % of the breadth, or there are none.

        Without them the round is broader than the big end.
        """
        none = (self.h_b <= 0) & (self.A <= 1.98 * self.H_b)
        return none | self.boxed | ((self.h_b > 0) & (self.edge <= 0.49 * self.A))

    @require("cap_boss_height", "big_end_breadth", "cap_height",
             remedy="make the bosses higher or the big end broader, or use 0 for none")  # fmt: skip
    def bosses_of_cap_stand_out(self) -> Truth:
        """The bosses of the cap stand out of its round by 1 % of the breadth, or there are none.

        Without them its round is broader than the big end.
        """
        none = (self.h_c <= 0) & (self.A <= 1.98 * self.H_c)
        return none | self.cap_boxed | ((self.h_c > 0) & (self.cap_edge <= 0.49 * self.A))

    @require("cap_boss_height", "cap_height", "bolt_spacing", "bolt_hole_diameter",
             remedy="make the bosses of the cap higher, or move the bolts outwards")  # fmt: skip
    def bolts_have_seats(self) -> Truth:
        """The bolt holes end in the flat seats of the cap, by 2 % off its round."""
        on_seat = (self.h_c > 0) & (self.cap_edge <= 0.49 * (self.a_b - self.d_b))
        return (self.d_b <= 0) | self.cap_boxed | on_seat

    @require("boss_corner_radius", "boss_height", "cap_boss_height", "big_end_breadth", "bolt_spacing",
             "bolt_hole_diameter", remedy="make the corners smaller, or 0 for sharp ones")  # fmt: skip
    def corners_leave_seats(self) -> Truth:
        """The corners take at most 90 % of the bosses' heights, and of the walls beside the bolt holes."""
        heights = np.minimum(self.h_b, self.h_c)
        return self.r_c <= 0.9 * np.minimum(self.rim, heights)

    @require("small_end_diameter", "small_end_bore", remedy="make the small end larger or its bore smaller")
    def small_end_has_a_wall(self) -> Truth:
        """The small end is at least 5 % larger than its bore."""
        return self.A_s >= 1.05 * self.D_s

    @require("bush_wall", "small_end_bore", remedy="make the bush thinner, or 0 for none")
    def bush_is_thin(self) -> Truth:
        """The wall of the bush is at most 20 % of the small end's bore."""
        return self.t_b <= 0.2 * self.D_s

    @require("centre_distance", "shoulder_height", "small_end_diameter",
             remedy="make the rod longer, or its ends smaller")  # fmt: skip
    def shank_is_left(self) -> Truth:
        """The distance between shoulder and small end is at least 10 % of the centre distance."""
        return self.l_s >= 0.1 * self.L

    @require("shank_width", "small_end_diameter", "big_end_breadth", remedy="make the shank narrower")
    def shank_is_narrow(self) -> Truth:
        """The shank is at most 95 % as wide as the small end, and as the big end."""
        return (self.b <= 0.95 * self.A_s) & (self.b <= 0.95 * self.A)

    @require("shank_taper", "shank_width", "centre_distance", "shoulder_height", "small_end_diameter",
             remedy="make the taper smaller, or the shank wider")  # fmt: skip
    def taper_leaves_a_shank(self) -> Truth:
        """The taper leaves the narrow end of the shank at least 20 % of the width halfway."""
        return self.l_s * np.tan(self.lean) <= 0.8 * self.b

    @require("shank_taper", "shank_width", "pocket_width", "centre_distance", "shoulder_height",
             "small_end_diameter", remedy="make the taper smaller, or the pockets wider")  # fmt: skip
    def taper_leaves_pockets(self) -> Truth:
        """The taper leaves the narrow ends of the pockets at least 20 % of their width halfway."""
        return (self.b_p <= 0) | (self.pocket_end >= 0.2 * self.b_p)

    @require("shank_taper", remedy="use 0 for parallel sides")
    def taper_is_drawable(self) -> Truth:
        """The taper is 0 or at least 0.1°."""
        return (self.tau <= 0) | (self.tau >= 0.0017)

    @require("shank_taper", "shank_width", "big_end_fillet", "boss_height", "shoulder_height",
             "big_end_breadth", "boss_corner_radius",
             remedy="make the shank narrower, or taper, fillet or bosses smaller")  # fmt: skip
    def shank_lands_on_the_big_end(self) -> Truth:
        """The shank with its fillets takes at most 98 % of the round between bosses, or of the shoulder."""
        fits = self.low <= 0.98 * self.H_b
        return (self.land <= 0.98 * self.room) & (self.boxed | fits)

    @require("big_end_fillet", "small_end_fillet", "centre_distance", "shoulder_height", "small_end_diameter",
             remedy="make the fillets smaller, or the rod longer")  # fmt: skip
    def fillets_leave_a_side(self) -> Truth:
        """Between its fillets a side of the shank is at least 4 % as long as the shank."""
        return self.straight >= 0.04 * self.l_s

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
        return (self.b_p <= 0) | (self.pocket_length >= 0.1 * self.l_s)

    @require("pocket_corner_radius", "pocket_width", "shank_taper", "shank_width", "centre_distance",
             "shoulder_height", "small_end_diameter",
             remedy="make the corners smaller, or 0 for sharp ones")  # fmt: skip
    def corners_leave_pockets(self) -> Truth:
        """The corners are at most 45 % of the narrow end and of the length of a pocket."""
        least = np.minimum(self.pocket_end, self.pocket_length)
        return (self.b_p <= 0) | (self.r_p <= 0.45 * least)

    @require("web_thickness", "shank_thickness", "pocket_width", remedy="make the web thinner")
    def web_is_thin(self) -> Truth:
        """The web between the pockets is at most 95 % as thick as the shank."""
        return (self.b_p <= 0) | (self.h_w <= 0.95 * self.h)

    @require("oil_hole_diameter", "small_end_bore", "bush_wall", "small_end_width",
             remedy="make the oil hole smaller, or 0 for none")  # fmt: skip
    def oil_hole_is_narrow(self) -> Truth:
        """The oil hole is at most 40 % of the bore for the pin, and 80 % of the small end's width."""
        return (self.d_o <= 0.4 * self.D_p) & (self.d_o <= 0.8 * self.B_s)

    @require("oil_drilling_diameter", "web_thickness", "shank_thickness", "pocket_width",
             remedy="make the drilling narrower or the web thicker, or 0 for no drilling")  # fmt: skip
    def drilling_stays_in_the_web(self) -> Truth:
        """The drilling is at most 90 % as wide as the web is thick; without pockets, as the shank."""
        return self.d_d <= 0.9 * np.where(self.b_p > 0, self.h_w, self.h)

    @require("oil_drilling_diameter", "small_end_bore", "bush_wall", "big_end_bore", "shank_width",
             remedy="make the drilling narrower, or 0 for none")  # fmt: skip
    def drilling_is_narrow(self) -> Truth:
        """The drilling is at most 40 % as wide as either bore, and 15 % of the shank."""
        least = np.minimum(np.minimum(self.D_p, self.D), 0.375 * self.b)
        return self.d_d <= 0.4 * least

    @require("bolt_hole_diameter", "pocket_width", "boss_height", "cap_boss_height", "boss_corner_radius",
             "big_end_fillet", "small_end_fillet", "pocket_corner_radius", "bush_wall", "oil_hole_diameter",
             "oil_drilling_diameter", "big_end_bore", remedy="use 0 for none")  # fmt: skip
    def features_are_drawable(self) -> Truth:
        """The sizes of features are 0, or at least 0.1 % of the big end's bore."""
        sizes = (self.b_p, self.h_b, self.h_c, self.r_c, self.r_b, self.r_s, self.r_p, self.t_b, self.d_o)
        fits = drawable(self.d_b, self.D) & drawable(self.d_d, self.D)
        for size in sizes:
            fits = fits & drawable(size, self.D)
        return fits
