"""Group: a cylinder with its crank mechanism and its gas, shared by `bearing_load` and `engine`."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, derived, formula, given, require, shared
from templates.groups.cylinder_gas import CylinderGas
from templates.physics.engine.crank_loads import excess_at, pendulum_inertia
from templates.physics.engine.gas_checks import is_manageable
from templates.physics.engine.gas_cycle import gas_cycle
from templates.physics.engine.gas_pressure import GasCycle, mean_effective
from templates.physics.numerics.crank_grid import COARSE

DYREMI = "Rao & Singh 1993"
NO_INERTIA = "needs rod_inertia or rod_pendulum_period"


class CrankMechanism(Template):
    """The crank mechanism of a cylinder."""

    step: Array

    omega: Array = given("rpm", "speed")
    s: Array = given("mm", "stroke", gt=0, le=1e5)
    n: Array = given("1", "rod ratio", gt=1, le=1e6, remedy="rod length over crank radius, half the stroke")
    D: Array = given("mm", "bore", ge=0, le=1e5)
    m_cp: Array = given("kg", "crankpin mass", symbol="m_{cp}", default="0 kg", ge=0,
                        assumed="the crankpin weighs nothing")  # fmt: skip
    m_w: Array = given("kg", "crank mass", default="0 kg", ge=0, assumed="the webs weigh nothing")
    g_w: Array = given("mm", "crank centre", default="0 mm")
    m_cb: Array = given("kg", "counterweight mass", symbol="m_{cb}", default="0 kg", ge=0)
    g_cb: Array = given("mm", "counterweight centre", symbol="g_{cb}", default="0 mm", ge=0)
    m_3: Array = given("kg", "rod mass", ge=0)
    b_g: Array = given("mm", "rod centre", ge=0)
    tau: Array = given("s", "rod pendulum period", alternative=True, gt=0)
    m_4: Array = given("kg", "piston mass", ge=0)
    strokes: Array = given("1", "strokes", symbol="z", integer=True, single=True, ge=2, le=4)

    @require("crank_angle_step", remedy="take a larger step, or fewer points at once")
    def manageable(self) -> Truth:
        """Points times crank angles, at 1 deg or the step, are at most 2 000 000."""
        return is_manageable(self.shape_of_points(), self.strokes, self.step)

    @require("crank_angle_step", warning="coarse_curves",
             remedy="take 5 deg or less for curves; greatest loads and energy do not change")  # fmt: skip
    def shows_peaks(self) -> Truth:
        """Curves are returned at steps of at most 5 deg, which show their peaks."""
        return self.step <= COARSE

    @require("rod_centre", "rod_ratio", "stroke", remedy="it is counted from the big end")
    def centre_on_the_rod(self) -> Truth:
        """The rod's centre of mass lies between its ends."""
        return self.b_g <= self.n * self.s / 2


class Cylinder(CylinderGas, CrankMechanism):
    """A cylinder with its crank mechanism and its gas."""

    levels = ("lumped", "rigid")
    default_level = "rigid"
    most_points = {"lumped": 2_700, "rigid": 2_700}

    step: Array = given("deg", "crank angle step", symbol=r"\Delta\theta", default="1 deg", single=True,
                        ge=0.1, le=30)  # fmt: skip

    @derived("kg*m**2", "rod inertia", symbol="I_3", shown=True, ge=0, absent=NO_INERTIA, source=DYREMI,
             remedy="no rod swings faster about its wristpin than a point mass at its centre")  # fmt: skip
    def I_3(self) -> Array:
        """Moment of inertia of the rod about its centre of mass."""
        return pendulum_inertia(self.m_3, self.a_g, self.tau)

    @require("crank_mass", "crankpin_mass", "counterweight_mass", warning="massless_crank",
             remedy="give their masses; main loads, balance and inertia are of rods alone")  # fmt: skip
    def crank_has_mass(self) -> Truth:
        """At least one of web, crankpin and counterweight has a mass."""
        return (self.m_w > 0) | (self.m_cp > 0) | (self.m_cb > 0)

    def ladder(self) -> tuple[str, ...]:
        """Return the levels for which the data of the rod are sufficient."""
        known = not np.isnan(np.asarray(self.I_3)).all()
        return self.levels if known else self.levels[:1]

    @formula("mm", "crank radius")
    def r(self) -> Array:
        """Half the stroke."""
        return self.s / 2

    @formula("mm", "rod length", symbol="l")
    def l(self) -> Array:  # noqa: E743
        """Length of the rod from pin to pin."""
        return self.n * self.r

    @formula("mm", "rod centre from wristpin", symbol="a_{g}")
    def a_g(self) -> Array:
        """Distance of the rod's centre of mass from the wristpin: the remainder of the rod's length."""
        return self.l - self.b_g

    @formula("kg", "rod mass at crankpin", symbol="m_{3A}", source=DYREMI)
    def m_3A(self) -> Array:
        """Part of the rod's mass at the big end."""
        return self.m_3 * self.a_g / self.l

    @formula("kg", "rod mass at wristpin", symbol="m_{3B}", source=DYREMI)
    def m_3B(self) -> Array:
        """Part of the rod's mass at the small end."""
        return self.m_3 * self.b_g / self.l

    @formula("kg", "rotating mass", symbol="M", source=DYREMI)
    def M(self) -> Array:
        """Mass of all rotating parts, referred to the crank radius."""
        return self.m_3A + self.m_w * self.g_w / self.r + self.m_cp - self.m_cb * self.g_cb / self.r

    @formula("kg", "reciprocating mass", symbol=r"m_\mathrm{rec}", source=DYREMI)
    def m_rec(self) -> Array:
        """Mass of all parts that move with the piston."""
        return self.m_3B + self.m_4

    @formula("cm**2", "bore area", symbol="A")
    def A(self) -> Array:
        """Piston area under the gas pressure."""
        return np.pi * self.D**2 / 4

    @formula("kg*m**2", "inertia excess", symbol=r"\Delta I", source=DYREMI, absent=NO_INERTIA)
    def dI(self) -> Array:
        """Moment of inertia of the two masses minus that of the rod."""
        return self.m_3 * self.a_g * self.b_g - self.I_3

    @formula("kg*m**2", "inertia correction", symbol=r"\Delta I_{c}", source=DYREMI,
             remedy="level `rigid` needs `rod_inertia` or `rod_pendulum_period`;"
             " choose `lumped`")  # fmt: skip
    def dI_c(self) -> Array:
        """The part of this difference that the level uses: 0 if the rod is treated as two masses."""
        return excess_at(self.level, self.dI)

    @shared
    def gas(self) -> GasCycle:
        """Return the gas cycle of the cylinder."""
        return gas_cycle(
            self.gas_cycle, self.strokes, self.n, self.charge, self.valves, self.theta_p, self.p_t, self.p_0
        )

    @formula("bar", "indicated mean effective pressure", symbol="p_{mi}",
             latex=r"\frac{1}{A\,s}\oint p\,dV")  # fmt: skip
    def p_mi(self) -> Array:
        """Indicated mean effective pressure, exact for any crank angle step."""
        return mean_effective(self.gas)
