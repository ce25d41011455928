"""Heat balance of a journal bearing's film over an engine cycle: effective viscosity and dependent results.

One effective viscosity follows from the power loss and side flow of the film over the cycle, from the flow
that the supply pressure drives, and from the supply temperature. The orbit and the smallest film are
calculated at that viscosity.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from templates.core.language.template import (
    Array,
    Truth,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.fed_bearing import EXAMPLE, FedBearing
from templates.groups.film_assumptions import FULL, PARALLEL, RIGID, SMOOTH
from templates.groups.film_criteria import film_exists, hot_oil, temperature
from templates.groups.oil import Oil
from templates.physics.heat.cycle_heat import (
    CycleBearing,
    CycleHeat,
    CycleOil,
    all_flow,
    feed_flow_of,
    left_by_HTHS,
    loss_of,
    rate_of,
    shear_loss_of,
    side_flow_of,
    temperature_of,
    viscosity_at_150,
    viscosity_of,
)
from templates.physics.heat.marched_heat import MARCHED_LEVELS, heat_of_cycle
from templates.physics.journals.oil import by_law
from templates.physics.numerics.arrays import spread
from templates.physics.orbits.cyclic_film import CycleFilm, Duty
from templates.physics.supplied.fed_cycle import FedDuty, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.supply_geometry import sleeve_motion, supply_kind

BOOKER = "Booker 1965"
ORBIT = "Booker 1965; supplied: Woloszynski et al. 2015"
CROSS = "Cross 1965"
LAWS = "ASTM D341; Vogel 1921"
ISO = "ISO 7902-1:1998"
NO_HTHS = "no HTHS viscosity is given: the oil does not thin by shear"
BETWEEN = (
    "give an `hths_viscosity` in mPa*s below that at low shear and 150 °C, see `low_shear_viscosity_hot`, "
    "and above `endless_shear_ratio` times that"
)
ALL_OF_IT = "the side flow of level `supplied` is all the oil that leaves, what the supply drives with it"
CYCLE = "crank_angle"
UNBALANCED = (
    "no viscosity was found at which heat and viscosity agree: give more supply pressure or clearance, "
    "cooler or thicker oil, or less load; without side flow nothing carries the heat off. At level "
    "`supplied` a film may starve: see the verdict of `oil_film_cycle` 1"
)


class CycleHeatBalance(Oil, FedBearing):
    """Heat balance of a journal bearing's film over an engine cycle: its effective viscosity.

    One effective viscosity follows from the power loss and side flow of the film over the cycle, from the
    flow that the supply pressure drives, and from the supply temperature. The orbit and the smallest film are
    calculated at that viscosity.

    Limits
    ------
    The whole film has one temperature and one viscosity over the cycle, at the mean of supply and outlet
    temperature, as in ISO 7902-1 for a steady load. The walls store no heat; heat_share is the share of the
    loss that the oil removes, and the walls remove the rest. The film is that of oil_film_cycle 1 at the same
    level (massless journal; rigid, aligned bearing; laminar flow); see there for load sense, angles and axes.
    Side flow is the oil that the motion of the journal displaces from the ends. Feed flow is the oil that the
    supply pressure drives from the groove over its two lands, with the gap along the orbit; the pressure of
    the film does not reduce it, as in the standard. Oil from the ends of a partial groove and from holes is
    neglected. The film is treated as always full, so the calculated flow is larger than the real one.
    Level supplied conserves the oil: its side flow is all the oil that leaves at the ends, and no feed flow
    is added. It needs three or four marches of about a second each, and accepts one point at a time. A film
    that starves or does not converge has no balance. In the example the side flow is half that of level
    mobility_grooved, and the temperature rise is half as large again.
    Levels mobility_short and mobility ignore the groove in their film, but include its feed flow.
    Shear thinning after Cross needs the HTHS viscosity of the oil (150 °C, 1e6 1/s). The shear rate is |U|/h,
    averaged over circumference and cycle. The viscosity ratio at infinite shear rate (default 0.5) and the
    exponent (default 1) are properties of the oil, for which there is no general source. The critical shear
    rate is converted from 150 °C to the film's temperature by the ratio of the low-shear viscosities, as in
    time–temperature superposition.
    Power loss and mean shear rate are those of a full film. At level supplied the loss includes only the
    shear of the oil that is present; the shear rate is unchanged.
    A given dynamic_viscosity is that of the film; heat and shear do not change it.
    Densities and viscosities are those at ambient pressure.
    Level mobility_grooved states errors relative to the balance at level supplied: a one-sided bound from
    random engines of known balance, as a power law of temperature rise, supply pressure, load number and B/D.
    They are null with holes, for which there are fewer than 59 engines; with a groove of less than 120° or of
    240° to 360°; outside the range of the engines; with a given viscosity; and at the other levels. Level
    supplied was not compared with finer meshes. No measured cycle with all its inputs was available.

    References
    ----------
    ISO 7902-1:1998, clause 6.4, for the balance.
    Booker: Journal of Basic Engineering 87, 1965, for the mobility method.
    Woloszynski, Podsiadlo, Stachowiak: Tribology Letters 58:18, 2015, for mass-conserving cavitation.
    Cross: Journal of Colloid Science 20, 1965, p. 417; ASTM D4683 and SAE J300 for HTHS.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, for the viscosity.
    """

    assumptions = (RIGID, PARALLEL, SMOOTH, FULL, "the oil has one temperature over the cycle")
    levels = MARCHED_LEVELS
    default_level = "mobility"
    most_points = {"mobility_short": 2000, "mobility": 500, "mobility_grooved": 500, "supplied": 1}
    precision = 1e-6
    level_precision = {"supplied": 1e-5}  # its secants end where a march repeats
    example = {
        "crank_angle": {"value": list(range(0, 720, 30)), "unit": "deg"},
        **EXAMPLE,
        "supply_temperature": "90 degC",
        "hths_viscosity": "3.5 mPa*s",
    }  # fmt: skip
    main_results = (
        "largest_load", "speed", "maximum_pressure", "minimum_film_thickness", "power_loss",
        "total_oil_flow", "film_temperature",
    )  # fmt: skip
    criteria = {
        "film_exists": film_exists(),
        "own_film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film of the cycle is not thinner than its user permits",
            "limits": {"permissible_film": {"unit": "um", "words": "smallest film that its user permits"}},
        },
        "temperature": temperature(
            "film_temperature", "the film is no hotter than the bearing material bears"
        ),
        "hot_oil": hot_oil("outlet_temperature"),
        "temperature_rise": {
            "require": "temperature_rise <= permissible_temperature_rise",
            "words": "the oil grows no warmer on its way than its user permits",
            "limits": {
                "permissible_temperature_rise": {
                    "unit": "delta_degC",
                    "words": "largest temperature rise from supply to outlet",
                }
            },
        },
    }

    T_s: Array = given("degC", "supply temperature", symbol="T_{s}", ge=-100, le=400)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0, source=ISO)
    k: Array = given("1", "heat share", default="1", ge=0, le=1)
    eta_H: Array = given("mPa*s", "HTHS viscosity", symbol=r"\eta_\mathrm{HTHS}", name="hths_viscosity",
                         alternative=True, gt=0, assumed="shear does not thin the oil")  # fmt: skip
    r_inf: Array = given("1", "endless shear ratio", symbol=r"r_{\infty}", default="0.5", ge=0, lt=1)
    n: Array = given("1", "Cross exponent", default="1", gt=0, le=3, source=CROSS)

    @require("hths_viscosity", warning="unused_input", remedy="omit it, or omit `dynamic_viscosity`")
    def viscosity_follows(self) -> Truth:
        """Shear thinning applies only if the viscosity is not given."""
        return np.isnan(self.as_given("eta")) | np.isnan(self.eta_H)

    @require("groove_width", warning="unused_input", remedy="choose level `mobility_grooved` or `supplied`")
    def groove_counts(self) -> Truth:
        """A groove affects the film only at levels mobility_grooved and supplied."""
        return self.level in ("mobility_grooved", "supplied") or ~self.feeding.grooved

    @require("sleeve_hole_length", warning="unused_input", remedy="choose level `supplied`")
    def sleeve_hole_counts(self) -> Truth:
        """A hole in the sleeve feeds the film only at level supplied."""
        return (self.level == "supplied") | ~self.feeding.sleeve_holed

    @require("pin_hole_length", warning="unused_input", remedy="choose level `supplied`")
    def pin_hole_counts(self) -> Truth:
        """A hole in the pin feeds the film only at level supplied."""
        return (self.level == "supplied") | ~self.feeding.pin_holed

    @require("supply_pressure", warning="unused_input", remedy="give `groove_width`, or omit it")
    def pressure_counts(self) -> Truth:
        """The supply pressure drives oil from a groove; from holes only at level supplied."""
        return np.isnan(self.p_s) | self.feeding.grooved | (self.level == "supplied")

    def ladder(self) -> tuple[str, ...]:
        """Return the levels that model the oil supply; `supplied` only if a groove or hole feeds the film."""
        cheap = ("mobility_grooved",) if np.any(self.feeding.grooved) else ("mobility_short", "mobility")
        return (*cheap, "supplied") if np.all(self.feeding.count > 0) else cheap

    def starting_level(self) -> str:
        """Return the inexpensive level that models the groove, if there is one."""
        return next(level for level in ("mobility", "mobility_grooved") if level in self.ladder())

    def measured_case(self) -> str:
        """Return the kind of supply; empty outside the range of the measured engines."""
        fed, loaded = (self.P_s >= 0.02) & (self.P_s <= 1), (self.S_max >= 0.3) & (self.S_max <= 105)
        inside = np.all(fed & loaded & np.isnan(self.eta_given)) and sleeve_motion(self.motion)
        return supply_kind(self.feeding) if inside else ""

    @shared
    def S_max(self) -> Array:
        """Return the load number of the largest load at the effective viscosity."""
        return self.F_max * self.s / self.eta_e

    @shared
    def P_s(self) -> Array:
        """Return the supply pressure over the specific load at which the load number is 1."""
        return self.p_s * self.psi**2 / (self.eta_e * self.Omega)

    @formula("s/m**2", "load scale", symbol="s")
    def s(self) -> Array:
        """Load number divided by load and fluidity."""
        return self.psi**2 / (self.D * self.W * self.Omega)

    @shared
    def duty(self) -> Duty:
        """Return the loads and speeds of the bearing, for an oil of 1 Pa s."""
        return replace(self.motion, scale=self.s)

    @shared
    def bearing(self) -> CycleBearing:
        """Return the bearing over its cycle."""
        return CycleBearing(self.level, self.duty, self.feeding, self.p_s, self.c / 2)

    @shared
    def eta_given(self) -> Array:
        """Return the viscosity of the film, if it is given."""
        return self.as_given("eta")

    @formula("mPa*s", "low shear viscosity hot", symbol=r"\eta_{150}", source=LAWS,
             latex=r"\eta\left(150\,\mathrm{°C}\right)")  # fmt: skip
    def eta_150(self) -> Array:
        """Viscosity at low shear and 150 °C, the temperature of the HTHS viscosity."""
        return viscosity_at_150(
            self.law, self.A, self.B, self.a_V, self.b_V, self.c_V, self.eta_given, self.rho_ref,
            self.T_ref,
        )  # fmt: skip

    @formula(
        "1", "HTHS ratio", symbol="x", name="hths_ratio", ge=1e-6, le=1 - 1e-6, absent=NO_HTHS,
        source=CROSS, remedy=BETWEEN,
    )  # fmt: skip
    def hths_ratio(self) -> Array:
        """Fraction of the shear-dependent viscosity that remains at 1e6 1/s."""
        return left_by_HTHS(self.eta_H, self.eta_150, self.r_inf, self.eta_given)

    @shared
    def oil(self) -> CycleOil:
        """Return the oil and its heat capacity."""
        return CycleOil(
            A=self.A, B=self.B, a=by_law(self.law, np.nan, self.a_V), b=self.b_V, offset=self.c_V,
            eta=self.as_given("eta"), rho_ref=self.rho_ref, T_ref=self.T_ref, left=self.hths_ratio,
            endless=self.r_inf, exponent=self.n, supply=self.T_s, heat_capacity=self.rho_c, share=self.k,
        )  # fmt: skip

    @shared
    def heat(self) -> CycleHeat:
        """Return the heat balance."""
        return heat_of_cycle(self.bearing, self.oil)

    @formula(
        "mPa*s", "effective viscosity", symbol=r"\eta_{e}", gt=0, lt=1e9, remedy=UNBALANCED, source=CROSS,
        assumes=("b", "b_g", "inlets"),
        latex=r"r_{\infty}\,\eta+\frac{\left(1-r_{\infty}\right)\eta}{1+\frac{1-x}{x}\left(\frac{\dot\gamma\,\eta}"
        r"{10^{6}\,\mathrm{s^{-1}}\,\eta_{150}}\right)^{n}}",
    )  # fmt: skip
    def eta_e(self) -> Array:
        """Viscosity of the film at its temperature and shear rate; without an HTHS viscosity it equals η."""
        return viscosity_of(self.heat)

    @formula("degC", "film temperature", symbol="T_{m}", source=ISO,
             latex=r"T_{s}+\frac{k\,P}{2\,\rho_{c}\left(Q+Q_{p}\right)}")  # fmt: skip
    def T_film(self) -> Array:
        """Mean of supply and outlet temperature, from the heat to the oil; level supplied omits Q_p."""
        return temperature_of(self.heat, self.eta_e)

    @formula("degC", "outlet temperature", symbol="T_{ex}", source=ISO)
    def T_ex(self) -> Array:
        """Temperature of the outflowing oil."""
        return 2 * self.T_film - self.T_s

    @formula("delta_degC", "temperature rise", symbol=r"\Delta T", source=ISO)
    def rise(self) -> Array:
        """Difference between outlet and supply temperature."""
        return self.T_ex - self.T_s

    @formula("1/s", "mean shear rate", symbol=r"\dot\gamma",
             latex=r"\frac{1}{T}\int_{T}\frac{D\left|\omega_{J}-\omega_{B}\right|}{"
             r"c\,\sqrt{1-\epsilon^{2}}}d\theta")  # fmt: skip
    def rate(self) -> Array:
        """Sliding speed over gap, averaged over circumference and cycle."""
        return rate_of(self.heat, self.eta_e)

    @formula("1", "shear loss", symbol=r"\delta_{\gamma}", source=CROSS)
    def shear_loss(self) -> Array:
        """The relative reduction of the viscosity by shear."""
        return shear_loss_of(self.heat, self.eta_e, self.eta)

    @formula("W", "power loss", symbol="P",
             latex=r"\frac{1}{T}\int_{T}\left(\frac{\pi\,\eta_{e}\,W\,D^{3}\left(\omega_{J}-\omega_{B}\right)^{2}}{"
             r"2\,c\,\sqrt{1-\epsilon^{2}}}+\vec{F}\cdot\vec{v}\right)d\theta")  # fmt: skip
    def P(self) -> Array:
        """Mean power loss; v is the velocity of the centre in axes that rotate at the mean speed."""
        return loss_of(self.heat, self.eta_e)

    @formula("l/min", "side flow", symbol="Q", latex=r"\frac{W\,D\,c\,\Omega}{2}\,\bar{q}")
    def Q(self) -> Array:
        """Flow that the journal's motion displaces; at level supplied, all oil that leaves at the ends.

        The symbol with a bar is the dimensionless flow, averaged over the cycle.
        """
        return side_flow_of(self.heat, self.eta_e)

    @formula("l/min", "feed flow", symbol="Q_{p}", source=ISO, absent=ALL_OF_IT,
             latex=r"\frac{p_{s}\,D}{6\,\eta_{e}\left(W-B_{g}\right)}\,\frac{1}{T}\int_{T}\int_{\Delta\varphi_{g}}"
             r"h^{3}\,d\varphi\,d\theta")  # fmt: skip
    def Q_p(self) -> Array:
        """Flow from the groove over its lands due to supply pressure, with the gap along the groove."""
        return feed_flow_of(self.heat, self.eta_e)

    @formula("l/min", "total oil flow", symbol="Q_{t}", latex="Q+Q_{p}")
    def Q_t(self) -> Array:
        """Flow that the supply must deliver: all oil that leaves at the ends."""
        return all_flow(self.Q, self.Q_p)

    @shared
    def fed(self) -> FedDuty:
        """Return the loads, speeds and oil supply at the effective viscosity."""
        return self.bearing.fed(self.eta_e)

    @shared
    def orbit(self) -> FedOrbit:
        """Return the orbit at the effective viscosity."""
        return fed_orbit(self.level, self.fed)

    @shared
    def film(self) -> CycleFilm:
        """Return the pressure of the film."""
        return fed_film(self.level, self.fed, self.orbit)

    @formula("1", "maximum eccentricity", symbol=r"\epsilon_{max}", lt=1, source=ORBIT)
    def eps_max(self) -> Array:
        """Largest relative eccentricity, also between the crank angles."""
        return self.orbit.eps_max

    @formula("um", "minimum film thickness", symbol="h_{0}")
    def h_0(self) -> Array:
        """Smallest film of the cycle, also between the crank angles."""
        return self.c * (1 - self.eps_max) / 2

    @formula("deg", "minimum film angle", symbol=r"\theta_{h}")
    def theta_h(self) -> Array:
        """Crank angle of the smallest film."""
        return self.orbit.angle

    @profile("um", "film thickness", along=CYCLE, symbol="h", latex=r"\frac{c}{2}\left(1-\epsilon\right)")
    def h(self) -> Array:
        """Smallest film around the bearing, at each crank angle."""
        return spread(self.c / 2, self.orbit.gap)

    @formula("MPa", "maximum pressure", symbol="p_{max}",
             latex=r"\frac{\eta_{e}\,\Omega}{\psi^{2}}\,\max\bar p\left(\theta\right)")  # fmt: skip
    def p_max(self) -> Array:
        """Largest pressure of the cycle at the given angles; the symbol with a bar is dimensionless."""
        return self.film.P_max * self.eta_e * self.Omega / self.psi**2
