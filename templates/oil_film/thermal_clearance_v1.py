"""Clearance of a journal in its housing when both are warm, from the clearance measured at 20 °C (ISO 1)."""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, formula, given, require

ISO_1 = "ISO 1:2016"
EXPANSION = "linear expansion from the reference temperature"


class ThermalClearance(Template):
    """Clearance of a journal in its housing when both are warm, from the clearance measured at 20 °C (ISO 1).

    Dimensions on a drawing apply at 20 °C. When warm, the bore of the housing and the journal expand; the
    clearance between them is c = c_0 + D (alpha_h (T_h - T_0) - alpha_j (T_j - T_0)).

    Limits
    ------
    Each part has one temperature and one mean coefficient of expansion between the reference temperature and
    its own.
    It expands freely: nothing restrains the housing, and it contains no shell of another material.
    Loads, press fits and the film's pressure change the clearance too; they are neglected.
    The expansion is small relative to the diameter, so D may be that of the bore or of the journal.

    References
    ----------
    ISO 1:2016, Geometrical product specifications: standard reference temperature, 20 °C.
    """

    example = {
        "diameter": "48 mm",
        "cold_diametral_clearance": "55 um",
        "housing_expansion_coefficient": "2.3e-5 1/K",
        "journal_expansion_coefficient": "1.1e-5 1/K",
        "housing_temperature": "100 degC",
        "journal_temperature": "110 degC",
    }
    main_results = ("growth_of_the_bore", "growth_of_the_journal", "diametral_clearance")
    criteria = {
        "runs": {
            "require": "diametral_clearance >= 0 um",
            "words": "the journal does not seize in its housing",
            "warning": "seized",
        },
        "least_clearance": {
            "require": "diametral_clearance >= smallest_permissible_clearance",
            "words": "the warm clearance is not smaller than the smallest permissible one",
            "limits": {
                "smallest_permissible_clearance": {
                    "unit": "um",
                    "words": "smallest diametral clearance at which the bearing may run",
                }
            },
        },
    }

    D: Array = given("mm", "diameter", symbol="D", gt=0, also=("bearing diameter", "journal diameter"))
    c_0: Array = given("um", "cold diametral clearance", symbol="c_0", also=("diametral clearance",))
    alpha_h: Array = given("1/K", "housing expansion coefficient", symbol=r"\alpha_h", ge=-1e-4, le=1e-3)
    alpha_j: Array = given("1/K", "journal expansion coefficient", symbol=r"\alpha_j", ge=-1e-4, le=1e-3)
    T_h: Array = given("degC", "housing temperature", symbol="T_h", ge=-273.15, le=1500)
    T_j: Array = given("degC", "journal temperature", symbol="T_j", ge=-273.15, le=1500)
    T_0: Array = given(
        "degC", "reference temperature", symbol="T_0", default="20 degC", source=ISO_1, ge=-273.15, le=1500
    )

    @require("cold_diametral_clearance", "diameter", remedy="give bore minus journal")
    def clearance_within_diameter(self) -> Truth:
        """The cold clearance, or interference, is smaller than the diameter."""
        return abs(self.c_0) < self.D

    @formula("um", "growth of the bore", symbol=r"\Delta D_h", source=EXPANSION)
    def dD_h(self) -> Array:
        return self.D * self.alpha_h * (self.T_h - self.T_0)

    @formula("um", "growth of the journal", symbol=r"\Delta D_j", source=EXPANSION)
    def dD_j(self) -> Array:
        return self.D * self.alpha_j * (self.T_j - self.T_0)

    @formula("um", "diametral clearance", symbol="c")
    def c(self) -> Array:
        return self.c_0 + self.dD_h - self.dD_j

    @formula("um", "radial clearance", symbol="c_r")
    def c_r(self) -> Array:
        return self.c / 2

    @formula("1", "relative clearance", symbol=r"\psi")
    def psi(self) -> Array:
        return self.c / self.D
