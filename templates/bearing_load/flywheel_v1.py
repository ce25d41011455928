"""An engine of equal cylinders: torque and its fluctuation, flywheel, balance of forces and couples.

It has any number of cylinders that fire at equal intervals, in line or in banks (DYREMI).
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import (
    Array,
    Truth,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.cylinder import DYREMI, Cylinder
from templates.physics.engine.balance import (
    Arrangement,
    TwoPlanes,
    arrangement,
    balance_angle,
    is_firing_order,
    is_one_each,
    mid_plane,
    reciprocating_couple,
    reciprocating_force,
    residual_force_x,
    residual_force_y,
    rotating_couple,
    rotating_force,
    two_planes,
)
from templates.physics.engine.flywheel import (
    corners,
    cylinder_motion,
    energy_fluctuation,
    inertia_of_fluctuation,
    larger,
    total_torque,
)
from templates.physics.engine.slider_crank import Motion, crank_angles
from templates.physics.numerics.crank_grid import CrankGrid, crank_grid

CYCLE = "crank_angle"
EVEN = "nothing is out of balance"
AT_REST = "at rest, or without `speed_fluctuation`, there is no swing to even out"
NO_CRITERION = "needs speed_fluctuation (and a speed) or maximum_acceleration"


class Flywheel(Cylinder):
    """An engine of equal cylinders: torque and its fluctuation, flywheel, balance of forces and couples.

    It has any number of cylinders that fire at equal intervals, in line or in banks (DYREMI).

    Limits
    ------
    Equal cylinders, equal firing intervals; the shaft is rigid and rotates at constant speed.
    The crank angle is measured from the position at which the first cylinder of the firing order begins its
    intake stroke (four strokes) or fires (two strokes).
    Crank i is at −(firing interval) · (its position in the firing order, from 0), plus the angle of its bank;
    angles of balancing masses are also measured in the sense of the crank angle.
    Positions are along the shaft, from any plane; couples are about reference_position.
    Bank angles (V engines) are measured from the x axis in the sense of rotation. Each cylinder
    includes the given crank masses: of a throw with two rods, give half. Bank angles with opposite signs
    describe another crank: each throw follows from the bank of its cylinder. Unequal firing intervals and
    articulated rods are not supported for banks.
    Primary and secondary amplitudes are those of the reciprocating masses alone, in banks the largest over a
    revolution; the rotating couple is that of the rotating masses alone. Residual forces include both, up to
    the second harmonic.
    Balancing masses (mass times radius) in the planes of flywheel and damper cancel forces and couples of the
    rotating masses.
    The mean torque is indicated, from the work of the gas without friction; it is exact for any step. The
    energy is integrated over a grid of at most 1 deg with both sides of each pressure jump, relative to the
    mean of that grid; crank_angle_step determines only the angles at which curves are returned.
    A negative flywheel inertia means that the installed inertia is sufficient.

    Errata
    ------
    DYREMI drops r in the secondary force m_rec ω² r cos 2θ/n.
    The errata of the loads are listed in `bearing_load`.

    References
    ----------
    S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94.
    """

    precision = 1e-10
    example = {
        "speed": "1500 rpm",
        "stroke": "120 mm",
        "rod_ratio": 3.8,
        "bore": "100 mm",
        "crankpin_mass": "1.2 kg",
        "crank_mass": "6 kg",
        "crank_centre": "20 mm",
        "counterweight_mass": "2.5 kg",
        "counterweight_centre": "45 mm",
        "rod_mass": "1.9 kg",
        "rod_centre": "70 mm",
        "rod_pendulum_period": "0.94 s",
        "piston_mass": "1.4 kg",
        "strokes": 4,
        "gas_cycle": "diesel",
        "suction_pressure": "1 bar",
        "compression_ratio": 17,
        "cutoff": 2,
        "crankcase_pressure": "1 bar",
        "crank_angle_step": "30 deg",
        "cylinders": 5,
        "firing_order": [1, 2, 4, 5, 3],
        "cylinder_positions": {"value": [0, 0.13, 0.26, 0.39, 0.52], "unit": "m"},
        "damper_position": "-0.15 m",
        "flywheel_position": "0.7 m",
        "speed_fluctuation": 0.01,
        "maximum_acceleration": "40 rad/s**2",
        "journal_mass": "2 kg",
        "journal_radius": "40 mm",
        "crankpin_radius": "35 mm",
        "damper_inertia": "0.05 kg*m**2",
        "driven_inertia": "0.5 kg*m**2",
    }
    main_results = ("speed", "mean_torque", "mean_power", "energy_fluctuation", "flywheel_inertia")
    criteria = {
        "flywheel": {
            "require": "flywheel_inertia <= planned_flywheel_inertia",
            "words": "the flywheel that is planned evens out the speed",
            "limits": {
                "planned_flywheel_inertia": {
                    "unit": "kg*m**2",
                    "words": "inertia of the flywheel that is planned",
                }
            },
        },
        "shaking_force": {
            "require": "sqrt(residual_force_x**2 + residual_force_y**2) <= permissible_shaking_force",
            "words": "the residual force is within the permissible one all the way round",
            "limits": {"permissible_shaking_force": {"unit": "N", "words": "largest residual force"}},
        },
        "primary_couple": {
            "require": "primary_couple <= permissible_couple",
            "words": "the primary couple is within the permissible one",
            "limits": {"permissible_couple": {"unit": "N*m", "words": "largest primary couple"}},
        },
        "piston_speed": {
            "require": "abs(speed) * stroke / pi <= permissible_piston_speed",
            "words": "the mean piston speed is within the permissible one",
            "limits": {"permissible_piston_speed": {"unit": "m/s", "words": "largest mean piston speed"}},
        },
    }

    N: Array = given("1", "cylinders", integer=True, single=True, ge=1, le=100)
    order: Array = curve("1", "firing order", along="cylinders", constant=True, integer=True, ge=1,
                         symbol=r"\mathrm{order}")  # fmt: skip
    z_i: Array = curve("m", "cylinder positions", along="cylinders", constant=True, ge=-1000, le=1000)
    beta: Array = curve("deg", "bank angles", along="cylinders", constant=True, default="0 deg",
                        ge=-360, le=360)  # fmt: skip
    z_d: Array = given("m", "damper position", optional=True, ge=-1000, le=1000)
    z_f: Array = given("m", "flywheel position", optional=True, ge=-1000, le=1000)
    delta: Array = given("1", "speed fluctuation", alternative=True, gt=0, le=1)
    alpha: Array = given("rad/s**2", "maximum acceleration", alternative=True, gt=0)
    m_j: Array = given("kg", "journal mass", default="0 kg", ge=0)
    r_j: Array = given("mm", "journal radius", default="0 mm", ge=0)
    r_cp: Array = given("mm", "crankpin radius", default="0 mm", ge=0)
    I_d: Array = given("kg*m**2", "damper inertia", default="0 kg*m**2", ge=0)
    I_g: Array = given("kg*m**2", "driven inertia", default="0 kg*m**2", ge=0)

    @derived("m", "reference position", symbol="z_{0}", ge=-1000, le=1000)
    def z_0(self) -> Array:
        return mid_plane(self.z_i)

    @require("firing_order", "cylinders", remedy="name each cylinder from 1 on once, in the order they fire")
    def each_fires_once(self) -> Truth:
        """The firing order contains every cylinder once."""
        return is_firing_order(self.order, self.N)

    @require("cylinder_positions", "cylinders", remedy="give a position for each cylinder")
    def each_has_its_place(self) -> Truth:
        """There is a position for each cylinder."""
        return is_one_each(self.z_i, self.N)

    @require("bank_angles", "cylinders", remedy="give one angle for each cylinder, or one for all")
    def each_has_its_bank(self) -> Truth:
        """There is a bank angle for each cylinder, or one for all."""
        return (np.ndim(self.beta) == 0) | is_one_each(self.beta, self.N)

    @require("damper_position", "flywheel_position", remedy="balance needs two planes")
    def two_planes_differ(self) -> Truth:
        """Damper and flywheel are in different planes."""
        return self.z_d != self.z_f

    @shared
    def row(self) -> Arrangement:
        """Return the positions and angles of the cranks."""
        return arrangement(self.strokes, self.order, self.beta, self.z_i, self.z_0)

    @shared
    def planes(self) -> TwoPlanes:
        """Return the balancing masses for cranks of unit mass and radius."""
        return two_planes(self.row, self.z_0, self.z_f, self.z_d)

    @shared
    def motion(self) -> Motion:
        """Return the mechanisms of all cylinders."""
        return cylinder_motion(self.theta, self.strokes, self.N, self.n)

    @shared
    def grid(self) -> CrankGrid:
        """Return the angles over which the energy is integrated."""
        return crank_grid(self.strokes, self.step, corners(self.gas, self.strokes, self.N))

    @shared
    def torques(self) -> Array:
        """Return the torque of all cylinders at the angles of `grid` [N m], (…, K)."""
        theta = self.grid.theta
        motion = cylinder_motion(theta, self.strokes, self.N, self.n)
        return total_torque(
            self.m_rec, self.omega, self.r, self.A, self.dI_c, motion, self.gas, self.p_0, theta
        )

    @profile("deg", "crank angle", along=CYCLE, symbol=r"\theta", latex=r"k\,\Delta\theta")
    def theta(self) -> Array:
        return crank_angles(self.strokes, self.step)

    @profile("N*m", "torque", along=CYCLE, symbol="T", source=DYREMI,
             latex=r"\sum_{i} T_{i}\left(\theta-\left(i-1\right)\frac{\pi\,z}{N}\right)")  # fmt: skip
    def T(self) -> Array:
        return total_torque(
            self.m_rec, self.omega, self.r, self.A, self.dI_c, self.motion, self.gas, self.p_0, self.theta
        )

    @formula("N*m", "indicated mean torque", name="mean_torque", symbol=r"\overline{T}")
    def T_mean(self) -> Array:
        return self.N * self.p_mi * self.A * self.s / (np.pi * self.strokes)

    @formula("kW", "indicated mean power", name="mean_power", symbol="P")
    def P(self) -> Array:
        return self.T_mean * self.omega

    @formula("J", "energy fluctuation", symbol="E", source=DYREMI,
             latex=r"\Delta\int\left(T-\overline{T}\right)d\theta")  # fmt: skip
    def E(self) -> Array:
        return energy_fluctuation(self.torques, self.grid)

    @formula("kg*m**2", "cylinder inertia", symbol="I_{c}", source=DYREMI)
    def I_c(self) -> Array:
        return (
            self.m_w * self.g_w**2
            + self.m_cb * self.g_cb**2
            + (self.m_cp + self.m_3A) * self.r**2
            + (self.m_j * self.r_j**2 + self.m_cp * self.r_cp**2 + self.m_rec * self.r**2) / 2
        )

    @formula("kg*m**2", "engine inertia", symbol="I_{e}", source=DYREMI)
    def I_e(self) -> Array:
        return self.N * self.I_c

    @formula("kg*m**2", "inertia for fluctuation", symbol=r"I_{\delta}", source=DYREMI, absent=AT_REST)
    def I_delta(self) -> Array:
        return inertia_of_fluctuation(self.E, self.delta, self.omega)

    @formula("kg*m**2", "inertia for acceleration", symbol=r"I_{\alpha}", source=DYREMI,
             absent="needs maximum_acceleration")  # fmt: skip
    def I_alpha(self) -> Array:
        return abs(self.T_mean) / self.alpha

    @formula("kg*m**2", "flywheel inertia", symbol="I_{f}", source=DYREMI, absent=NO_CRITERION)
    def I_f(self) -> Array:
        return larger(self.I_delta, self.I_alpha) - self.I_e - self.I_d - self.I_g

    @formula("N", "rotating force", symbol="F_{r}", source=DYREMI)
    def F_r(self) -> Array:
        return rotating_force(self.M, self.omega, self.r, self.row)

    @formula("N*m", "rotating couple", symbol="C_{r}", source=DYREMI)
    def C_r(self) -> Array:
        return rotating_couple(self.M, self.omega, self.r, self.row)

    @formula("kg*mm", "balance flywheel", symbol="B_{f}", source=DYREMI, le=1e300)
    def B_f(self) -> Array:
        return abs(self.M) * self.r * np.abs(self.planes.flywheel)

    @formula("deg", "balance flywheel angle", symbol=r"\beta_{f}", source=DYREMI, absent=EVEN)
    def beta_f(self) -> Array:
        return balance_angle(self.M, self.planes.flywheel)

    @formula("kg*mm", "balance damper", symbol="B_{d}", source=DYREMI, le=1e300)
    def B_d(self) -> Array:
        return abs(self.M) * self.r * np.abs(self.planes.damper)

    @formula("deg", "balance damper angle", symbol=r"\beta_{d}", source=DYREMI, absent=EVEN)
    def beta_d(self) -> Array:
        return balance_angle(self.M, self.planes.damper)

    @formula("N", "primary force", symbol="F_{1}", source=DYREMI)
    def F_1(self) -> Array:
        return reciprocating_force(self.m_rec, self.omega, self.r, self.n, 1, self.row)

    @formula("N", "secondary force", symbol="F_{2}", source=DYREMI)
    def F_2(self) -> Array:
        return reciprocating_force(self.m_rec, self.omega, self.r, self.n, 2, self.row)

    @formula("N*m", "primary couple", symbol="C_{1}", source=DYREMI)
    def C_1(self) -> Array:
        return reciprocating_couple(self.m_rec, self.omega, self.r, self.n, 1, self.row)

    @formula("N*m", "secondary couple", symbol="C_{2}", source=DYREMI)
    def C_2(self) -> Array:
        return reciprocating_couple(self.m_rec, self.omega, self.r, self.n, 2, self.row)

    @profile("N", "residual force x", along=CYCLE, symbol="F_{h}", source=DYREMI,
             latex=r"\omega^{2}r\,\sum_{i}\left(\left(M+m_\mathrm{rec}\right)\cos\theta_i"
                   r"+\frac{m_\mathrm{rec}}{n}\cos 2\theta_i\right)")  # fmt: skip
    def F_h(self) -> Array:
        return residual_force_x(self.M, self.m_rec, self.omega, self.r, self.n, self.row, self.theta)

    @profile("N", "residual force y", along=CYCLE, symbol="F_{v}", source=DYREMI,
             latex=r"\omega^{2}r\,\sum_{i}M\sin\theta_i")  # fmt: skip
    def F_v(self) -> Array:
        return residual_force_y(self.M, self.m_rec, self.omega, self.r, self.n, self.row, self.theta)
