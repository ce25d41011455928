"""Gas pressure of a four-stroke cylinder from the heat of its fuel: single zone, Wiebe's law.

The calculated curve serves as the pressure table of `engine` and `bearing_load`.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, formula, given, profile, require, shared
from templates.physics.combustion.wiebe import (
    FIRING,
    ClosedCylinder,
    HeatRelease,
    Peak,
    burnt_share,
    closed_cylinder,
    closed_work,
    cycle_pressure,
    energy_change,
    four_stroke_angles,
    highest,
    peak,
    peak_angle,
    released_heat,
    unbalanced_share,
)

WIEBE, HEYWOOD = "Wiebe 1970", "Heywood 1988"
CYCLE = "crank_angle"


class CombustionCycle(Template):
    """Gas pressure of a four-stroke cylinder from the heat of its fuel: single zone, Wiebe's law.

    The calculated curve serves as the pressure table of `engine` and `bearing_load`.

    Limits
    ------
    One zone, one ratio of specific heats from inlet closing to exhaust opening, no wall heat loss and no
    blow-by: subtract these from heat_release. Cylinder axis through that of the crankshaft.
    The crank angle is measured from top dead centre at the start of the intake stroke; the cylinder fires at
    360 deg, as in the pressure tables of bearing_load and engine. Start of combustion is measured from firing
    dead centre.
    The pressure is constant during intake until the inlet closes, and during exhaust from 540 deg on; from
    exhaust opening to 540 deg it changes linearly with the crank angle.
    The burnt fraction is 1 - exp(-a y^(m+1)), y the fraction of the duration; the fraction exp(-a) that is
    left at the end does not burn.
    steps determines the angles at which the curves are returned; the peak does not depend on it.
    Work and energy balance are those of the closed part, from inlet closing to exhaust opening.
    energy_balance_error is heat minus work minus change of internal energy, over the heat plus intake
    pressure times swept volume. The work is an independent quadrature of the pressure, so the balance checks
    both.

    References
    ----------
    I. I. Wiebe: Brennverlauf und Kreisprozess von Verbrennungsmotoren, VEB Verlag Technik 1970.
    J. B. Heywood: Internal Combustion Engine Fundamentals, McGraw-Hill 1988, chapter 9.
    """

    precision = 1e-9
    example = {
        "bore": "86 mm",
        "stroke": "86 mm",
        "rod_length": "145 mm",
        "compression_ratio": 10.5,
        "suction_pressure": "0.95 bar",
        "inlet_closes": "220 deg",
        "heat_release": "1250 J",
        "combustion_start": "-20 deg",
        "combustion_duration": "55 deg",
        "ratio_of_specific_heats": 1.32,
        "steps": 72,
    }
    main_results = ("peak_pressure", "peak_pressure_angle", "burnt_heat", "closed_mean_effective_pressure")
    criteria = {
        "peak_pressure": {
            "require": "peak_pressure <= permissible_peak_pressure",
            "words": "the peak pressure is within the permissible one",
            "limits": {"permissible_peak_pressure": {"unit": "bar", "words": "largest gas pressure"}},
        },
    }

    D: Array = given("mm", "bore", gt=0, le=1e4)
    s: Array = given("mm", "stroke", gt=0, le=1e4)
    l: Array = given("mm", "rod length", gt=0, le=1e5, symbol="l")  # noqa: E741
    epsilon: Array = given("1", "compression ratio", symbol=r"\epsilon", gt=1.5, le=50)
    p_s: Array = given("bar", "suction pressure", gt=0, le=100)
    p_e: Array = given("bar", "exhaust pressure", default="1.1 bar", gt=0, le=100)
    ic: Array = given("deg", "inlet closes", symbol=r"\theta_{ic}", default="180 deg", ge=90, le=300)
    eo: Array = given("deg", "exhaust opens", symbol=r"\theta_{eo}", default="500 deg", ge=400, le=630)
    Q: Array = given("J", "heat release", ge=0, le=1e9)
    t_s: Array = given("deg", "combustion start", symbol=r"\theta_{s}", ge=-180, le=90)
    t_d: Array = given("deg", "combustion duration", symbol=r"\Delta\theta", ge=0.01, le=180)
    a: Array = given("1", "wiebe efficiency constant", default="6.908", gt=0, le=50, source=HEYWOOD)
    m: Array = given("1", "wiebe shape", default="2", ge=0, le=10, source=HEYWOOD)
    gamma: Array = given("1", "ratio of specific heats", symbol=r"\gamma", default="1.32", gt=1.001, le=1.67)
    K: Array = given("1", "steps", default="720", integer=True, single=True, ge=36, le=7200)

    @require("rod_length", "stroke", remedy="take a longer rod")
    def rod_is_long_enough(self) -> Truth:
        """The rod is longer than half the stroke."""
        return self.l > 1.000001 * self.s / 2

    @require("combustion_start", "inlet_closes", remedy="begin later, or close the inlet earlier")
    def burns_after_closing(self) -> Truth:
        """Combustion begins after the inlet closes."""
        return FIRING + self.t_s >= self.ic

    @require("combustion_start", "combustion_duration", "exhaust_opens", remedy="burn for a shorter time")
    def burns_before_opening(self) -> Truth:
        """Combustion ends before the exhaust opens."""
        return FIRING + self.t_s + self.t_d <= self.eo

    @shared
    def cylinder(self) -> ClosedCylinder:
        """Return the cylinder while its valves are closed."""
        burning = HeatRelease(self.Q, FIRING + self.t_s, self.t_d, self.a, self.m)
        return closed_cylinder(
            self.n, self.V_h, self.epsilon, self.p_s, self.ic, self.eo, self.gamma, burning
        )

    @shared
    def highest(self) -> Peak:
        """Return the largest pressure and its crank angle."""
        return highest(self.cylinder, self.p_s, self.p_e)

    @formula("1", "rod ratio")
    def n(self) -> Array:
        return 2 * self.l / self.s

    @formula("cm**3", "swept volume", symbol="V_{h}")
    def V_h(self) -> Array:
        return np.pi / 4 * self.D**2 * self.s

    @profile("deg", "crank angle", along=CYCLE, symbol=r"\theta", latex=r"k\,\frac{720°}{K}")
    def theta(self) -> Array:
        return four_stroke_angles(self.K)

    @profile("bar", "gas pressure", along=CYCLE, symbol="p", source=WIEBE)
    def p(self) -> Array:
        return cycle_pressure(self.cylinder, self.theta, self.p_s, self.p_e)

    @profile("1", "burnt share", along=CYCLE, symbol="x", source=WIEBE,
             latex=r"1-e^{-a\,y^{m+1}}")  # fmt: skip
    def x(self) -> Array:
        return burnt_share(self.cylinder, self.theta)

    @formula("bar", "peak pressure", symbol=r"p_\mathrm{max}", published=(None, 400),
             remedy="check the heat and the ratio")  # fmt: skip
    def p_max(self) -> Array:
        return peak(self.highest)

    @formula("deg", "peak pressure angle", symbol=r"\theta_\mathrm{max}")
    def theta_max(self) -> Array:
        return peak_angle(self.highest)

    @formula("J", "burnt heat", symbol=r"Q_{b}", latex=r"Q\left(1-e^{-a}\right)")
    def Q_b(self) -> Array:
        return released_heat(self.cylinder)

    @formula("J", "closed work", symbol="W")
    def W(self) -> Array:
        return closed_work(self.cylinder)

    @formula("J", "change of inner energy", symbol=r"\Delta U",
             latex=r"\frac{p_2 V_2-p_1 V_1}{\gamma-1}")  # fmt: skip
    def dU(self) -> Array:
        return energy_change(self.cylinder)

    @formula("bar", "mean effective pressure of the closed part", name="closed_mean_effective_pressure",
             symbol="p_{mi}")  # fmt: skip
    def p_mi(self) -> Array:
        return self.W / self.V_h

    @formula("1", "energy balance error", symbol=r"\epsilon_{E}")
    def error_E(self) -> Array:
        return unbalanced_share(self.Q_b, self.W, self.dU, self.p_s * self.V_h)
