"""Torsional stiffness of a crank throw from its dimensions, after Carter and after Ker Wilson.

The stiffness is from mid-journal to mid-journal, for a first layout and to check finite elements. Both
formulas are fitted to tests of common proportions; they ignore fillets, oil holes, counterweights and the
shape of the web.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.language.template import Array, Template, Truth, formula, given, require, text
from templates.physics.shafts.torsion_throw import ring
from templates.physics.shafts.torsion_transition import (
    joined_stiffness,
    reason,
    recommended,
    share_of_wilson,
)

CARTER = "Carter 1928"
WILSON = "Ker Wilson 1956"
PAPER = "Punewale et al. 2015"
SHORT = "below 0.2 (journal + pin diameter) Ker Wilson's web term turns negative"
NOTHING_LEFT = (
    "the throw is too short for Ker Wilson's formula: ask for `stiffness_carter` or finite elements"
)
COMPARABLE: dict[str, Any] = {"gt": -1e9, "lt": 1e9, "remedy": "the two are not of one kind: check units"}
NOT_COMPARED = "give `reference_stiffness`, such as a measured one or one by finite elements"


class CrankStiffness(Template):
    """Torsional stiffness of a crank throw from its dimensions, after Carter and after Ker Wilson.

    The stiffness is from mid-journal to mid-journal, for a first layout and to check finite elements. Both
    formulas are fitted to tests of common proportions; they ignore fillets, oil holes, counterweights and the
    shape of the web.

    Limits
    ------
    Carter's formula is for flexible webs without overlap of journal and pin, Ker Wilson's for stiff webs with
    overlap; the overlap decides which is recommended, and both are returned.
    If the overlap is within ±0.1 (journal diameter + pin diameter), the recommended stiffness changes from
    one to the other continuously: it is blended from both flexibilities. The literature states only the sign
    of the overlap; the width of the transition is our choice.
    With a throw below 0.2 (journal diameter + pin diameter) Ker Wilson's web term is negative, which gives a
    warning. If it outweighs journal and pin, the formula gives no stiffness, and its result is refused.
    Sensitivities are d ln K/d ln x with all other dimensions constant: a value of 2 means that 1 % more of
    the dimension gives 2 % more stiffness.

    Errata
    ------
    The paper states percentage differences on different bases (15.711 % is relative to Carter's value;
    relative to the finite-element value it is 18.64 %). Here every difference names its base.

    References
    ----------
    B. C. Carter: An empirical formula for crankshaft stiffness in torsion. Engineering 126, 1928.
    W. Ker Wilson: Practical Solution of Torsional Vibration Problems, 3rd ed., vol. 1, 1956.
    Punewale, Khobragade, Chaudhari, Khandre, 2015, for the choice between them by overlap.
    """

    example = {
        "journal_length": "45 mm",
        "journal_diameter": "100 mm",
        "journal_bore": "30 mm",
        "web_thickness": "28 mm",
        "web_width": "130 mm",
        "pin_length": "50 mm",
        "pin_diameter": "85 mm",
        "pin_bore": "25 mm",
        "throw": "68.5 mm",
        "shear_modulus": "80 GPa",
        "reference_stiffness": "2.6e6 N*m/rad",
    }
    main_results = ("stiffness_carter", "stiffness_wilson", "recommended_stiffness")
    criteria = {
        "stiffness": {
            "require": "recommended_stiffness >= required_stiffness",
            "words": "the throw is as stiff as required",
            "limits": {"required_stiffness": {"unit": "N*m/rad", "words": "smallest stiffness of the throw"}},
        },
        "reference": {
            "require": "abs(recommended_stiffness - reference_stiffness)"
            " <= permissible_difference * reference_stiffness",
            "words": "the recommended stiffness agrees with the reference",
            "limits": {
                "permissible_difference": {"unit": "1", "words": "largest difference, of the reference"}
            },
        },
    }

    L_j: Array = given("mm", "journal length", gt=0)
    D_j: Array = given("mm", "journal diameter", gt=0)
    d_j: Array = given("mm", "journal bore", default="0 mm", ge=0, assumed="the journal is solid")
    L_w: Array = given("mm", "web thickness", gt=0)
    W: Array = given("mm", "web width", gt=0)
    L_c: Array = given("mm", "pin length", gt=0)
    D_c: Array = given("mm", "pin diameter", gt=0)
    d_c: Array = given("mm", "pin bore", default="0 mm", ge=0, assumed="the pin is solid")
    R: Array = given("mm", "throw", gt=0, also=("crank radius",))
    G: Array = given("GPa", "shear modulus", gt=0)
    K_0: Array = given("N*m/rad", "reference stiffness", optional=True, gt=0)

    @require("journal_bore", "journal_diameter", remedy="make the bore smaller")
    def journal_has_a_wall(self) -> Truth:
        """The bore of the journal is smaller than the journal."""
        return self.d_j < self.D_j

    @require("pin_bore", "pin_diameter", remedy="make the bore smaller")
    def pin_has_a_wall(self) -> Truth:
        """The bore of the pin is smaller than the pin."""
        return self.d_c < self.D_c

    @formula("mm**4", "journal section", symbol="S_j", gt=0, lt=1e40)
    def S_j(self) -> Array:
        return ring(self.D_j, self.d_j)

    @formula("mm**4", "pin section", symbol="S_c", gt=0, lt=1e40)
    def S_c(self) -> Array:
        return ring(self.D_c, self.d_c)

    @formula("mm**4", "web section", symbol="S_w", gt=0, lt=1e40)
    def S_w(self) -> Array:
        return self.L_w * self.W**3

    @formula("1/mm**3", "journal part of Carter", symbol="j_C", source=CARTER)
    def j_C(self) -> Array:
        return (self.L_j + 0.8 * self.L_w) / self.S_j

    @formula("1/mm**3", "pin part of Carter", symbol="c_C", source=CARTER)
    def c_C(self) -> Array:
        return 0.75 * self.L_c / self.S_c

    @formula("1/mm**3", "web part of Carter", symbol="w_C", source=CARTER)
    def w_C(self) -> Array:
        return 1.5 * self.R / self.S_w

    @formula("1/mm**3", "sum of Carter", symbol="s_C", gt=0)
    def s_C(self) -> Array:
        return self.j_C + self.c_C + self.w_C

    @formula("N*m/rad", "stiffness Carter", symbol="K_C", source=CARTER, gt=0)
    def K_C(self) -> Array:
        return np.pi / 32 * self.G / self.s_C

    @formula("mm", "effective throw", symbol="R_e", source=WILSON, published=(0, None), remedy=SHORT)
    def R_e(self) -> Array:
        return self.R - 0.2 * (self.D_j + self.D_c)

    @formula("1/mm**3", "journal part of Wilson", symbol="j_W", source=WILSON)
    def j_W(self) -> Array:
        return (self.L_j + 0.4 * self.D_j) / self.S_j

    @formula("1/mm**3", "pin part of Wilson", symbol="c_W", source=WILSON)
    def c_W(self) -> Array:
        return (self.L_c + 0.4 * self.D_c) / self.S_c

    @formula("1/mm**3", "web part of Wilson", symbol="w_W", source=WILSON)
    def w_W(self) -> Array:
        return self.R_e / self.S_w

    @formula("1/mm**3", "sum of Wilson", symbol="s_W", gt=0, remedy=NOTHING_LEFT)
    def s_W(self) -> Array:
        return self.j_W + self.c_W + self.w_W

    @formula("N*m/rad", "stiffness Wilson", symbol="K_W", source=WILSON, gt=0)
    def K_W(self) -> Array:
        return np.pi / 32 * self.G / self.s_W

    @formula("mm", "overlap", symbol="s", source=PAPER)
    def s(self) -> Array:
        return (self.D_j + self.D_c) / 2 - self.R

    @formula("1", "share of Wilson", symbol="c_s")
    def c_s(self) -> Array:
        return share_of_wilson(self.s, self.D_j, self.D_c)

    @text("recommended")
    def which(self) -> str:
        return recommended(self.c_s)

    @text("reason")
    def why(self) -> str:
        return reason(self.c_s, self.R_e)

    @formula("N*m/rad", "recommended stiffness", symbol="K")
    def K(self) -> Array:
        return joined_stiffness(self.c_s, self.K_C, self.K_W)

    @formula("%", "Wilson minus Carter, of Carter", symbol=r"\Delta_C", **COMPARABLE)
    def delta_C(self) -> Array:
        return (self.K_W - self.K_C) / self.K_C

    @formula("%", "Wilson minus Carter, of Wilson", symbol=r"\Delta_W", **COMPARABLE)
    def delta_W(self) -> Array:
        return (self.K_W - self.K_C) / self.K_W

    @formula(
        "%", "Carter minus reference, of reference", symbol=r"\Delta_{C0}", absent=NOT_COMPARED, **COMPARABLE
    )
    def delta_C0(self) -> Array:
        return (self.K_C - self.K_0) / self.K_0

    @formula(
        "%", "Carter minus reference, of Carter", symbol=r"\Delta_{CC}", absent=NOT_COMPARED, **COMPARABLE
    )
    def delta_CC(self) -> Array:
        return (self.K_C - self.K_0) / self.K_C

    @formula(
        "%", "Wilson minus reference, of reference", symbol=r"\Delta_{W0}", absent=NOT_COMPARED, **COMPARABLE
    )
    def delta_W0(self) -> Array:
        return (self.K_W - self.K_0) / self.K_0

    @formula(
        "%", "Wilson minus reference, of Wilson", symbol=r"\Delta_{WW}", absent=NOT_COMPARED, **COMPARABLE
    )
    def delta_WW(self) -> Array:
        return (self.K_W - self.K_0) / self.K_W

    @formula("1", "sensitivity of Carter to journal length", symbol="e_{C,Lj}")
    def e_C_Lj(self) -> Array:
        return -self.L_j / self.S_j / self.s_C

    @formula("1", "sensitivity of Carter to journal diameter", symbol="e_{C,Dj}")
    def e_C_Dj(self) -> Array:
        return 4 * self.D_j**4 / self.S_j * self.j_C / self.s_C

    @formula("1", "sensitivity of Carter to journal bore", symbol="e_{C,dj}")
    def e_C_dj(self) -> Array:
        return -4 * self.d_j**4 / self.S_j * self.j_C / self.s_C

    @formula("1", "sensitivity of Carter to web thickness", symbol="e_{C,Lw}")
    def e_C_Lw(self) -> Array:
        return (self.w_C - 0.8 * self.L_w / self.S_j) / self.s_C

    @formula("1", "sensitivity of Carter to web width", symbol="e_{C,W}")
    def e_C_W(self) -> Array:
        return 3 * self.w_C / self.s_C

    @formula("1", "sensitivity of Carter to pin length", symbol="e_{C,Lc}")
    def e_C_Lc(self) -> Array:
        return -self.c_C / self.s_C

    @formula("1", "sensitivity of Carter to pin diameter", symbol="e_{C,Dc}")
    def e_C_Dc(self) -> Array:
        return 4 * self.D_c**4 / self.S_c * self.c_C / self.s_C

    @formula("1", "sensitivity of Carter to pin bore", symbol="e_{C,dc}")
    def e_C_dc(self) -> Array:
        return -4 * self.d_c**4 / self.S_c * self.c_C / self.s_C

    @formula("1", "sensitivity of Carter to throw", symbol="e_{C,R}")
    def e_C_R(self) -> Array:
        return -self.w_C / self.s_C

    @formula("1", "sensitivity of Wilson to journal length", symbol="e_{W,Lj}")
    def e_W_Lj(self) -> Array:
        return -self.L_j / self.S_j / self.s_W

    @formula("1", "sensitivity of Wilson to journal diameter", symbol="e_{W,Dj}")
    def e_W_Dj(self) -> Array:
        return self.D_j * (4 * self.D_j**3 * self.j_W / self.S_j - 0.4 / self.S_j + 0.2 / self.S_w) / self.s_W

    @formula("1", "sensitivity of Wilson to journal bore", symbol="e_{W,dj}")
    def e_W_dj(self) -> Array:
        return -4 * self.d_j**4 / self.S_j * self.j_W / self.s_W

    @formula("1", "sensitivity of Wilson to web thickness", symbol="e_{W,Lw}")
    def e_W_Lw(self) -> Array:
        return self.w_W / self.s_W

    @formula("1", "sensitivity of Wilson to web width", symbol="e_{W,W}")
    def e_W_W(self) -> Array:
        return 3 * self.w_W / self.s_W

    @formula("1", "sensitivity of Wilson to pin length", symbol="e_{W,Lc}")
    def e_W_Lc(self) -> Array:
        return -self.L_c / self.S_c / self.s_W

    @formula("1", "sensitivity of Wilson to pin diameter", symbol="e_{W,Dc}")
    def e_W_Dc(self) -> Array:
        return self.D_c * (4 * self.D_c**3 * self.c_W / self.S_c - 0.4 / self.S_c + 0.2 / self.S_w) / self.s_W

    @formula("1", "sensitivity of Wilson to pin bore", symbol="e_{W,dc}")
    def e_W_dc(self) -> Array:
        return -4 * self.d_c**4 / self.S_c * self.c_W / self.s_W

    @formula("1", "sensitivity of Wilson to throw", symbol="e_{W,R}")
    def e_W_R(self) -> Array:
        return -self.R / self.S_w / self.s_W
