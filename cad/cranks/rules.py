"""Rules that refuse a crank; each names the parameters and a remedy.

The rules are some per cent stricter than geometry requires, so that edges do not come too close to each
other. The kernel can build every crank that the rules accept, and the closed form of the volume is valid for
it.
"""

from __future__ import annotations

from math import pi, radians

import numpy as np

from cad.cranks.parameters import CrankParameters
from templates.core.language.template import Array, Truth, require, units


@units(None, "m", returns="m")
def corner(shape: str, width: Array) -> Array:
    """Return the distance [m] from the journal axis to a corner of the web on the counterweight's side."""
    return {"obround": 0.5, "rectangular": 0.5 * 2**0.5}[shape] * width


@units(None, "rad", returns="1")
def clear_of_corners(shape: str, angle: Array) -> Truth:
    """Return whether the flanks of a counterweight [rad] are clear of the corners of the web."""
    meeting = {"obround": pi, "rectangular": pi / 2}[shape]
    apart: Array = np.abs(angle - meeting)
    return (apart < 1e-9) | (apart >= radians(0.099))


class CrankRules(CrankParameters):
    """Rules for the parameters of a crank."""

    @require("web_width", "journal_diameter", "fillet", remedy="make the web wider or the fillet smaller")
    def web_holds_journal(self) -> Truth:
        """The web is at least 2 % wider than the journal with its fillet."""
        return self.W >= 1.02 * (self.D_j + 2 * self.r_f)

    @require("web_width", "pin_diameter", "fillet", remedy="make the web wider or the fillet smaller")
    def web_holds_pin(self) -> Truth:
        """The web is at least 2 % wider than the pin with its fillet."""
        return self.W >= 1.02 * (self.D_c + 2 * self.r_f)

    @require("fillet", "pin_length", remedy="make the fillet smaller or the pin longer")
    def fillets_fit_on_pin(self) -> Truth:
        """The two fillets occupy at most 90 % of the pin's length."""
        return 2 * self.r_f <= 0.9 * self.L_c

    @require("fillet", "journal_length", remedy="make the fillet smaller or the journal longer")
    def fillet_fits_on_journal(self) -> Truth:
        """A fillet occupies at most 90 % of the length of journal drawn next to a web."""
        return self.r_f <= 0.9 * self.L_s

    @require("journal_bore", "journal_diameter", remedy="make the bore smaller, or 0 for none")
    def journal_has_wall(self) -> Truth:
        """The bore diameter is at most 98 % of the journal's diameter."""
        return self.d_j <= 0.98 * self.D_j

    @require("pin_bore", "pin_diameter", remedy="make the bore smaller, or 0 for none")
    def pin_has_wall(self) -> Truth:
        """The bore diameter is at most 98 % of the pin's diameter."""
        return self.d_c <= 0.98 * self.D_c

    @require(
        "journal_bore", "pin_diameter", "throw", "fillet",
        remedy="make the journal's bore smaller, or 0 for none, or the throw larger",
    )  # fmt: skip
    def journal_bore_clears_pin(self) -> Truth:
        """The journal's bore clears the pin and its fillet in the web by at least 2 % of the pin's radius."""
        return (self.d_j <= 0) | (self.R - self.d_j / 2 >= 0.51 * self.D_c + self.r_f)

    @require(
        "pin_bore", "journal_diameter", "throw", "fillet",
        remedy="make the pin's bore smaller, or 0 for none, or the throw larger",
    )  # fmt: skip
    def pin_bore_clears_journal(self) -> Truth:
        """The pin's bore clears the journal and its fillet in the web by at least 4 % of the radius."""
        return (self.d_c <= 0) | (self.R - self.d_c / 2 >= 0.52 * self.D_j + self.r_f)

    @require("throw", "journal_diameter", remedy="make the throw larger")
    def has_throw(self) -> Truth:
        """The throw is at least 1 % of the journal's diameter."""
        return self.R >= 0.01 * self.D_j

    @require(
        "oil_drilling_diameter", "pin_diameter", "journal_diameter", remedy="make the oil drilling smaller"
    )
    def drilling_is_narrow(self) -> Truth:
        """The oil drilling is at most half as wide as pin and journal."""
        return (self.d_o <= self.D_c / 2) & (self.d_o <= self.D_j / 2)

    @require(
        "oil_drilling_diameter",
        "pin_length",
        "fillet",
        remedy="make the oil drilling smaller or the pin longer",
    )
    def drilling_opens_in_pin(self) -> Truth:
        """The mouth of the oil drilling occupies at most 90 % of the pin between its fillets."""
        return (self.d_o <= 0) | (self.m_c <= 0.9 * (self.L_c / 2 - self.r_f))

    @require(
        "oil_drilling_diameter", "journal_length", "fillet",
        remedy="make the oil drilling smaller or the journal longer",
    )  # fmt: skip
    def drilling_opens_in_journal(self) -> Truth:
        """The mouth of the oil drilling is within the journal, 10 % away from its fillet and its end."""
        return (self.d_o <= 0) | (self.m_j <= 0.9 * (self.L_s / 2 - self.r_f))

    @require(
        "oil_drilling_diameter", "pin_diameter", "pin_length",
        remedy="make the oil drilling smaller, or the pin shorter or thicker",
    )  # fmt: skip
    def drilling_stays_in_pin(self) -> Truth:
        """The oil drilling enters the web from within the pin, 2 % of its radius from its underside."""
        return (self.d_o <= 0) | (self.x_1 - self.e_o >= self.R - 0.49 * self.D_c)

    @require(
        "oil_drilling_diameter", "journal_diameter", "journal_length",
        remedy="make the oil drilling smaller, or the journal shorter or thicker",
    )  # fmt: skip
    def drilling_stays_in_journal(self) -> Truth:
        """The oil drilling leaves the web within the journal, 2 % of its radius from its upper side."""
        return (self.d_o <= 0) | (self.x_2 + self.e_o <= 0.49 * self.D_j)

    @require(
        "oil_drilling_diameter", "pin_bore", "journal_bore",
        remedy="make the oil drilling smaller, or the bore larger or 0 for none",
    )  # fmt: skip
    def drilling_crosses_bores(self) -> Truth:
        """The oil drilling is at most 90 % as wide as a bore that it crosses."""
        through_pin = (self.d_c <= 0) | (self.d_o <= 0.9 * self.d_c)
        return through_pin & ((self.d_j <= 0) | (self.d_o <= 0.9 * self.d_j))

    @require(
        "oil_drilling_diameter", "face_inclination", remedy="make the oil drilling or the inclination smaller"
    )
    def drilling_keeps_below_incline(self) -> Truth:
        """The oil drilling keeps at least a tenth of its radius away from the inclined face."""
        covered = (self.c_1 >= 0.55 * self.d_o) & (self.c_2 >= 0.55 * self.d_o)
        return (self.d_o <= 0) | (self.beta <= 0) | covered

    @require(
        "counterweight_radius", "web_width", "web_shape",
        remedy="make the counterweight's radius larger, or 0 for none",
    )  # fmt: skip
    def counterweight_stands_out(self) -> Truth:
        """A counterweight reaches at least 2 % further from the journal's axis than the web does there."""
        return (self.R_w <= 0) | (self.R_w >= 1.02 * corner(self.web_shape, self.W))

    @require("counterweight_angle", "web_shape", remedy="meet the corner exactly, or keep off it by 0.1°")
    def flanks_clear_corners(self) -> Truth:
        """The counterweight's flanks meet corners (obround 180°, rectangular 90°) or miss them by 0.1°."""
        return (self.R_w <= 0) | clear_of_corners(self.web_shape, self.phi_w)

    @require("face_inclination", "web_thickness", remedy="make the inclination smaller or the web thicker")
    def inclined_web_keeps_an_end(self) -> Truth:
        """The end of an inclined web is at least a tenth as thick as the rest."""
        return self.L_e >= 0.1 * self.L_w

    @require("face_inclination", "throw", "web_width", remedy="make the throw or the web's width larger")
    def inclined_face_has_length(self) -> Truth:
        """The inclined face, from the journal's fillet to the web's end, is at least 5 % of its width."""
        return (self.beta <= 0) | (self.R + self.W / 2 - self.x_b >= 0.05 * self.W)

    @require("face_inclination", remedy="use 0 for flat faces")
    def inclination_is_drawable(self) -> Truth:
        """The face inclination is 0, or at least 0.01°."""
        return (self.beta <= 0) | (self.beta >= radians(0.0099))

    @require(
        "journal_bore",
        "pin_bore",
        "fillet",
        "oil_drilling_diameter",
        "journal_diameter",
        remedy="use 0 for none",
    )
    def features_are_drawable(self) -> Truth:
        """Bores, fillet and oil drilling are 0, or at least 0.2 % of the journal's diameter."""
        least = 0.002 * self.D_j
        bores = ((self.d_j <= 0) | (self.d_j >= least)) & ((self.d_c <= 0) | (self.d_c >= least))
        return bores & ((self.r_f <= 0) | (self.r_f >= least)) & ((self.d_o <= 0) | (self.d_o >= least))
