"""Hydrostatic pad: a circular or annular step pad with a recess, fed by a pump (MEC 315).

The pump lifts the load at any speed, even at rest: the film follows from the load, the lands and the
restrictor. The closed forms assume laminar, isothermal, incompressible flow between parallel rigid faces, and
a deep recess.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, choice, formula, given, require
from templates.groups.film_criteria import film_exists
from templates.physics.pads.hydrostatic import (
    CAPILLARY,
    CONSTANT_FLOW,
    RESTRICTORS,
    capillary_Reynolds_number,
    effective_area,
    land_conductance,
    pad_area,
    polar_moment_of_lands,
    power_ratio,
    pump_pressure,
    restrictor_flow,
    stiffest_ratio,
    stiffness_factor,
)

HAMROCK = "Hamrock, Schmid, Jacobson 2004, chapter 13"
RIPPEL = "Rippel 1963"
AT_REST = "needs speed, and one that is not zero"
NEVER_STIFFEST = "a constant flow is the stiffer, the higher the pressure of the recess"


class HydrostaticPad(Template):
    """Hydrostatic pad: a circular or annular step pad with a recess, fed by a pump (MEC 315).

    The pump lifts the load at any speed, even at rest: the film follows from the load, the lands and the
    restrictor. Closed forms; laminar, isothermal, incompressible, parallel rigid faces, a deep recess.

    Limits
    ------
    Without the two inner diameters the pad is circular with one land; with both it is annular with two.
    The faces are parallel: the pad does not tilt, and the calculation does not apply to an eccentric load.
    The recess is so deep that its pressure is uniform and its friction negligible relative to the lands.
    Flow in lands and capillary is laminar; warnings report where it is not. A capillary is much longer than
    its diameter, so the pressure loss at its inlet is neglected.
    Centrifugal force and the inertia of the oil are neglected: at the edge, rho v² must be small relative to
    the recess pressure.
    Restrictor constant_flow is a pump of fixed displacement; its supply pressure is that of its relief valve.
    No heat leaves through the walls, so the calculated temperature rise is an upper limit.
    The given viscosity applies at every temperature. Mineral oil loses half of its viscosity in some 15 to
    20 K, so give the viscosity at the mean temperature on the lands; a rise above 60 K gives a warning.
    The film and the viscosity of least power apply to the same load and lands, with a restrictor resized for
    them; they need a speed.

    References
    ----------
    Rippel: Cast Bronze Hydrostatic Bearing Design Manual, 1963, for the pad coefficients.
    Hamrock, Schmid, Jacobson: Fundamentals of Fluid Film Lubrication, 2nd ed. 2004, chapter 13.
    Course MEC 315, hydrodynamic and hydrostatic lubrication.
    """

    assumptions = ("the faces are parallel, rigid and smooth", "the oil does not thin as it warms")
    example = {
        "load": "60 kN",
        "outer_diameter": "100 mm",
        "recess_diameter": "57 mm",
        "supply_pressure": "20 MPa",
        "restrictor_diameter": "0.7 mm",
        "capillary_length": "80 mm",
        "dynamic_viscosity": "80 mPa*s",
        "density": "875 kg/m**3",
        "speed": "1000 rpm",
    }
    main_results = ("load", "recess_pressure", "film_thickness", "total_power", "flow", "temperature_rise")
    criteria = {
        "film": {
            "require": "film_thickness >= smallest_permissible_film",
            "words": "the film is not thinner than the smallest permissible one",
            "limits": {
                "smallest_permissible_film": {
                    "unit": "um",
                    "words": "smallest film that the bearing may have",
                }
            },
        },
        "film_exists": film_exists("film_thickness"),
        "stiffness": {
            "require": "stiffness >= smallest_stiffness",
            "words": "the pad is as stiff as its user wants it",
            "limits": {
                "smallest_stiffness": {"unit": "N/um", "words": "smallest stiffness that its user permits"}
            },
        },
        "temperature_rise": {
            "require": "temperature_rise <= permissible_temperature_rise",
            "words": "the oil grows no warmer on its way than its user permits",
            "limits": {
                "permissible_temperature_rise": {
                    "unit": "delta_degC",
                    "words": "largest temperature rise from supply to edge",
                }
            },
        },
        "warm_oil": {
            "require": "temperature_rise <= 60 K",
            "words": "oil supplied at 40 degC leaves at 100 degC at most; it is much thinner there",
            "source": "ISO 7902-3, 100 degC as the general limit with pressure feed, as textbooks quote it",
            "unverified": "customary, source not verified: no public copy of ISO 7902-3 was at hand",
            "warning": "oil_too_hot",
        },
    }

    W: Array = given("kN", "load", gt=0)
    D: Array = given("mm", "outer diameter", gt=0)
    D_0: Array = given("mm", "recess diameter", gt=0)
    d_0: Array = given("mm", "recess inner diameter", symbol="d_0", alternative=True, gt=0)
    d: Array = given("mm", "inner diameter", symbol="d", alternative=True, gt=0)
    p_s: Array = given("MPa", "supply pressure", gt=0)
    restrictor: str = choice(*RESTRICTORS, words="restrictor", default=CAPILLARY)
    d_r: Array = given("mm", "restrictor diameter", symbol="d_r", alternative=True, gt=0)
    l_c: Array = given("mm", "capillary length", symbol="l_c", alternative=True, gt=0)
    C_d: Array = given("1", "discharge coefficient", symbol="C_d", default=0.6, gt=0, le=1)
    Q_p: Array = given("l/min", "pump flow", symbol="Q_p", alternative=True, gt=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)
    rho: Array = given("kg/m**3", "density", default="875 kg/m**3", gt=0)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0)
    omega: Array = given("rpm", "speed", optional=True, ge=0)

    @require("recess_diameter", "outer_diameter", remedy="the outer land lies between them")
    def outer_land(self) -> Truth:
        """The recess is smaller than the pad."""
        return self.D_0 < self.D

    @require("recess_inner_diameter", "inner_diameter", missing=True,
             remedy="give both for an annular pad, or neither for a circular one")  # fmt: skip
    def both_or_neither(self) -> Truth:
        """An annular pad has two inner diameters."""
        return np.isnan(self.d_0) == np.isnan(self.d)

    @require("inner_diameter", "recess_inner_diameter", remedy="the inner land lies between them")
    def inner_land(self) -> Truth:
        """The inner diameter of the recess is larger than that of the pad."""
        return (self.d < self.d_0) | np.isnan(self.d)

    @require("recess_inner_diameter", "recess_diameter", remedy="the recess lies between them")
    def recess_is_open(self) -> Truth:
        """The recess has a positive width."""
        return (self.d_0 < self.D_0) | np.isnan(self.d_0)

    @require("restrictor_diameter", missing=True, remedy="give it, or choose `constant_flow`")
    def restrictor_is_known(self) -> Truth:
        """A capillary or an orifice has a diameter."""
        return (self.restrictor == CONSTANT_FLOW) | ~np.isnan(self.d_r)

    @require("capillary_length", missing=True, remedy="give it, or take another restrictor")
    def capillary_is_known(self) -> Truth:
        """A capillary has a length."""
        return (self.restrictor != CAPILLARY) | ~np.isnan(self.l_c)

    @require("pump_flow", missing=True, remedy="give it, or take another restrictor")
    def pump_is_known(self) -> Truth:
        """A constant-flow pump has a given flow."""
        return (self.restrictor != CONSTANT_FLOW) | ~np.isnan(self.Q_p)

    @require("capillary_length", warning="unused_input", remedy="omit it, or choose `capillary`")
    def capillary_counts(self) -> Truth:
        """Only a capillary has a length; an orifice or a constant flow has none."""
        return (self.restrictor == CAPILLARY) | np.isnan(self.l_c)

    @require("restrictor_diameter", warning="unused_input", remedy="omit it, or choose another restrictor")
    def restrictor_counts(self) -> Truth:
        """A constant flow needs no restrictor."""
        return (self.restrictor != CONSTANT_FLOW) | np.isnan(self.d_r)

    @require("pump_flow", warning="unused_input", remedy="omit it, or choose `constant_flow`")
    def pump_counts(self) -> Truth:
        """The pump's flow is used only for constant flow."""
        return (self.restrictor == CONSTANT_FLOW) | np.isnan(self.Q_p)

    @formula("cm**2", "effective area", symbol="A_e", gt=0, source=HAMROCK)
    def A_e(self) -> Array:
        return effective_area(self.D, self.D_0, self.d_0, self.d)

    @formula("1", "land conductance", symbol="q", gt=0, source=HAMROCK)
    def q(self) -> Array:
        return land_conductance(self.D, self.D_0, self.d_0, self.d)

    @formula("MPa", "recess pressure", symbol="p_r", source=HAMROCK)
    def p_r(self) -> Array:
        return self.W / self.A_e

    @formula("kN", "load capacity", symbol=r"W_\mathrm{max}")
    def W_max(self) -> Array:
        return self.p_s * self.A_e

    @formula("1", "pressure ratio", symbol=r"\beta", gt=0, lt=1,
             remedy="the supply does not lift this load; take more pressure or a larger pad")  # fmt: skip
    def beta(self) -> Array:
        return self.p_r / self.p_s

    @formula("l/min", "flow", symbol="Q", gt=0, source=HAMROCK)
    def Q(self) -> Array:
        return restrictor_flow(
            self.restrictor, self.p_s * (1 - self.beta), self.d_r, self.l_c, self.C_d, self.eta, self.rho,
            self.Q_p,
        )  # fmt: skip

    @formula("um", "film thickness", symbol="h", gt=0, source=HAMROCK)
    def h(self) -> Array:
        return (self.eta * self.Q / (self.q * self.p_r)) ** (1 / 3)

    @formula("N/um", "stiffness", symbol="S")
    def S(self) -> Array:
        return stiffness_factor(self.restrictor, self.beta) * self.W / self.h

    @formula("1", "stiffest pressure ratio", symbol=r"\beta_S", absent=NEVER_STIFFEST)
    def beta_S(self) -> Array:
        return stiffest_ratio(self.restrictor)

    @formula("W", "pumping power", symbol="P_p")
    def P_p(self) -> Array:
        return pump_pressure(self.restrictor, self.p_s, self.p_r) * self.Q

    @formula("W", "land power", symbol="P_l", source=RIPPEL)
    def P_l(self) -> Array:
        return self.p_r * self.Q

    @formula("W", "friction power", symbol="P_f")
    def P_f(self) -> Array:
        return self.eta * self.omega**2 * polar_moment_of_lands(self.D, self.D_0, self.d_0, self.d) / self.h

    @formula("N*m", "friction torque", symbol="T_f")
    def T_f(self) -> Array:
        return self.eta * self.omega * polar_moment_of_lands(self.D, self.D_0, self.d_0, self.d) / self.h

    @formula("W", "total power", symbol="P")
    def P(self) -> Array:
        return self.P_p + self.P_f

    @formula("delta_degC", "temperature rise", symbol=r"\Delta T")
    def dT(self) -> Array:
        return self.P / (self.rho_c * self.Q)

    @formula("1", "power ratio", symbol="K", gt=0, absent=AT_REST)
    def K(self) -> Array:
        return power_ratio(self.P_f, self.P_p)

    @formula("um", "film of least power", symbol="h_P", absent=AT_REST)
    def h_P(self) -> Array:
        return self.h * (self.K / 3) ** (1 / 4)

    @formula("mPa*s", "viscosity of least power", symbol=r"\eta_P", absent=AT_REST)
    def eta_P(self) -> Array:
        return self.eta * (1 / self.K) ** (1 / 2)

    @formula("cm**2", "pad area", symbol="A", gt=0)
    def A(self) -> Array:
        return pad_area(self.D, self.d)

    @formula("1", "load coefficient", symbol="a_b", source=RIPPEL)
    def a_b(self) -> Array:
        return self.A_e / self.A

    @formula("1", "flow coefficient", symbol="q_b", source=RIPPEL)
    def q_b(self) -> Array:
        return self.q / self.a_b

    @formula("1", "power coefficient", symbol="H_b", source=RIPPEL)
    def H_b(self) -> Array:
        return self.q_b / self.a_b

    @formula("1", "land Reynolds number", symbol=r"\mathrm{Re}", published=(None, 1000),
             remedy="beyond it the flow is no longer laminar")  # fmt: skip
    def Re(self) -> Array:
        return self.rho * self.Q / (np.pi * self.D_0 * self.eta)

    @formula("1", "capillary Reynolds number", symbol=r"\mathrm{Re}_c", published=(None, 2300),
             absent="there is no capillary", remedy="beyond it the flow is no longer laminar")  # fmt: skip
    def Re_c(self) -> Array:
        return capillary_Reynolds_number(self.restrictor, self.rho, self.Q, self.d_r, self.eta)
