"""Loads of crankpin, main and wristpin bearing, wall and crank over the cycle of one cylinder (DYREMI).

The loads follow from the gas pressure and the motion of crank, rod and piston at constant speed. Each load is
a curve whose x and y draw the polar diagram.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, formula, profile, shared
from templates.groups.cylinder import DYREMI, NO_INERTIA, Cylinder
from templates.groups.petrol_engine import OVERLAP, PETROL_CYCLE
from templates.physics.engine.crank_loads import (
    CrankForces,
    axial_force,
    correction_torque,
    crankpin_load_x_Rao_Singh_1993,
    crankpin_load_y_Rao_Singh_1993,
    greatest_force,
    main_load_x_Rao_Singh_1993,
    main_load_y_Rao_Singh_1993,
    torque_Rao_Singh_1993,
    wall_force_Rao_Singh_1993,
    wristpin_load_x,
)
from templates.physics.engine.gas_pressure import peak_pressure, pressure_at
from templates.physics.engine.slider_crank import Motion, crank_angles, crank_motion
from templates.physics.numerics.arrays import spread
from templates.physics.numerics.crank_grid import CrankGrid, crank_grid

CYCLE = "crank_angle"
PEAK = ("p_max",)


class BearingLoad(Cylinder):
    """Loads of crankpin, main and wristpin bearing, wall and crank over the cycle of one cylinder (DYREMI).

    The loads follow from the gas pressure and the motion of crank, rod and piston at constant speed. Each
    load is a curve whose x and y draw the polar diagram.

    Limits
    ------
    Axes are fixed to the frame: x points from the crankshaft to the cylinder head, y in the direction in
    which the crankpin first moves. The crank angle is measured from top dead centre: in a four-stroke engine
    the intake stroke begins at 0° and combustion at 360°, in a two-stroke engine combustion begins at 0°.
    Constant speed, rigid bodies, cylinder axis through that of the crankshaft; no friction, no gravity.
    A crankpin load acts from the rod on the crank, a main load from the frame on the crank (the sum of all
    its bearings), a wristpin load from the rod on the piston, a wall force from the piston on the cylinder, a
    torque from the rod on the crank.
    `oil_film_cycle` needs the force of the journal, which is the load here with opposite sign; in a plain
    bore film, pressure and loss are the same, and the orbit is rotated by 180°.
    The sleeve of a big end swings with rod_angular_velocity.
    Level lumped: the rod is two statically equivalent masses, as in DYREMI. Level rigid: the rod is a rigid
    body, which needs rod_inertia (about its centre of mass) or rod_pendulum_period (about the wristpin); this
    level is used if one of them is given.
    Gas forces are proportional to the pressure minus that of the crankcase. Polytropes (otto, diesel,
    four_stroke) need absolute pressures: give crankcase_pressure too, or the force is too large by the
    ambient pressure.
    A table is linear between its points; its pressures may be gauge pressures.
    The mean torque is indicated, from the work of the gas without friction; it is exact for any step. Curves
    are exact at their angles; greatest values come from a grid of at most 1 deg with both sides of each
    pressure jump, for any step.
    Speeds may be negative: the angle then decreases with time, and forces are those of the same angle.
    crank_centre is measured from the shaft's axis towards the crankpin, counterweight_centre away from it.

    Errata
    ------
    DYREMI prints −pA in F_32y; the crankpin load here satisfies the equilibrium of the free bodies.
    DYREMI prints n cos θ for n cos φ in the torque.
    DYREMI's correction torque m_3 b (l − L) mixes the two pivots of the rod; here it is that of the rigid
    body.

    References
    ----------
    S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94.
    Khurmi, Gupta: Theory of Machines, example 15.7.
    """

    precision = 1e-10
    example = {
        "speed": "3000 rpm",
        "stroke": "86 mm",
        "rod_ratio": 3.4,
        "bore": "86 mm",
        "crankpin_mass": "0.35 kg",
        "crank_mass": "1.4 kg",
        "crank_centre": "12 mm",
        "counterweight_mass": "0.9 kg",
        "counterweight_centre": "32 mm",
        "rod_mass": "0.62 kg",
        "rod_centre": "42 mm",
        "rod_pendulum_period": "0.7 s",
        "piston_mass": "0.48 kg",
        "strokes": 4,
        **PETROL_CYCLE,
        **OVERLAP,
        "crank_angle_step": "30 deg",
    }
    main_results = ("speed", "crankpin_load_max", "main_load_max", "wristpin_load_max", "mean_torque")
    criteria = {
        "crankpin_load": {
            "require": "crankpin_load_max <= permissible_crankpin_load",
            "words": "the crankpin bearing is loaded within what it bears",
            "limits": {
                "permissible_crankpin_load": {
                    "unit": "N",
                    "words": "largest load that the crankpin bearing bears",
                }
            },
        },
        "main_load": {
            "require": "main_load_max <= permissible_main_load",
            "words": "the main bearings are loaded within what they bear",
            "limits": {
                "permissible_main_load": {
                    "unit": "N",
                    "words": "largest load that the main bearings bear together",
                }
            },
        },
        "gas_pressure": {
            "require": "peak_gas_pressure <= permissible_gas_pressure",
            "words": "the gas pressure is within the permissible one",
            "limits": {"permissible_gas_pressure": {"unit": "bar", "words": "largest gas pressure"}},
        },
        "piston_speed": {
            "require": "abs(speed) * stroke / pi <= permissible_piston_speed",
            "words": "the mean piston speed is within the permissible one",
            "limits": {"permissible_piston_speed": {"unit": "m/s", "words": "largest mean piston speed"}},
        },
    }

    @profile("deg", "crank angle", along=CYCLE, symbol=r"\theta", latex=r"k\,\Delta\theta")
    def theta(self) -> Array:
        return crank_angles(self.strokes, self.step)

    @shared
    def motion(self) -> Motion:
        """Return the mechanism at the angles of the curves."""
        return crank_motion(self.theta, self.n)

    @shared
    def grid(self) -> CrankGrid:
        """Return the angles at which the maxima are calculated."""
        return crank_grid(self.strokes, self.step, self.gas.corners())

    @shared
    def everywhere(self) -> Motion:
        """Return the mechanism at the angles of `grid`."""
        return crank_motion(self.grid.theta, self.n)

    @shared
    def pressures(self) -> Array:
        """Return the pressure at the angles of `grid` [Pa], (…, K)."""
        return pressure_at(self.gas, self.everywhere)

    @shared
    def forces(self) -> CrankForces:
        """Return the forces at the angles of `grid`."""
        motion, p = self.everywhere, self.pressures
        K = axial_force(self.m_rec, self.omega, self.r, self.A, motion, p, self.p_0)
        wall = wall_force_Rao_Singh_1993(K, self.dI_c, self.omega, self.r, motion)
        wristpin = wristpin_load_x(self.m_4, self.omega, self.r, self.A, motion, p, self.p_0)
        return CrankForces(K, wall, wristpin, motion, self.omega, self.r)

    @profile("mm", "piston travel", along=CYCLE, symbol="x",
             latex=r"r\left(1+n-\cos\theta-n\cos\varphi\right)")  # fmt: skip
    def x(self) -> Array:
        return spread(self.s, self.motion.travel)

    @profile("m/s", "piston velocity", along=CYCLE, symbol="v", source=DYREMI,
             latex=r"-\omega\,r\left(\sin\theta+\cos\theta\,\tan\varphi\right)")  # fmt: skip
    def v(self) -> Array:
        return -spread(self.omega * self.r, self.motion.lever)

    @profile("m/s**2", "piston acceleration", along=CYCLE, symbol="a", source=DYREMI,
             latex=r"-\omega^{2}r\left(\cos\theta+\frac{\left(n^{2}-1\right)\cos 2\theta+\cos^{4}\theta}"
                   r"{\left(n^{2}-\sin^{2}\theta\right)^{3/2}}\right)")  # fmt: skip
    def a(self) -> Array:
        return spread(self.omega**2 * self.r, self.motion.acceleration)

    @profile("rad/s", "rod angular velocity", along=CYCLE, symbol=r"\omega_{3}", source=DYREMI,
             latex=r"-\omega\,\frac{\cos\theta}{n\cos\varphi}")  # fmt: skip
    def omega_3(self) -> Array:
        return -spread(self.omega, self.motion.rod_velocity)

    @profile("bar", "gas pressure", along=CYCLE, symbol="p", latex=r"p\left(\theta\right)")
    def p(self) -> Array:
        return pressure_at(self.gas, self.motion)

    @formula("bar", "peak gas pressure", symbol=r"p_\mathrm{max}", absent="there is no gas",
             published=(1.5, 400), remedy="check the units of the pressures")  # fmt: skip
    def p_max(self) -> Array:
        return peak_pressure(self.gas_cycle, self.pressures)

    @profile("N", "axial force", along=CYCLE, symbol="K", source=DYREMI, assumes=PEAK,
             latex=r"m_\mathrm{rec}\,a+\left(p-p_{0}\right)A")  # fmt: skip
    def K(self) -> Array:
        return axial_force(self.m_rec, self.omega, self.r, self.A, self.motion, self.p, self.p_0)

    @profile("N", "wall force", along=CYCLE, symbol="F_{41y}", source=DYREMI,
             latex=r"-K\,\tan\varphi-\frac{\Delta I_{c}\,\ddot{\varphi}}{l\cos\varphi}")  # fmt: skip
    def F_41y(self) -> Array:
        return wall_force_Rao_Singh_1993(self.K, self.dI_c, self.omega, self.r, self.motion)

    @formula("N", "wall force max", symbol=r"F_\mathrm{41,max}")
    def F_41_max(self) -> Array:
        return greatest_force(self.forces.wall)

    @profile("N", "crankpin load x", along=CYCLE, symbol="F_{32x}", source=DYREMI,
             latex=r"m_{3A}\,\omega^{2}r\cos\theta-K")  # fmt: skip
    def F_32x(self) -> Array:
        return crankpin_load_x_Rao_Singh_1993(self.m_3A, self.omega, self.r, self.K, self.motion)

    @profile("N", "crankpin load y", along=CYCLE, symbol="F_{32y}", source=DYREMI,
             latex=r"m_{3A}\,\omega^{2}r\sin\theta-F_{41y}")  # fmt: skip
    def F_32y(self) -> Array:
        return crankpin_load_y_Rao_Singh_1993(self.m_3A, self.omega, self.r, self.F_41y, self.motion)

    @formula("N", "crankpin load max", symbol=r"F_\mathrm{32,max}")
    def F_32_max(self) -> Array:
        return greatest_force(self.forces.crankpin(self.m_3A))

    @profile("N", "main load x", along=CYCLE, symbol="F_{12x}", source=DYREMI,
             latex=r"K-M\,\omega^{2}r\cos\theta")  # fmt: skip
    def F_12x(self) -> Array:
        return main_load_x_Rao_Singh_1993(self.M, self.omega, self.r, self.K, self.motion)

    @profile("N", "main load y", along=CYCLE, symbol="F_{12y}", source=DYREMI,
             latex=r"F_{41y}-M\,\omega^{2}r\sin\theta")  # fmt: skip
    def F_12y(self) -> Array:
        return main_load_y_Rao_Singh_1993(self.M, self.omega, self.r, self.F_41y, self.motion)

    @formula("N", "main load max", symbol=r"F_\mathrm{12,max}")
    def F_12_max(self) -> Array:
        return greatest_force(self.forces.main(self.M))

    @profile("N", "wristpin load x", along=CYCLE, symbol="F_{34x}", source=DYREMI, assumes=PEAK,
             latex=r"m_{4}\,a+\left(p-p_{0}\right)A")  # fmt: skip
    def F_34x(self) -> Array:
        return wristpin_load_x(self.m_4, self.omega, self.r, self.A, self.motion, self.p, self.p_0)

    @profile("N", "wristpin load y", along=CYCLE, symbol="F_{34y}", source=DYREMI, latex="F_{41y}")
    def F_34y(self) -> Array:
        return 1 * self.F_41y

    @formula("N", "wristpin load max", symbol=r"F_\mathrm{34,max}")
    def F_34_max(self) -> Array:
        return greatest_force(self.forces.wristpin())

    @profile("N*m", "correction torque", along=CYCLE, symbol="T_{c}", source=DYREMI, absent=NO_INERTIA,
             latex=r"\Delta I\,\ddot{\varphi}\,\frac{\cos\theta}{n\cos\varphi}")  # fmt: skip
    def T_c(self) -> Array:
        return correction_torque(self.dI, self.omega, self.motion)

    @profile("N*m", "torque", along=CYCLE, symbol="T", source=DYREMI,
             latex=r"K\left(\cos\theta+n\cos\varphi\right)r\tan\varphi"
                   r"+\Delta I_{c}\,\ddot{\varphi}\,\frac{\cos\theta}{n\cos\varphi}")  # fmt: skip
    def T(self) -> Array:
        return torque_Rao_Singh_1993(self.K, self.r, self.dI_c, self.omega, self.motion)

    @formula("N*m", "indicated mean torque", name="mean_torque", symbol=r"\overline{T}")
    def T_mean(self) -> Array:
        return self.p_mi * self.A * self.s / (np.pi * self.strokes)

    @formula("kW", "indicated mean power", name="mean_power", symbol="P")
    def P(self) -> Array:
        return self.T_mean * self.omega
