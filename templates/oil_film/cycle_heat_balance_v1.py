"""Heat balance of a journal bearing's film over an engine cycle: its effective viscosity and what follows.

Loss and side flow of the film over the cycle, the flow that the supply pressure drives, and the temperature
of the supply give one viscosity; the orbit and the smallest film are those of that viscosity.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
    Truth,
    choice,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.oil import Oil
from templates.physics.heat.cycle_heat import (
    LEVELS,
    CycleBearing,
    CycleHeat,
    CycleOil,
    cycle_heat,
    feed_flow_of,
    groove_alone,
    left_by_HTHS,
    loss_of,
    rate_of,
    side_flow_of,
    temperature_of,
    viscosity_at_150,
    viscosity_of,
    warmed_duty,
)
from templates.physics.journals.oil import by_law
from templates.physics.numerics.arrays import spread
from templates.physics.orbits.cyclic_film import (
    CycleFilm,
    Duty,
    cycle_length,
    largest_load,
    mean_speed,
)
from templates.physics.supplied.fed_cycle import FedDuty, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.feeding import Feeding, is_back, within_bearing

BOOKER = "Booker 1965"
CROSS = "Cross 1965"
ISO = "ISO 7902-1:1998"
NO_HTHS = "no HTHS viscosity is given: the oil does not thin by shear"
NO_GROOVE = "no groove is given"
CYCLE = "crank_angle"
UNBALANCED = (
    "no viscosity was found at which heat and viscosity agree: give more supply pressure or clearance, "
    "cooler or thicker oil, or less load; without side flow nothing carries the heat off"
)


class CycleHeatBalance(Oil):
    """Heat balance of a journal bearing's film over an engine cycle: its effective viscosity.

    Loss and side flow of the film over the cycle, the flow that the supply pressure drives, and the
    temperature of the supply give one viscosity; the orbit and the smallest film are those of it.

    Limits
    ------
    One temperature and one viscosity for the whole film and cycle, at the mean of supply and outlet, as ISO
    7902-1 has it for a steady load. Nothing is stored in the walls, and what they carry off is the share of
    the loss that heat_share leaves. The film is that of oil_film_cycle 2 at the same level: massless journal,
    rigid, aligned, laminar; see there for load sense, angles and axes.
    Side flow is what the motion of the journal displaces from the ends. Feed flow is what the supply
    pressure drives from the groove over its two lands, with the gap along the orbit; the film's pressure does
    not hinder it, as in the standard. The ends of a groove that does not go around let out oil besides, and
    holes do: both are left out, which errs to the hot side.
    Levels mobility_short and mobility do not know the groove in their film, but count its flow.
    Shear thinning after Cross needs the HTHS viscosity of the oil (150 °C, 1e6 1/s). The shear rate is |U|/h,
    as mean over the circle and the cycle. What endless shear leaves, by default half, and the exponent, by
    default 1, are properties of the oil for which no general source is known. The critical rate is taken from
    150 °C to the film's temperature by the ratio of the viscosities.
    A dynamic_viscosity that is given is that of the film; heat and shear do not change it.
    Densities and viscosities are those at ambient pressure.
    No error of the model is stated: no measured cycle with all its inputs was at hand.

    References
    ----------
    ISO 7902-1:1998, clause 6.4, for the balance.
    Booker: Journal of Basic Engineering 87, 1965, for the mobility method.
    Cross: Journal of Colloid Science 20, 1965, p. 417; ASTM D4683 and SAE J300 for HTHS.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, for the viscosity.
    """

    levels = LEVELS
    default_level = "mobility"
    most_points = {"mobility_short": 2000, "mobility": 500, "mobility_grooved": 500}
    precision = 1e-6
    example = {
        "crank_angle": {"value": list(range(0, 720, 30)), "unit": "deg"},
        "load_x": {
            "value": [
                -8.5, -14.4, -13.3, -9.9, -6.9, -5.0, -3.6, -2.2, -0.6, 1.1, 2.5, 3.4,
                3.7, 3.4, 2.5, 1.1, -0.6, -2.2, -3.4, -4.0, -4.3, -4.4, -4.5, -5.6,
            ],
            "unit": "kN",
        },
        "load_y": {
            "value": [
                0.0, 1.9, 2.9, 3.0, 2.5, 2.1, 1.9, 1.8, 1.7, 1.4, 1.0, 0.5,
                0.0, -0.5, -1.0, -1.4, -1.7, -1.8, -1.8, -1.6, -1.3, -0.9, -0.5, -0.2,
            ],
            "unit": "kN",
        },
        "speed": "3000 rpm",
        "bearing_diameter": "48 mm",
        "bearing_width": "18 mm",
        "diametral_clearance": "0.055 mm",
        "groove_width": "3 mm",
        "groove_start": "-90 deg",
        "groove_extent": "180 deg",
        "supply_pressure": "4 bar",
        "supply_temperature": "90 degC",
        "hths_viscosity": "3.5 mPa*s",
    }  # fmt: skip
    criteria = {
        "film_exists": {
            "require": "minimum_film_thickness >= 0.05 um",
            "words": "the film is not thinner than the finest surfaces are rough",
            "source": "ISO 1302:1992, grade N2: Ra 0.05 um, lapped or superfinished",
            "warning": "film_too_thin",
        },
        "own_film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film of the cycle is not thinner than its user permits",
            "limits": {"permissible_film": {"unit": "um", "words": "smallest film that its user permits"}},
        },
        "temperature": {
            "require": "film_temperature <= permissible_temperature",
            "words": "the film is no hotter than the bearing material bears",
            "limits": {
                "permissible_temperature": {
                    "unit": "degC",
                    "words": "largest temperature that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "temperature_rise": {
            "require": "temperature_rise <= permissible_temperature_rise",
            "words": "the oil grows no warmer on its way than its user permits",
            "limits": {
                "permissible_temperature_rise": {
                    "unit": "K",
                    "words": "largest temperature rise from supply to outlet",
                }
            },
        },
    }

    theta: Array = curve("deg", "crank angle", symbol=r"\theta", ge=-720, le=1440)
    F_x: Array = curve("N", "load x")
    F_y: Array = curve("N", "load y")
    sense: str = choice(
        "journal_on_sleeve", "sleeve_on_journal", words="load sense", default="journal_on_sleeve"
    )
    omega_J: Array = curve("rpm", "speed", constant=True, also=("journal speed",))
    omega_B: Array = curve("rpm", "sleeve speed", constant=True, default="0 rpm")
    omega_F: Array = curve("rpm", "frame speed", constant=True, default="0 rpm")
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    c: Array = given("mm", "diametral clearance", gt=0)
    W_g: Array = given("mm", "groove width", symbol="B_{g}", alternative=True, gt=0)
    phi_g: Array = given("deg", "groove start", symbol=r"\varphi_{g}", default="0 deg", ge=-360, le=360)
    ext_g: Array = given("deg", "groove extent", symbol=r"\Delta\varphi_{g}", default="360 deg", gt=0, le=360)
    p_s: Array = given("bar", "supply pressure", alternative=True, gt=0)
    T_s: Array = given("degC", "supply temperature", symbol="T_{s}", ge=-100, le=400)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0, source=ISO)
    k: Array = given("1", "heat share", default="1", ge=0, le=1)
    eta_H: Array = given("mPa*s", "HTHS viscosity", symbol=r"\eta_\mathrm{HTHS}", name="hths_viscosity",
                         alternative=True, gt=0)  # fmt: skip
    r_inf: Array = given("1", "endless shear ratio", symbol=r"r_{\infty}", default="0.5", ge=0, lt=1)
    n: Array = given("1", "Cross exponent", default="1", gt=0, le=3, source=CROSS)

    @derived("rpm", "crank speed", symbol=r"\Omega", gt=0, remedy="give it where the journal does not turn")
    def Omega(self) -> Array:
        """The mean speed of the journal."""
        return mean_speed(self.omega_J)

    @require("crank_angle", remedy="12 to 3600 angles, the last point not repeated, no gap in between")
    def one_cycle(self) -> Truth:
        """The crank angles rise and cover one cycle of 360° or 720° once."""
        return bool(np.isfinite(self.period))

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @require("groove_width", "bearing_width", remedy="give the groove's width in mm, across the bearing")
    def groove_within_bearing(self) -> Truth:
        """The groove takes at most 95 % of the bearing's width."""
        return within_bearing(self.W_g, self.W, self.W_g, self.D)

    @require("supply_pressure", missing=True, remedy="give the pressure above ambient, such as 4 bar")
    def fed_under_pressure(self) -> Truth:
        """The supply pressure is known where a groove feeds oil."""
        return np.isfinite(self.p_s) | np.isnan(self.W_g)

    @require("sleeve_speed", "frame_speed", remedy="let it rest in the frame, or give a groove of 360 deg")
    def sleeve_comes_back(self) -> Truth:
        """A sleeve with a groove that ends is back at its place in the frame after the cycle."""
        return is_back(self.duty, self.omega_B, self.feeding.partial())

    @require("supply_pressure", warning="unused_input", remedy="give groove_width, or leave it out")
    def pressure_counts(self) -> Truth:
        """The supply pressure drives oil from a groove."""
        return np.isnan(self.p_s) | np.isfinite(self.W_g)

    @require("hths_viscosity", warning="unused_input", remedy="leave it out, or dynamic_viscosity")
    def viscosity_follows(self) -> Truth:
        """Shear thins the oil where its viscosity is not given."""
        return np.isnan(self.as_given("eta")) | np.isnan(self.eta_H)

    def ladder(self) -> tuple[str, ...]:
        """The levels that know how the bearing is fed."""
        return ("mobility_grooved",) if np.any(np.isfinite(self.W_g)) else ("mobility_short", "mobility")

    def starting_level(self) -> str:
        """The level that knows the groove, if there is one."""
        return self.ladder()[-1]

    @shared
    def period(self) -> Array:
        """The cycle [rad]; NaN where the angles are none."""
        return cycle_length(self.theta)

    @formula("1", "relative clearance", symbol=r"\psi")
    def psi(self) -> Array:
        return self.c / self.D

    @formula(
        "1", "width ratio", symbol="b", ge=0.02, le=10, remedy="level mobility_short takes 0.01 … 100",
        per_level={"mobility_short": limits(0.01, 100, published=(None, 0.25))},
    )  # fmt: skip
    def b(self) -> Array:
        return self.W / self.D

    @formula(
        "1", "land ratio", symbol="b_{g}", ge=0, absent=NO_GROOVE,
        remedy="each land beside the groove has at least 2 % of the diameter: give a narrower groove_width",
        per_level={"mobility_grooved": limits(0.02, 5)},
    )  # fmt: skip
    def b_g(self) -> Array:
        return (self.W - self.W_g) / (2 * self.D)

    @formula("N", "largest load", symbol="F_{max}")
    def F_max(self) -> Array:
        return largest_load(self.F_x, self.F_y)

    @shared
    def feeding(self) -> Feeding:
        """The groove."""
        return groove_alone(self.D, self.W, self.W_g, self.phi_g, self.ext_g)

    @formula("s/m**2", "load scale", symbol="s")
    def s(self) -> Array:
        """The load number over load and fluidity."""
        return self.psi**2 / (self.D * self.W * self.Omega)

    @shared
    def duty(self) -> Duty:
        """What the bearing has to do, with oil of 1 Pa s."""
        sign = 1.0 if self.sense == "journal_on_sleeve" else -1.0
        return Duty(
            self.theta, sign * self.F_x, sign * self.F_y, self.omega_J, self.omega_B, self.omega_F,
            self.Omega, self.s, self.b,
        )  # fmt: skip

    @shared
    def eta_given(self) -> Array:
        """The viscosity of the film, if it is given."""
        return self.as_given("eta")

    @formula("mPa*s", "low shear viscosity hot", symbol=r"\eta_{150}")
    def eta_150(self) -> Array:
        """At low shear and 150 °C, the temperature of the HTHS viscosity."""
        return viscosity_at_150(
            self.law, self.A, self.B, self.a_V, self.b_V, self.c_V, self.eta_given, self.rho_ref,
            self.T_ref,
        )  # fmt: skip

    @formula(
        "1", "HTHS ratio", symbol="x", name="hths_ratio", ge=1e-6, le=1 - 1e-6, absent=NO_HTHS,
        source=CROSS, remedy="HTHS lies between the viscosities at low and at endless shear at 150 °C",
    )  # fmt: skip
    def hths_ratio(self) -> Array:
        """What shear of 1e6 1/s leaves of what it can take."""
        return left_by_HTHS(self.eta_H, self.eta_150, self.r_inf, self.eta_given)

    @shared
    def oil(self) -> CycleOil:
        """The oil and what it carries off."""
        return CycleOil(
            A=self.A, B=self.B, a=by_law(self.law, np.nan, self.a_V), b=self.b_V, offset=self.c_V,
            eta=self.as_given("eta"), rho_ref=self.rho_ref, T_ref=self.T_ref, left=self.hths_ratio,
            endless=self.r_inf, exponent=self.n, supply=self.T_s, heat_capacity=self.rho_c, share=self.k,
        )  # fmt: skip

    @shared
    def heat(self) -> CycleHeat:
        """The balance."""
        return cycle_heat(CycleBearing(self.level, self.duty, self.feeding, self.p_s, self.c / 2), self.oil)

    @formula(
        "mPa*s", "effective viscosity", symbol=r"\eta_{e}", gt=0, lt=1e9, remedy=UNBALANCED,
        assumes=("b", "b_g"),
    )  # fmt: skip
    def eta_e(self) -> Array:
        """Of the whole film, at its temperature and shear rate."""
        return viscosity_of(self.heat)

    @formula("degC", "film temperature", symbol="T")
    def T_film(self) -> Array:
        """The mean of supply and outlet."""
        return temperature_of(self.heat, self.eta_e)

    @formula("degC", "outlet temperature", symbol="T_{ex}", source=ISO)
    def T_ex(self) -> Array:
        return 2 * self.T_film - self.T_s

    @formula("K", "temperature rise", symbol=r"\Delta T", source=ISO)
    def rise(self) -> Array:
        """From supply to outlet."""
        return self.T_ex - self.T_s

    @formula("1/s", "mean shear rate", symbol=r"\dot\gamma")
    def rate(self) -> Array:
        """Sliding speed over gap, as mean over circle and cycle."""
        return rate_of(self.heat, self.eta_e)

    @formula("1", "shear loss", symbol=r"\delta_{\gamma}", source=CROSS)
    def shear_loss(self) -> Array:
        """The share of the viscosity that shear takes."""
        return 1 - self.eta_e / self.eta

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        """Mean over the cycle."""
        return loss_of(self.heat, self.eta_e)

    @formula("l/min", "side flow", symbol="Q")
    def Q(self) -> Array:
        """What the motion of the journal displaces."""
        return side_flow_of(self.heat, self.eta_e)

    @formula("l/min", "feed flow", symbol="Q_{p}", source=ISO)
    def Q_p(self) -> Array:
        """What the supply pressure drives from the groove."""
        return feed_flow_of(self.heat, self.eta_e)

    @shared
    def fed(self) -> FedDuty:
        """The duty at the effective viscosity."""
        return warmed_duty(self.duty, self.feeding, self.eta_e)

    @shared
    def orbit(self) -> FedOrbit:
        """The orbit at the effective viscosity."""
        return fed_orbit(self.level, self.fed)

    @shared
    def film(self) -> CycleFilm:
        """Its pressure."""
        return fed_film(self.level, self.fed, self.orbit)

    @formula("1", "maximum eccentricity", symbol=r"\epsilon_{max}", lt=1, source=BOOKER)
    def eps_max(self) -> Array:
        return self.orbit.eps_max

    @formula("um", "minimum film thickness", symbol="h_{0}", source=BOOKER)
    def h_0(self) -> Array:
        return self.c * (1 - self.eps_max) / 2

    @formula("deg", "minimum film angle", symbol=r"\theta_{h}")
    def theta_h(self) -> Array:
        return self.orbit.angle

    @profile("um", "film thickness", along=CYCLE, symbol="h", latex=r"\frac{c}{2}\left(1-\epsilon\right)")
    def h(self) -> Array:
        return spread(self.c / 2, self.orbit.gap)

    @formula("MPa", "maximum pressure", symbol="p_{max}")
    def p_max(self) -> Array:
        return self.film.P_max * self.eta_e * self.Omega / self.psi**2
