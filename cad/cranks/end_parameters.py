"""Parameters and rules of the ends of a shaft: its nose, and its flange with bolt holes."""

from __future__ import annotations

import numpy as np

from cad.cranks.rules import CrankRules
from cad.cranks.throw import End
from cad.cranks.whole import Bolts
from cad.model import mm
from templates.core.language.template import Array, Truth, derived, formula, given, require


class EndParameters(CrankRules):
    """Parameters of the ends of the shaft beyond the first and the last main journal."""

    @derived("mm", "nose length", symbol="L_n", ge=0.05, le=5000)
    def L_n(self) -> Array:
        """Return the default: 0.8 of the journal diameter."""
        return 0.8 * self.D_j

    @derived("mm", "nose diameter", symbol="D_n", ge=0.1, le=5000)
    def D_n(self) -> Array:
        """Return the default: 0.8 of the journal diameter."""
        return 0.8 * self.D_j

    @derived("mm", "flange thickness", symbol="t_f", ge=0.05, le=5000)
    def t_f(self) -> Array:
        """Return the default: 0.3 of the journal diameter."""
        return 0.3 * self.D_j

    @derived("mm", "flange diameter", symbol="D_f", ge=0.1, le=5000)
    def D_f(self) -> Array:
        """Return the default: 1.6 times the journal diameter."""
        return 1.6 * self.D_j

    n_b: Array = given("1", "bolt holes", symbol="n_b", default="6", integer=True, ge=1, le=64)

    @derived("mm", "bolt hole diameter", symbol="d_b", ge=0, le=1000)
    def d_b(self) -> Array:
        """Return the default: no bolt holes."""
        return 0 * self.D_j

    @derived("mm", "bolt circle diameter", symbol="D_b", ge=0.05, le=5000)
    def D_b(self) -> Array:
        """Return the default: three quarters of the flange diameter."""
        return 0.75 * self.D_f

    @derived("mm", "bolt hole depth", symbol="l_b", ge=0.01, le=5000)
    def l_b(self) -> Array:
        """Return the default: 0.8 of the flange thickness."""
        return 0.8 * self.t_f

    @formula("mm", "wall at the nose", name="nose_wall", symbol="w_n")
    def w_n(self) -> Array:
        """Thickness between the bore of the journals and the surface of the nose."""
        return (self.D_n - self.d_j) / 2

    @formula("mm", "wall at the flange", name="flange_wall", symbol="w_f")
    def w_f(self) -> Array:
        """Thickness between the bore of the journals and the rim of the flange."""
        return (self.D_f - self.d_j) / 2

    @formula("mm", "rim outside the bolt holes", name="bolt_rim", symbol="w_b")
    def w_b(self) -> Array:
        """Thickness between the bolt holes and the rim of the flange."""
        return (self.D_f - self.D_b - self.d_b) / 2

    @formula("mm", "width between bolt holes", name="bolt_gap", symbol="g_b")
    def g_b(self) -> Array:
        """Gap between neighbouring bolt holes along their circle."""
        return self.D_b * np.sin(np.pi / self.n_b) - self.d_b

    @formula("mm", "floor below the bolt holes", name="bolt_floor", symbol="f_b")
    def f_b(self) -> Array:
        """Thickness between the bottoms of the bolt holes and the last web."""
        return self.t_f - self.l_b

    @require("nose_diameter", "journal_bore", remedy="make the nose thicker or the bore smaller")
    def nose_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the nose's diameter."""
        return self.d_j <= 0.98 * self.D_n

    @require("flange_diameter", "journal_bore", remedy="make the flange larger or the bore smaller")
    def flange_has_wall(self) -> Truth:
        """The journals' bore takes at most 98 % of the flange's diameter."""
        return self.d_j <= 0.98 * self.D_f

    @require("nose_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def nose_shoulder_is_drawable(self) -> Truth:
        """The nose is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_n - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_n - self.D_j) >= 1e-3 * self.D_j)

    @require("flange_diameter", "journal_diameter", remedy="make them equal, or change one by 0.1 %")
    def flange_shoulder_is_drawable(self) -> Truth:
        """The flange is as thick as the journal, or differs from it by at least 0.1 %."""
        return (abs(self.D_f - self.D_j) <= 1e-12 * self.D_j) | (abs(self.D_f - self.D_j) >= 1e-3 * self.D_j)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "flange_diameter",
             remedy="make the bolt circle or the holes smaller, or 0 for no holes")  # fmt: skip
    def bolts_keep_within_flange(self) -> Truth:
        """Bolt holes keep within 98 % of the flange's diameter."""
        return (self.d_b <= 0) | (self.D_b + self.d_b <= 0.98 * self.D_f)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "journal_bore",
             remedy="make the circle larger, the holes or the bore smaller, or 0 for none")  # fmt: skip
    def bolts_clear_bore(self) -> Truth:
        """Bolt holes clear the axis and the journals' bore by at least 2 % of the bolt circle."""
        return (self.d_b <= 0) | (0.98 * self.D_b >= self.d_j + self.d_b)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "bolt_holes",
             remedy="take fewer or smaller holes, or a larger bolt circle")  # fmt: skip
    def bolts_keep_apart(self) -> Truth:
        """The gap between neighbouring bolt holes is at least 5 % of their diameter."""
        return (self.d_b <= 0) | (self.n_b <= 1) | (self.D_b * np.sin(np.pi / self.n_b) >= 1.05 * self.d_b)

    @require("bolt_hole_depth", "flange_thickness", remedy="make the holes less deep or the flange thicker")
    def bolts_are_blind(self) -> Truth:
        """The depth of the bolt holes is 1 to 95 % of the flange's thickness."""
        return (self.d_b <= 0) | ((self.l_b <= 0.95 * self.t_f) & (self.l_b >= 0.01 * self.t_f))

    @require("bolt_hole_diameter", "journal_diameter", remedy="use 0 for none")
    def bolts_are_drawable(self) -> Truth:
        """The diameter of the bolt holes is 0, or at least 0.2 % of the journal's diameter."""
        return (self.d_b <= 0) | (self.d_b >= 0.002 * self.D_j)

    def ends_drawn(self) -> tuple[End, End, Bolts | None]:
        """Return the nose, flange and bolt holes as radii and lengths of the shape."""
        holes = Bolts(round(float(self.n_b)), mm(self.d_b) / 2, mm(self.D_b) / 2, mm(self.l_b))
        return (
            End(mm(self.D_n) / 2, mm(self.L_n)),
            End(mm(self.D_f) / 2, mm(self.t_f)),
            holes if self.d_b > 0 else None,
        )
