"""Parameters of a connecting rod and derived quantities; a parameter of 0 omits the feature.

The defaults can always be built: a feature that has no room is omitted by default, and the shoulder is square
if bosses have no room beside the shank.
"""

from __future__ import annotations

import numpy as np

from cad.model import CadModel
from cad.shells.rod_defaults import (
    chord,
    either,
    if_possible,
    if_visible,
    usual_big_end_fillet,
    usual_boss,
    usual_seat,
    usual_small_end_fillet,
    usual_taper,
)
from cad.shells.shank import away, meeting, reach, root
from templates.core.language.template import Array, Truth, derived, formula, given, shared, units


@units("m", "m", returns="1")
def drawable(length: Array, bore: Array) -> Truth:
    """Return whether a length is 0, or large enough for the kernel: at least 0.1 % of the bore."""
    return (length <= 0) | (length >= 1e-3 * bore)


@units("m", "m", returns="1")
def is_square(seat: Array, shoulder: Array) -> Truth:
    """Return whether bosses are as high as the shoulder, so that half of the big end is a box."""
    return seat >= (1 - 1e-9) * shoulder


class RodParameters(CadModel):
    """Parameters of a connecting rod."""

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
        """Return the default height of the cap, below the joint."""
        return 0.7 * self.D

    @derived("mm", "bolt hole diameter", symbol="d_b", ge=0, le=500)
    def d_b(self) -> Array:
        """Return the default: a sixth of the bore."""
        return 0.17 * self.D

    @derived("mm", "bolt spacing", symbol="a_b", ge=0.5, le=5000)
    def a_b(self) -> Array:
        """Return the default distance between the axes of the bolts."""
        return 1.28 * self.D

    @derived("mm", "bolt hole depth", symbol="l_b", ge=0.1, le=5000)
    def l_b(self) -> Array:
        """Return the default depth in the rod, from the joint."""
        return 0.5 * self.H_b

    @derived("mm", "centre distance", symbol="L", ge=4, le=10000, also=("rod length",))
    def L(self) -> Array:
        """Return the default distance between the axes of both ends."""
        return 2.8 * self.D

    @derived("mm", "small end bore", symbol="D_s", ge=0.5, le=2000)
    def D_s(self) -> Array:
        """Return the default bore, for the pin or for a bush."""
        return 0.43 * self.D

    @derived("mm", "small end diameter", symbol="A_s", ge=0.6, le=5000)
    def A_s(self) -> Array:
        """Return the default outer diameter of the small end."""
        return 1.5 * self.D_s

    @derived("mm", "small end width", symbol="B_s", ge=0.2, le=2000)
    def B_s(self) -> Array:
        """Return the default length along the pin."""
        return 0.45 * self.D

    @derived("mm", "bush wall", symbol="t_b", ge=0, le=500)
    def t_b(self) -> Array:
        """Return the default: no bush."""
        return 0 * self.D_s

    @derived("mm", "shank width", symbol="b", ge=0.1, le=2000)
    def b(self) -> Array:
        """Return the default width across the pin, halfway along the shank."""
        return 0.65 * self.A_s

    @derived("mm", "shank thickness", symbol="h", ge=0.1, le=2000)
    def h(self) -> Array:
        """Return the default thickness along the pin."""
        return 0.6 * np.minimum(self.B, self.B_s)

    @derived("mm", "pocket width", symbol="b_p", ge=0, le=2000)
    def b_p(self) -> Array:
        """Return the default width halfway along the shank."""
        return 0.6 * self.b

    @derived("mm", "web thickness", symbol="h_w", ge=0.02, le=2000)
    def h_w(self) -> Array:
        """Return the default thickness between the pockets."""
        return 0.35 * self.h

    @formula("mm", "length of the shank, from shoulder to small end", name="shank_length", symbol="l_s")
    def l_s(self) -> Array:
        """Length between the shoulder of the big end and the small end."""
        return self.L - self.H_b - self.A_s / 2

    @shared(unit="mm")
    def middle(self) -> Array:
        """Height of the middle of the shank above the axis of the big end."""
        return self.H_b + self.l_s / 2

    @derived("deg", "shank taper", symbol=r"\tau", ge=0, le=30)
    def tau(self) -> Array:
        """Return the default angle between the sides of the shank: 5°, or less if it is long and narrow.

        0 for a shank that is nearly as broad as the big end.
        """
        return usual_taper(self.b, self.b_p, self.A, self.l_s)

    @shared(unit="deg")
    def lean(self) -> Array:
        """Angle of each side of the shank from the middle of the rod."""
        return self.tau / 2

    @shared(unit="mm")
    def low(self) -> Array:
        """Distance of a side of the shank from the axis of the big end."""
        return away(self.b / 2, self.middle, self.lean)

    @shared(unit="mm")
    def high(self) -> Array:
        """Distance of a side of the shank from the axis of the small end."""
        return away(self.b / 2, self.middle - self.L, self.lean)

    @derived("mm", "boss height", symbol="h_b", ge=0, le=5000)
    def h_b(self) -> Array:
        """Return the default height of the bosses above the joint, beyond the ends of the bolt holes.

        The shoulder is square if the round between the bosses would be narrower than the shank.
        """
        return usual_boss(self.H_b, self.A, self.d_b, self.l_b, self.low, self.lean)

    @derived("mm", "cap boss height", symbol="h_c", ge=0, le=5000)
    def h_c(self) -> Array:
        """Return the default depth below the joint of the seats of the bolt heads.

        The cap is square if the seats would have no room beside the round.
        """
        return usual_seat(self.H_c, self.A, self.d_b, self.a_b)

    @shared
    def boxed(self) -> Truth:
        """Whether the shoulder is square."""
        return is_square(self.h_b, self.H_b)

    @shared
    def cap_boxed(self) -> Truth:
        """Whether the cap is square."""
        return is_square(self.h_c, self.H_c)

    @shared(unit="mm")
    def edge(self) -> Array:
        """How far from the middle the seats of the bosses begin; 0 if the shoulder is square."""
        return if_possible(chord(self.H_b, self.h_b), self.h_b > 0)

    @shared(unit="mm")
    def cap_edge(self) -> Array:
        """How far from the middle the seats of the bolt heads begin; 0 if the cap is square."""
        return if_possible(chord(self.H_c, self.h_c), self.h_c > 0)

    @shared(unit="mm")
    def lowest(self) -> Array:
        """Height of the lower bosses, of the rod or of the cap."""
        return np.minimum(self.h_b, self.h_c)

    @shared
    def is_round(self) -> Truth:
        """Whether neither rod nor cap is square."""
        return np.logical_not(self.boxed) & np.logical_not(self.cap_boxed)

    @shared(unit="mm")
    def rim(self) -> Array:
        """Width of a boss that its corner may take: outside the bolt holes, and outside the round."""
        beside = self.A / 2 - np.maximum(self.edge, self.cap_edge)
        return np.minimum(beside, either(self.A - self.a_b - self.d_b, self.d_b > 0, self.A) / 2)

    @derived("mm", "boss corner radius", symbol="r_c", ge=0, le=2000)
    def r_c(self) -> Array:
        """Return the default rounding of the bosses of rod and cap; sharp if one of them is square."""
        return if_visible(if_possible(0.6 * np.minimum(self.rim, self.lowest), self.is_round), self.D)

    @shared(unit="mm")
    def room(self) -> Array:
        """How far from the middle of the rod its shank may meet the big end."""
        flat = self.A / 2 - self.r_c
        return either(self.edge, np.logical_not(self.boxed) & (self.h_b > 0), flat)

    @shared(unit="mm")
    def halfway(self) -> Array:
        """Distance of the middle of the shank along its side, from the foot of the axis of the big end."""
        return self.middle * np.cos(self.lean) - self.b / 2 * np.sin(self.lean)

    @shared(unit="mm")
    def below(self) -> Array:
        """How far along a side of the shank its lower fillet may reach by default, just to the middle."""
        return self.halfway - 0.03 * self.l_s

    @shared(unit="mm")
    def above(self) -> Array:
        """How far from the small end along a side of the shank its upper fillet may reach by default."""
        return self.L * np.cos(self.lean) - self.halfway - 0.03 * self.l_s

    @derived("mm", "big end fillet", symbol="r_b", ge=0, le=5000)
    def r_b(self) -> Array:
        """Return the default radius between shank and big end, or 0 if it has no room."""
        return if_visible(
            usual_big_end_fillet(self.boxed, self.b, self.H_b, self.low, self.lean, self.room, self.below),
            self.D,
        )

    @derived("mm", "small end fillet", symbol="r_s", ge=0, le=5000)
    def r_s(self) -> Array:
        """Return the default radius between shank and small end, or 0 if it has no room."""
        return if_visible(usual_small_end_fillet(self.b, self.A_s / 2, self.high, self.above), self.D)

    @shared(unit="mm")
    def land(self) -> Array:
        """How far from the middle of the rod its shank, with the fillets, meets the big end."""
        return meeting(self.boxed, self.H_b, self.low, self.r_b, self.lean)

    @shared(unit="mm")
    def straight(self) -> Array:
        """Length of the straight part of a side of the shank, between its fillets."""
        top = self.L * np.cos(self.lean) - reach(self.A_s / 2, self.high, self.r_s)
        return top - root(self.boxed, self.H_b, self.low, self.r_b, self.lean)

    @shared(unit="mm")
    def pocket_length(self) -> Array:
        """Length of a pocket, which ends as far from the ends of the shank as from its sides."""
        return self.l_s - (self.b - self.b_p)

    @shared(unit="mm")
    def pocket_end(self) -> Array:
        """Width of the narrow end of a pocket."""
        return self.b_p - self.pocket_length * np.tan(self.lean)

    @derived("mm", "pocket corner radius", symbol="r_p", ge=0, le=1000)
    def r_p(self) -> Array:
        """Return the default radius: a third of the narrow end of the pocket."""
        return if_visible(np.minimum(self.pocket_end, self.pocket_length) / 3 * np.sign(self.b_p), self.D)

    @derived("mm", "oil hole diameter", symbol="d_o", ge=0, le=500)
    def d_o(self) -> Array:
        """Return the default diameter of the hole in the top of the small end."""
        return if_visible(np.minimum(0.15 * self.D_s, 0.3 * self.B_s), self.D)

    @derived("mm", "oil drilling diameter", symbol="d_d", ge=0, le=500)
    def d_d(self) -> Array:
        """Return the default: no drilling through the shank."""
        return 0 * self.D

    @formula("mm**2", "section of the shank", name="shank_section", symbol="S")
    def S(self) -> Array:
        """Area of the section halfway along the shank."""
        return self.b * self.h - self.b_p * (self.h - self.h_w)

    @formula("mm", "wall of the big end at the joint", name="joint_wall", symbol="s_j")
    def s_j(self) -> Array:
        """Thickness beside the bore."""
        return (self.A - self.D) / 2

    @formula("mm", "bore for the pin", name="pin_bore", symbol="D_p")
    def D_p(self) -> Array:
        """Bore of the bush, or of the small end if there is no bush."""
        return self.D_s - 2 * self.t_b
