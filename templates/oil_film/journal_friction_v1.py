"""Friction of a concentric journal, after Petrov (1883), for light load, high speed and high viscosity."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, formula, given, require
from templates.groups.film_assumptions import ISOTHERMAL, PARALLEL, RIGID
from templates.groups.film_criteria import film_exists
from templates.groups.journal_criteria import CRITERIA
from templates.physics.journals.loaded_journal import eccentricity_of_load, friction_over_Petrov, load_number
from templates.physics.journals.petrov import friction_Petrov_1883

PETROV = "Petrov 1883"
ISO = "ISO 7902-1:1998"
AT_REST = "without speed there is no film"
BEYOND = "no film bears this load, or the Reynolds solution ends: B/D 0.01 … 100, eps to 1 − 1e-7"
USE = "the loaded film rubs more by this factor; `oil_film` 2 calculates it"


class JournalFriction(Template):
    """Friction of a concentric journal, after Petrov (1883), for light load, high speed and high viscosity.

    A journal that runs concentrically in its bearing shears the oil uniformly: F_f = 2 pi r² b eta omega/c,
    which the course MEC 315 prints as 4 pi² r² eta N b/(60 c) with N in rpm.

    Limits
    ------
    Petrov's journal carries no load; under load a journal runs eccentrically and its friction is higher.
    If the radial load is given, the answer states the effect: the eccentricity and the friction over Petrov's
    come from the Reynolds solution (full circle, Swift–Stieber rupture), and a difference of 5 % or more
    gives a warning.
    Measured by `benchmarks/petrov.py` for B/D 0.01 to 100, Petrov's value is too low by 2.0 to 5.5 % at eps
    0.2, by 13 to 27 % at 0.5, by 56 to 70 % at 0.9 and by 86 to 91 % at 0.99.
    The course's own load of 3 kN gives its worked case So = 32, eps = 0.965 and 5.3 times Petrov's friction:
    it is far outside the range of Petrov's formula.
    The film is laminar and isothermal, and fills the whole circle. The load is stationary, and the speed is
    that of the journal relative to the bearing. Above Re = 41.3 √(r/c) (Taylor vortices) a warning states
    that friction is higher; the density is used only for this check.

    References
    ----------
    Petrov: Inzhenernyj Zhurnal, 1883.
    Course MEC 315, hydrodynamic lubrication.
    """

    precision = 1e-8  # the eccentricity is found by a search

    assumptions = (RIGID, PARALLEL, ISOTHERMAL)
    example = {
        "journal_diameter": "50 mm",
        "bearing_width": "100 mm",
        "radial_clearance": "0.25 mm",
        "speed": "1500 rpm",
        "dynamic_viscosity": "11.877 mPa*s",
        "radial_load": "10 N",
    }
    main_results = ("radial_load", "speed", "friction_torque", "power_loss", "relative_eccentricity")
    criteria = {
        "film": {
            "require": "radial_clearance * (1 - relative_eccentricity) >= smallest_permissible_film",
            "words": "the smallest film is not thinner than the smallest permissible one",
            "limits": {
                "smallest_permissible_film": {
                    "unit": "um",
                    "words": "smallest film that the bearing may have",
                }
            },
        },
        "film_exists": film_exists("radial_clearance * (1 - relative_eccentricity)"),
        "laminar": CRITERIA["laminar"],
        "specific_load": {
            "require": "radial_load / (journal_diameter * bearing_width) <= permissible_specific_load",
            "words": "the load over journal times width is within what the bearing material bears",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over journal times width that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
    }

    d: Array = given("mm", "journal diameter", gt=0)
    b: Array = given("mm", "bearing width", gt=0)
    c: Array = given("um", "radial clearance", gt=0)
    omega: Array = given("rpm", "speed", ge=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)
    F: Array = given("N", "radial load", optional=True, ge=0)
    rho: Array = given("kg/m**3", "density", default="875 kg/m**3", gt=0)

    @require("radial_clearance", "journal_diameter", remedy="give half of bore minus journal")
    def clearance_within_journal(self) -> Truth:
        """The radial clearance is smaller than the journal's radius."""
        return self.c < self.d / 2

    @formula("N", "friction force", symbol="F_f", source=PETROV, assumes=("phi",))
    def F_f(self) -> Array:
        return friction_Petrov_1883(self.d / 2, self.b, self.c, self.eta, self.omega)

    @formula("N*m", "friction torque", symbol="T_f")
    def T_f(self) -> Array:
        return self.F_f * self.d / 2

    @formula("W", "power loss")
    def P(self) -> Array:
        return self.T_f * self.omega

    @formula("1", "relative clearance")
    def psi(self) -> Array:
        return self.c / (self.d / 2)

    @formula("1", "film Reynolds number", symbol=r"\mathrm{Re}", source=ISO)
    def Re(self) -> Array:
        return self.rho * self.omega * self.d / 2 * self.c / self.eta

    @formula("1", "laminar limit", symbol=r"\mathrm{Re}_{cr}", source=ISO)
    def Re_cr(self) -> Array:
        return 41.3 / np.sqrt(self.psi)

    @formula("1", "width ratio", symbol=r"\lambda")
    def ratio(self) -> Array:
        return self.b / self.d

    @formula("1", "Sommerfeld number", absent=AT_REST)
    def S_0(self) -> Array:
        return load_number(self.F, self.psi, self.eta, self.omega, self.b, self.d)

    @formula("1", "relative eccentricity", absent=BEYOND)
    def eps(self) -> Array:
        return eccentricity_of_load(self.S_0, self.ratio)

    @formula("1", "friction ratio", symbol=r"\phi", published=(None, 1.05), remedy=USE, absent=BEYOND)
    def phi(self) -> Array:
        return friction_over_Petrov(self.eps, self.ratio)
