"""Oil film of a journal bearing under static load, with a temperature field in the film.

Dowson's generalised Reynolds equation is solved with the energy equation; a solution with one temperature is
given for comparison.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, formula, given, profile, require, shared
from templates.groups.film_assumptions import PARALLEL, RIGID, SMOOTH
from templates.groups.film_criteria import film_exists, hot_oil, temperature
from templates.groups.oil import Oil
from templates.physics.journals.lubrication_regime import friction_coefficient
from templates.physics.journals.oil import by_law
from templates.physics.thermal.thermal_case import ThermalCase, warm_viscosity
from templates.physics.thermal.thermal_journal import (
    LEVELS,
    ONE,
    WarmFilm,
    bush_angles,
    in_kelvin,
    warm_film,
)

ISO = "ISO 7902-1:1998"
DOWSON = "Dowson 1962"
AROUND = "bush_angle"
ONE_HAS_NONE = "level `one_temperature` has none; choose level `field` or `fine_field`"
UNBORNE = (
    "no film thicker than 1 % of the clearance was found that bears the load and sheds its heat below "
    "500 degC: change load, clearance, width or speed, the oil, its supply, the bush's cooling, or the "
    "groove's place"
)


class ThermalFilm(Oil, Template):
    """Oil film of a journal bearing under static load, with a temperature field in the film.

    Dowson's generalised Reynolds equation is solved with the energy equation; a solution with one temperature
    is given for comparison. The bore is plain, with one axial groove, in which fresh and recirculating oil
    mix.

    Limits
    ------
    Steady: load, bush and groove are stationary. Rigid, aligned, laminar; no shear thinning, constant density
    and heat capacity. The temperature is constant across the width, where measured temperatures differ
    little; the energy equation is solved for its mean, so that heat and power balance.
    Level one_temperature, the default, is the heat balance of ISO 7902-1 with the film of oil_film's level
    map, fed along its widest gap: groove, supply pressure, carry_over, oil_conductivity and given wall
    temperatures are ignored. Its largest temperatures are those of the outlet.
    Levels field and fine_field have 48 x 8 x 12 and 96 x 16 x 24 intervals (circumference, half width, across
    the film); on 15 bearings they differed by at most 0.34 % of the film and 0.3 K. mesh_error and
    mesh_change compare with half as many intervals, an estimate. The following points apply to these levels.
    The film ruptures and re-forms as mass conservation requires. In a cavity the oil flows in streamers;
    shear, heat and contact with the walls are reduced to their share of the width. The groove is full at the
    supply pressure, which falls linearly over the lands at its ends; leakage there and shear in the groove
    are neglected. Arriving oil mixes completely with fresh oil; carry_over is the fraction of arriving oil
    that flows on.
    The bush is adiabatic, or cooled from behind (heat_transfer_coefficient), or at a given temperature. There
    is no circumferential conduction in it. The journal has one temperature: that without net heat flow, or a
    given one.
    Thermal expansion of journal and bush is neglected: give the clearance when warm (thermal_clearance).
    For comparison, a film with one temperature is calculated: the mean of supply and outlet from the balance
    of ISO 7902-1, with the groove and the film of the same mesh; cooling by air behind the bush is included,
    a given bush temperature is not.
    A film thinner than 1 % of the clearance is refused. So is one without a heat balance below 500 degC: at
    light load hardly any oil leaves, and an adiabatic bearing becomes hot.
    A point takes about 0.5 s of processor time at level field and 0.9 s at fine_field, 1.2 s at most.
    No error of the model is stated: no measured case with all its inputs was available.

    References
    ----------
    Dowson: International Journal of Mechanical Sciences 4, 1962, p. 159, for the film.
    Dowson, Hudson, Hunter, March: Proc. IMechE 181 (3O), 1966, for the temperatures of bush and journal.
    Ferron, Frêne, Boncompain: Journal of Lubrication Technology 105, 1983, p. 422, for the bearing's kind.
    Elrod: Journal of Lubrication Technology 103, 1981, p. 350, for the cavities.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, for the viscosity.
    """

    assumptions = (RIGID, PARALLEL, SMOOTH)
    levels = LEVELS
    default_level = ONE
    most_points = {"field": 40, "fine_field": 15}
    precision = 1e-5
    example = {
        "radial_load": "6 kN",
        "diametral_clearance": "0.29 mm",
        "bearing_diameter": "100 mm",
        "bearing_width": "80 mm",
        "speed": "3000 rpm",
        "oil_grade": "iso_vg_32",
        "supply_temperature": "40 degC",
        "groove_width": "18 deg",
        "supply_pressure": "0.7 bar",
        "heat_transfer_coefficient": "80 W/(m**2*K)",
        "ambient_temperature": "40 degC",
    }
    main_results = (
        "radial_load", "speed", "maximum_pressure", "minimum_film_thickness", "power_loss",
        "total_oil_flow", "greatest_film_temperature",
    )  # fmt: skip
    criteria = {
        "film_exists": film_exists(),
        "own_film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film is not thinner than its user permits",
            "limits": {"permissible_film": {"unit": "um", "words": "smallest film that its user permits"}},
        },
        "pressure": {
            "require": "maximum_pressure <= permissible_pressure",
            "words": "the pressure of the film is within what the bearing material bears",
            "limits": {
                "permissible_pressure": {
                    "unit": "MPa",
                    "words": "largest pressure of the film that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "temperature": temperature(
            "greatest_bush_temperature", "the bush is no hotter than its material bears"
        ),
        "oil_temperature": {
            "require": "greatest_film_temperature <= permissible_oil_temperature",
            "words": "the film is nowhere hotter than the oil bears",
            "limits": {
                "permissible_oil_temperature": {
                    "unit": "degC",
                    "words": "largest temperature that the oil bears, by its supplier",
                }
            },
        },
        "hot_oil": hot_oil("outlet_temperature"),
        "laminar": {
            "require": "film_reynolds_number <= laminar_limit",
            "words": "the flow in the film is laminar",
            "source": ISO,
            "warning": "turbulent_flow",
        },
    }

    F: Array = given("N", "radial load", gt=0, also=("bearing load", "load"))
    c: Array = given("mm", "diametral clearance", gt=0)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    omega: Array = given("rpm", "speed", symbol=r"\omega", gt=0, also=("journal speed",))
    T_film: Array = given("degC", "supply temperature", symbol="T_{s}", ge=-50, le=300)
    p_s: Array = given("bar", "supply pressure", default="1 bar", ge=0,
                       assumed="the groove is fed with 1 bar")  # fmt: skip
    phi_g: Array = given("deg", "groove angle", symbol=r"\varphi_{g}", default="180 deg", ge=-360, le=360)
    ext_g: Array = given("deg", "groove width", symbol=r"\Delta\varphi_{g}", default="20 deg", ge=2, le=90)
    l_g: Array = given("1", "groove length ratio", symbol="l_{g}", default="0.8", ge=0.2, le=0.95)
    kappa: Array = given("1", "carry over", symbol=r"\kappa", default="1", ge=0, le=1)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0, source=ISO)
    k_o: Array = given("W/(m*K)", "oil conductivity", symbol="k", default="0.13 W/(m*K)", gt=0)
    T_b: Array = given("degC", "held bush temperature", symbol="T_{b}", alternative=True, ge=-50, le=400)
    h_b: Array = given("W/(m**2*K)", "heat transfer coefficient", symbol="h_{b}", alternative=True, ge=0)
    T_amb: Array = given("degC", "ambient temperature", alternative=True, ge=-50, le=400)
    T_j: Array = given("degC", "held journal temperature", symbol="T_{j}", alternative=True, ge=-50, le=400)

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is at most a hundredth of the bearing diameter."""
        return self.c <= self.D / 100

    @require("heat_transfer_coefficient", "ambient_temperature", missing=True, remedy="give both, or neither")
    def cooling_is_whole(self) -> Truth:
        """A bush that is cooled from behind has a heat transfer coefficient and a coolant temperature."""
        return np.isnan(self.h_b) == np.isnan(self.T_amb)

    @require("held_bush_temperature", "heat_transfer_coefficient", remedy="omit one of them")
    def one_bush(self) -> Truth:
        """The bush is either at a given temperature or cooled from behind."""
        return np.isnan(self.T_b) | np.isnan(self.h_b)

    @formula("1", "relative clearance", symbol=r"\psi", source=ISO)
    def psi(self) -> Array:
        """Clearance relative to the diameter of the bore."""
        return self.c / self.D

    @formula(
        "1", "width ratio", ge=0.05, le=10, remedy="take a bearing between 0.05 and 10 as wide as its bore"
    )
    def b(self) -> Array:
        """Width over diameter."""
        return self.W / self.D

    @formula("1", "Sommerfeld number", symbol="S_{0}", source=ISO)
    def S_0(self) -> Array:
        """Sommerfeld number based on the viscosity of the supply."""
        return self.F * self.psi**2 / (self.D * self.W * self.eta * self.omega)

    @formula("MPa", "pressure scale", symbol="p_{0}")
    def p_0(self) -> Array:
        """The unit of the film's dimensionless pressure."""
        return self.eta * self.omega / self.psi**2

    @formula("l/min", "flow scale", symbol="q_{0}")
    def q_0(self) -> Array:
        """Flow that would result if all oil in the clearance moved with the journal."""
        return self.omega * self.psi * self.D**2 * self.W / 4

    @formula("W/K", "heat scale", symbol="C_{0}")
    def C_0(self) -> Array:
        """Heat that this flow transports per kelvin."""
        return self.rho_c * self.q_0

    @shared
    def eta_given(self) -> Array:
        """Return the viscosity, if it is given and therefore does not depend on the temperature."""
        return self.as_given("eta")

    @shared
    def case(self) -> ThermalCase:
        """Return the bearing and its oil."""
        return ThermalCase(
            F=self.F, D=self.D, W=self.b * self.D, psi=self.psi, omega=self.omega, pressure=self.p_s,
            angle=self.phi_g, extent=self.ext_g, length=self.l_g, carry_over=self.kappa, supply=self.T_film,
            heat_capacity=self.rho_c, conductivity=self.k_o, held=self.T_b, transfer=self.h_b,
            ambient=self.T_amb, journal=self.T_j, A=self.A, B=self.B, a=by_law(self.law, np.nan, self.a_V),
            b=self.b_V, offset=self.c_V, eta=self.eta_given, rho_ref=self.rho_ref, T_ref=self.T_ref,
        )  # fmt: skip

    @shared
    def anywhere(self) -> WarmFilm:
        """Return the film, before its thickness is checked."""
        return warm_film(self.level, self.case)

    @formula("1", "relative eccentricity", ge=0, le=0.99, assumes=("b", "eta"), source=DOWSON, remedy=UNBORNE)
    def eps(self) -> Array:
        return self.anywhere.eps

    @shared
    def film(self) -> WarmFilm:
        """Return the film, if a film exists."""
        return self.anywhere.admitted(self.eps)

    @formula("um", "minimum film thickness", symbol="h_{0}")
    def h_0(self) -> Array:
        return self.c * (1 - self.eps) / 2

    @formula("1", "mesh error", symbol="e_{h}", absent=ONE_HAS_NONE)
    def mesh_error(self) -> Array:
        """Change of the smallest film from a mesh half as fine."""
        return self.film.mesh_error

    @formula("deg", "attitude angle", symbol=r"\beta")
    def beta(self) -> Array:
        """Angle from the load to the narrowest gap, in the sense of rotation."""
        return self.film.attitude

    @formula("MPa", "maximum pressure", symbol="p_{max}")
    def p_max(self) -> Array:
        return self.film.P_max * self.p_0

    @formula("degC", "greatest film temperature", symbol="T_{max}")
    def T_max(self) -> Array:
        """Largest temperature in the oil or at the surface of the bush."""
        return in_kelvin(self.film.T_max)

    @formula("delta_degC", "mesh change", symbol="e_{T}", absent=ONE_HAS_NONE)
    def mesh_change(self) -> Array:
        """Change of the largest temperature from a mesh half as fine."""
        return in_kelvin(self.film.mesh_change)

    @profile("deg", "bush angle", along=AROUND, symbol=r"\theta", latex=r"k\,5°")
    def theta(self) -> Array:
        """Angle from the load, in the sense of rotation."""
        return bush_angles(self.eps)

    @profile(
        "degC", "bush temperature", along=AROUND, symbol=r"T_{b}\left(\theta\right)", absent=ONE_HAS_NONE
    )
    def T_bush(self) -> Array:
        """Temperature of the bush's surface; in the groove, temperature of the oil."""
        return in_kelvin(self.film.bush)

    @formula("degC", "greatest bush temperature", symbol="T_{b,max}")
    def T_bush_max(self) -> Array:
        return in_kelvin(self.film.bush_max)

    @formula("degC", "journal temperature", symbol="T_{J}", absent=ONE_HAS_NONE)
    def T_J(self) -> Array:
        """Temperature at which no net heat flows into the journal, or the given temperature."""
        return in_kelvin(self.film.T_journal)

    @formula("degC", "groove temperature", symbol="T_{g}", absent=ONE_HAS_NONE)
    def T_g(self) -> Array:
        """Temperature of the mixture of fresh oil and recirculating oil."""
        return in_kelvin(self.film.T_groove)

    @formula("degC", "outlet temperature", symbol="T_{e}")
    def T_e(self) -> Array:
        """Mean temperature of the oil that leaves at the ends."""
        return in_kelvin(self.film.T_side)

    @formula("N*m", "friction torque", symbol="M_{f}")
    def M_f(self) -> Array:
        """Friction torque on the journal, without the groove."""
        return self.film.torque * self.eta * self.omega * self.W * self.D**2 / (4 * self.psi)

    @formula("1", "friction coefficient", symbol="f")
    def f(self) -> Array:
        return friction_coefficient(self.M_f, self.F, self.D)

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M_f * self.omega

    @formula("l/min", "side flow", symbol="Q")
    def Q(self) -> Array:
        return self.film.side * self.q_0

    @formula("l/min", "total oil flow", symbol="Q_{t}")
    def Q_t(self) -> Array:
        """Flow that the supply must deliver: all oil that leaves at the ends."""
        return self.Q

    @formula("W", "heat generated", symbol=r"\Phi")
    def Phi(self) -> Array:
        """Power loss plus the work of the supply pressure."""
        return in_kelvin(self.film.dissipated) * self.C_0

    @formula("W", "heat by oil", symbol=r"\Phi_{o}")
    def Phi_o(self) -> Array:
        """Heat that the outflowing oil removes, relative to the supply temperature."""
        return in_kelvin(self.film.by_oil) * self.C_0

    @formula("W", "heat by bush", symbol=r"\Phi_{b}")
    def Phi_b(self) -> Array:
        return in_kelvin(self.film.by_bush) * self.C_0

    @formula("W", "heat by journal", symbol=r"\Phi_{J}", absent=ONE_HAS_NONE)
    def Phi_J(self) -> Array:
        return in_kelvin(self.film.by_journal) * self.C_0

    @formula("1", "heat residual", symbol="r", absent=ONE_HAS_NONE)
    def residual(self) -> Array:
        """Heat that the balance does not account for, over the heat generated; 0 below 1e-9."""
        return self.film.residual

    @formula("degC", "effective temperature", symbol=r"T_\mathrm{eff}", source=ISO)
    def T_one(self) -> Array:
        """The effective temperature of a heat balance: the mean of supply and outlet."""
        return in_kelvin(self.film.one_T)

    @formula("mPa*s", "effective viscosity", symbol=r"\eta_\mathrm{eff}")
    def eta_one(self) -> Array:
        """Viscosity at the effective temperature."""
        return warm_viscosity(self.case, self.T_one)

    @formula("um", "film of one temperature", symbol="h_{1}", source=ISO, absent=ONE_HAS_NONE)
    def h_one(self) -> Array:
        """Smallest film at the effective temperature."""
        return self.c * (1 - self.film.one_eps) / 2

    @formula("W", "loss of one temperature", symbol="P_{1}", source=ISO, absent=ONE_HAS_NONE)
    def P_one(self) -> Array:
        """Power loss at the effective temperature."""
        return self.film.one_torque * self.eta * self.omega**2 * self.W * self.D**2 / (4 * self.psi)

    @formula("1", "film ratio", symbol="h_{1}/h_{0}", absent=ONE_HAS_NONE)
    def film_ratio(self) -> Array:
        """Film at one temperature over that with a temperature field; a ratio above 1 is unsafe."""
        return self.h_one / self.h_0

    @formula("1", "loss ratio", symbol="P_{1}/P", absent=ONE_HAS_NONE)
    def loss_ratio(self) -> Array:
        """Power loss at one temperature over that with a temperature field."""
        return self.P_one / self.P

    @formula("delta_degC", "unseen rise", symbol=r"\Delta T_{1}")
    def unseen(self) -> Array:
        """Largest excess of the film temperature over the effective temperature."""
        return self.T_max - self.T_one

    @formula("1", "film Reynolds number", symbol=r"\mathrm{Re}", source=ISO)
    def Re(self) -> Array:
        """Reynolds number at the effective temperature."""
        return self.rho * self.omega * self.D * self.c / (4 * self.eta_one)

    @formula("1", "laminar limit", symbol=r"\mathrm{Re}_{cr}", source=ISO)
    def Re_cr(self) -> Array:
        return 41.3 / np.sqrt(self.psi)
