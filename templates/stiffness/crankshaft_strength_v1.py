"""Fatigue strength of a crankshaft at its fillets and oil bores, by IACS UR M53.

It gives the endurance limit for a life under the engine cycle, where a factor for a plain specimen is not
sufficient: the rule includes the size of the shaft, its manufacture, and the support effect of a small
fillet.
"""

from __future__ import annotations

from templates.core.language.template import Array, Template, choice, derived, formula, given
from templates.physics.fatigue.crankshaft_strength import (
    MANUFACTURES,
    factor_at_bore,
    fatigue_strength_IACS_M53,
    manufacture_factor,
)

M53 = "IACS UR M53"
SMALLEST = "the rule grows without limit towards a radius of 0: take 2 mm, or a limit that was measured"


class CrankshaftStrength(Template):
    """Fatigue strength of a crankshaft at its fillets and oil bores, by IACS UR M53.

    It gives the endurance limit for a life under the engine cycle, where a factor for a plain specimen is not
    sufficient: the rule includes the size of the shaft, its manufacture, and the support effect of a small
    fillet.

    Limits
    ------
    The result is the alternating von Mises stress that the most highly stressed point withstands permanently.
    The rule applies to forged shafts, or cast steel with fillets rolled by an approved process, without
    further surface treatment.
    The ultimate strength is the minimum of the material. The result applies to local stresses and includes
    notch and size: if it is used as endurance_limit, omit stress_concentration_factor and Marin factors. The
    rule requires it to be 1.15 times the equivalent alternating stress.
    Radii below 2 mm are refused; this bound is the template's own.
    The rule's stress concentration factors are not included; finite elements of the throw give local
    stresses.

    References
    ----------
    IACS UR M53, Calculation of crankshafts for I.C. engines, section 6. Read in: Indian Register of Shipping,
    Classification Notes, Calculation of Crankshafts for Internal Combustion Engines, section 6.
    """

    example = {
        "ultimate_strength": "800 MPa",
        "crankpin_diameter": "200 mm",
        "crankpin_fillet": "8 mm",
        "journal_diameter": "220 mm",
        "journal_fillet": "9 mm",
        "oil_bore": "24 mm",
    }

    B: Array = given("MPa", "ultimate strength", symbol=r"\sigma_B", ge=300, le=1500)
    D: Array = given("mm", "crankpin diameter", ge=10, le=2000)
    R_H: Array = given("mm", "crankpin fillet", symbol="R_H", ge=2, le=500, remedy=SMALLEST)

    @derived("mm", "journal diameter", symbol="D_G", ge=10, le=2000)
    def D_G(self) -> Array:
        """Default: the diameter of the crankpin."""
        return self.D

    @derived("mm", "journal fillet", symbol="R_G", ge=2, le=500, remedy=SMALLEST)
    def R_G(self) -> Array:
        """Default: the fillet of the crankpin."""
        return self.R_H

    D_o: Array = given("mm", "oil bore", symbol="D_o", optional=True, ge=4, le=500, remedy=SMALLEST)
    manufacture: str = choice(*MANUFACTURES, words="manufacture", default="free_form_forged",
                              assumed="the shaft is free-form forged")  # fmt: skip

    @formula("1", "manufacture factor", symbol="K", source=M53)
    def K(self) -> Array:
        return manufacture_factor(self.manufacture)

    @formula("MPa", "strength of crankpin fillet", symbol=r"\sigma_{DW}", source=M53)
    def sigma_H(self) -> Array:
        return fatigue_strength_IACS_M53(self.K, self.B, self.D, self.R_H)

    @formula("MPa", "strength of journal fillet", symbol=r"\sigma_{DW,G}", source=M53)
    def sigma_G(self) -> Array:
        return fatigue_strength_IACS_M53(self.K, self.B, self.D_G, self.R_G)

    @formula("MPa", "strength of oil bore", symbol=r"\sigma_{DW,o}", source=M53)
    def sigma_o(self) -> Array:
        return fatigue_strength_IACS_M53(factor_at_bore(self.K), self.B, self.D, self.D_o / 2)
