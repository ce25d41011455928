"""Parameters and rules of the thrust faces of a shaft: collars on the webs beside one main journal."""

from __future__ import annotations

import numpy as np

from cad.cranks.rules import CrankRules
from cad.cranks.throw import Collar
from cad.model import mm
from templates.core.language.template import Array, Truth, derived, formula, given, require, units


@units("1", "m", returns="m", latex=r"{1}\ \text{{if}}\ {0} > 0")
def where_thrust(main: Array, length: Array) -> Array:
    """Return a length [m] if a main journal has collars, else 0."""
    return np.where(np.asarray(main) > 0, length, 0 * length)[()]


class ThrustParameters(CrankRules):
    """Parameters of the collars that take axial thrust."""

    n: Array  # throws
    r_nj: Array  # fillet of the nose on the first journal
    r_lj: Array  # fillet of the flange on the last journal

    k_t: Array = given("1", "thrust main", symbol="k_t", default="0", integer=True, ge=0, le=17)

    @derived("mm", "thrust diameter", symbol="D_t", ge=0.1, le=10000)
    def D_t(self) -> Array:
        """Return the default: halfway between the journal's fillet and the width of the web."""
        return (self.D_j + 2 * self.r_f + self.W) / 2

    @derived("mm", "thrust height", symbol="h_t", ge=0.001, le=500)
    def h_t(self) -> Array:
        """Return the default: 2 % of the journal diameter."""
        return 0.02 * self.D_j

    @formula("mm", "incline start", symbol="x_b")
    def x_b(self) -> Array:
        """Position at which a web's outer face begins to slope: beyond the fillet and any collar."""
        return np.maximum(0.51 * self.D_j + self.r_f, where_thrust(self.k_t, 0.51 * self.D_t))

    @formula("mm", "width of the thrust face", name="thrust_face", symbol="w_t")
    def w_t(self) -> Array:
        """Width of the plane ring outside the journal's fillet."""
        return (self.D_t - self.D_j) / 2 - self.r_f

    @require("thrust_main", "pin_angles", remedy="give 0 for none, or a main from 1 to the throws plus 1")
    def thrust_main_exists(self) -> Truth:
        """The thrust main is one of the main journals, which are one more than the throws."""
        return self.k_t <= self.n + 1

    @require("thrust_main", "thrust_diameter", "journal_diameter", "fillet",
             remedy="make the thrust diameter larger")  # fmt: skip
    def thrust_face_has_width(self) -> Truth:
        """The thrust diameter is at least 2 % larger than the journal with its fillet."""
        return (self.k_t <= 0) | (self.D_t >= 1.02 * (self.D_j + 2 * self.r_f))

    @require("thrust_main", "thrust_diameter", "web_width", remedy="make the thrust diameter smaller")
    def thrust_face_lies_on_web(self) -> Truth:
        """The thrust diameter is at most 98.5 % of the web's width."""
        return (self.k_t <= 0) | (self.D_t <= 0.985 * self.W)

    @require("thrust_main", "thrust_diameter", "pin_bore", "throw",
             remedy="make the pin's bore or the thrust diameter smaller")  # fmt: skip
    def pin_bore_clears_thrust_face(self) -> Truth:
        """The pin's bore clears the collar by at least 2 % of the collar's radius."""
        return (self.k_t <= 0) | (self.d_c <= 0) | (self.R - self.d_c / 2 >= 0.51 * self.D_t)

    @require("thrust_main", "thrust_height", "fillet", "journal_length",
             remedy="make collar and fillet smaller or the journal longer")  # fmt: skip
    def collars_fit_on_journal(self) -> Truth:
        """Two collars and their fillets occupy at most 90 % of the journal; each is 0.1 % of it high."""
        fits = 2 * (self.h_t + self.r_f) <= 0.9 * self.L_j
        return (self.k_t <= 0) | (fits & (self.h_t >= 1e-3 * self.L_j))

    @require("thrust_main", "thrust_height", "nose_fillet", "flange_fillet", "journal_length",
             remedy="make the collar or the fillets at nose and flange smaller")  # fmt: skip
    def collar_clears_end_fillets(self) -> Truth:
        """A collar and the fillets of an outermost journal occupy at most 90 % of its length."""
        beside = self.h_t + self.r_f + np.maximum(self.r_nj, self.r_lj)
        return (self.k_t <= 0) | (beside <= 0.9 * self.L_j)

    @require("thrust_main", "thrust_height", "oil_drilling_diameter", "fillet", "journal_length",
             remedy="make the oil drilling or the thrust height smaller")  # fmt: skip
    def drilling_clears_collars(self) -> Truth:
        """The mouth of the oil drilling is 10 % away from the fillets at the collars."""
        clear = self.m_j <= 0.9 * (self.L_j / 2 - self.r_f - self.h_t)
        return (self.k_t <= 0) | (self.d_o <= 0) | clear

    def collar_drawn(self) -> tuple[Collar | None, int]:
        """Return the collar and the number of its main journal."""
        main = round(float(self.k_t))
        return (Collar(mm(self.D_t) / 2, mm(self.h_t)) if main else None), main
