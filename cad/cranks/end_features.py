"""Parameters and rules of the features of a shaft's ends: fillets, chamfers, and the keyway of the nose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cad.cranks.end_parameters import EndParameters
from cad.cranks.keyway import Keyway
from cad.cranks.throw import End
from cad.model import mm
from templates.core.language.template import Array, Truth, derived, formula, require, units


@units("m", "m", "m", returns="m", latex=r"{2}\ \text{{if}}\ {0} > {1}")
def if_larger(one: Array, other: Array, length: Array) -> Array:
    """Return a length [m] if one diameter is larger than another, else 0."""
    return np.where(one > other, length, 0 * length)[()]


class EndFeatures(EndParameters):
    """Parameters of fillets and chamfers at nose and flange, and of a keyway; 0 omits each."""

    @derived("mm", "nose fillet", symbol="r_n", ge=0, le=500)
    def r_n(self) -> Array:
        """Return the default: no fillet at the shoulder of the nose."""
        return 0 * self.D_j

    @derived("mm", "flange fillet", symbol="r_l", ge=0, le=500)
    def r_l(self) -> Array:
        """Return the default: no fillet at the shoulder of the flange."""
        return 0 * self.D_j

    @derived("mm", "nose chamfer", symbol="c_n", ge=0, le=500)
    def c_n(self) -> Array:
        """Return the default: no chamfer at the end of the nose."""
        return 0 * self.D_j

    @derived("mm", "flange chamfer", symbol="c_l", ge=0, le=500)
    def c_l(self) -> Array:
        """Return the default: no chamfer at the rim of the flange."""
        return 0 * self.D_j

    @derived("mm", "keyway width", symbol="b_k", ge=0, le=1000)
    def b_k(self) -> Array:
        """Return the default: no keyway."""
        return 0 * self.D_j

    @derived("mm", "keyway depth", symbol="t_k", ge=0.001, le=1000)
    def t_k(self) -> Array:
        """Return the default: a seventh of the nose diameter, about that of parallel keys (ISO 773)."""
        return self.D_n / 7

    @derived("mm", "keyway length", symbol="l_k", ge=0.01, le=5000)
    def l_k(self) -> Array:
        """Return the default: 0.6 of the nose length."""
        return 0.6 * self.L_n

    @formula("mm", "fillet at the nose on the journal", name="nose_fillet_on_journal", symbol="r_{nj}")
    def r_nj(self) -> Array:
        """Length of the first journal that the nose's fillet takes: none if the nose is thinner."""
        return if_larger(self.D_n, self.D_j, self.r_n)

    @formula("mm", "fillet at the flange on the journal", name="flange_fillet_on_journal", symbol="r_{lj}")
    def r_lj(self) -> Array:
        """Length of the last journal that the flange's fillet takes: none if the flange is thinner."""
        return if_larger(self.D_f, self.D_j, self.r_l)

    @formula("mm", "plain length of the nose", name="nose_plain", symbol="p_n")
    def p_n(self) -> Array:
        """Length of the nose between its fillet and its chamfer."""
        return self.L_n - (self.r_n - self.r_nj) - self.c_n

    @formula("mm", "plain thickness of the flange", name="flange_plain", symbol="p_l")
    def p_l(self) -> Array:
        """Thickness of the flange between its fillet and its chamfer."""
        return self.t_f - (self.r_l - self.r_lj) - self.c_l

    @formula("mm", "floor of the keyway above the axis", name="keyway_floor", symbol="f_k")
    def f_k(self) -> Array:
        """Height of the bottom of the keyway above the axis of the shaft."""
        return self.D_n / 2 - self.t_k

    @require(
        "nose_fillet", "nose_diameter", "journal_diameter", remedy="make the fillet smaller, or 0 for none"
    )
    def nose_shoulder_holds_fillet(self) -> Truth:
        """The nose's fillet takes at most 98 % of the shoulder between nose and journal."""
        return 2 * self.r_n <= 0.98 * abs(self.D_n - self.D_j)

    @require("flange_fillet", "flange_diameter", "journal_diameter",
             remedy="make the fillet smaller, or 0 for none")  # fmt: skip
    def flange_shoulder_holds_fillet(self) -> Truth:
        """The flange's fillet takes at most 98 % of the shoulder between flange and journal."""
        return 2 * self.r_l <= 0.98 * abs(self.D_f - self.D_j)

    @require("nose_fillet", "flange_fillet", "fillet", "journal_length",
             remedy="make the fillets smaller or the journal longer")  # fmt: skip
    def end_fillets_fit_on_journal(self) -> Truth:
        """The fillets on the first and on the last journal occupy at most 90 % of its length."""
        return self.r_f + np.maximum(self.r_nj, self.r_lj) <= 0.9 * self.L_j

    @require("oil_drilling_diameter", "nose_fillet", "flange_fillet", "journal_length",
             remedy="make the oil drilling or the fillets at nose and flange smaller")  # fmt: skip
    def drilling_clears_end_fillets(self) -> Truth:
        """The mouth of the oil drilling is 10 % away from the fillets at nose and flange."""
        return (self.d_o <= 0) | (self.m_j <= 0.9 * (self.L_j / 2 - np.maximum(self.r_nj, self.r_lj)))

    @require("nose_length", "nose_fillet", "nose_chamfer", remedy="make fillet and chamfer smaller")
    def nose_keeps_length(self) -> Truth:
        """Fillet and chamfer occupy at most 90 % of the nose's length."""
        return self.p_n >= 0.1 * self.L_n

    @require("flange_thickness", "flange_fillet", "flange_chamfer", remedy="make fillet and chamfer smaller")
    def flange_keeps_thickness(self) -> Truth:
        """Fillet and chamfer occupy at most 90 % of the flange's thickness."""
        return self.p_l >= 0.1 * self.t_f

    @require("nose_chamfer", "nose_diameter", "journal_bore", remedy="make the chamfer smaller")
    def nose_end_keeps_face(self) -> Truth:
        """The chamfer leaves at least 10 % of the nose's wall as its end face."""
        return self.c_n <= 0.45 * (self.D_n - self.d_j)

    @require("flange_chamfer", "flange_diameter", "journal_bore", remedy="make the chamfer smaller")
    def flange_end_keeps_face(self) -> Truth:
        """The chamfer leaves at least 10 % of the flange's wall as its end face."""
        return self.c_l <= 0.45 * (self.D_f - self.d_j)

    @require("bolt_circle_diameter", "bolt_hole_diameter", "flange_chamfer", "flange_diameter",
             remedy="make the chamfer, the bolt circle or the holes smaller")  # fmt: skip
    def bolts_clear_chamfer(self) -> Truth:
        """Bolt holes keep within 98 % of the flange's diameter inside its chamfer."""
        return (self.d_b <= 0) | (self.D_b + self.d_b <= 0.98 * (self.D_f - 2 * self.c_l))

    @require("keyway_width", "nose_diameter", "nose_chamfer", "keyway_depth",
             remedy="make the keyway narrower or deeper, or 0 for none")  # fmt: skip
    def keyway_has_sides(self) -> Truth:
        """The keyway is at most half as wide as the nose, and its sides are 10 % of its depth high."""
        high = self.D_n / 2 - self.c_n
        edge = np.sqrt(np.maximum(high**2 - self.b_k**2 / 4, 0 * high**2))
        return (self.b_k <= 0) | ((self.b_k <= 0.5 * self.D_n) & (edge - self.f_k >= 0.1 * self.t_k))

    @require("keyway_width", "keyway_depth", "nose_diameter", "journal_bore",
             remedy="make the keyway less deep or the bore smaller")  # fmt: skip
    def keyway_has_floor(self) -> Truth:
        """Below the keyway there is at least 10 % of the nose's radius, up to the axis or the bore."""
        return (self.b_k <= 0) | (self.f_k - self.d_j / 2 >= 0.05 * self.D_n)

    @require("keyway_width", "keyway_length", "nose_length", "nose_chamfer", "nose_fillet",
             remedy="make the keyway shorter, or longer than the chamfer")  # fmt: skip
    def keyway_ends_on_nose(self) -> Truth:
        """The keyway ends on the plain part of the nose, 2 % of its length from chamfer and fillet."""
        behind = self.l_k - self.c_n
        return (self.b_k <= 0) | ((behind >= 0.02 * self.p_n) & (behind <= 0.98 * self.p_n))

    @require("nose_fillet", "flange_fillet", "nose_chamfer", "flange_chamfer", "keyway_width",
             "journal_diameter", remedy="use 0 for none")  # fmt: skip
    def end_features_are_drawable(self) -> Truth:
        """Fillets, chamfers and keyway are 0, or at least 0.2 % of the journal's diameter."""
        least = 0.002 * self.D_j
        round_ = ((self.r_n <= 0) | (self.r_n >= least)) & ((self.r_l <= 0) | (self.r_l >= least))
        bevel = ((self.c_n <= 0) | (self.c_n >= least)) & ((self.c_l <= 0) | (self.c_l >= least))
        return round_ & bevel & ((self.b_k <= 0) | (self.b_k >= least))

    def featured(self, nose: End, flange: End) -> tuple[End, End, Keyway | None]:
        """Return the ends with their fillets and chamfers, and the keyway of the nose."""
        return (
            replace(nose, fillet=mm(self.r_n), chamfer=mm(self.c_n)),
            replace(flange, fillet=mm(self.r_l), chamfer=mm(self.c_l)),
            Keyway(mm(self.b_k), mm(self.t_k), mm(self.l_k)) if self.b_k > 0 else None,
        )
