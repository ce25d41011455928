"""Forced torsional vibration of an engine's train: torque, twist and stress of each shaft over the speeds.

The train consists of inertias, shafts, branches, gears, dampers and a propeller. The gas and inertia torques
of the cylinders excite it.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import (
    Array,
    Truth,
    curve,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.torsion_train import INERTIAS, NUMBERS, SHAFTS, TorsionTrain
from templates.physics.shafts.torsion_orders import critical_speeds
from templates.physics.torsion.engine_train import (
    are_excited,
    fire_each,
    has_its_speed,
    is_manageable,
    propeller_of,
    response_of,
    train_of,
)
from templates.physics.torsion.forced_train import Response, Train
from templates.physics.torsion.response_measures import (
    amplitudes_of_orders,
    heat_of_shafts,
    irregularity,
    largest_of_angles,
    largest_of_powers,
    largest_of_stresses,
    largest_of_torques,
    loss_of_inertias,
    order_of_largest,
    power_error,
    power_lost,
    power_put_in,
    speed_of_largest,
    speed_spectrum,
    stress_envelope,
    stress_of,
    torque_envelope,
    vibratory_angle,
    vibratory_torque,
    vibratory_twist,
)
from templates.physics.torsion.torque_harmonics import (
    Excitation,
    closes,
    excitation,
    is_one_cycle,
    orders_of,
    resolves,
)
from templates.physics.torsion.train_layout import exist, turn_alike
from templates.physics.torsion.train_modes import mode_shapes, natural_frequencies

CYLINDERS, ANGLE, SPEEDS, ORDERS = "cylinders", "crank_angle", "speeds", "engine_orders"
RESONANT = (
    "a speed lies on a resonance without damping, or values are out of scale: give `shaft_damping`, "
    "`loss_factors` or `absolute_damping`, take other speeds, or check the units"
)
NO_SECTION = "no section modulus is given"


class ForcedTorsion(TorsionTrain):
    """Forced torsional vibration of an engine's train: torque, twist and stress of each shaft over speed.

    The train has inertias, shafts, branches, gears, dampers and a propeller, and is excited by gas and
    inertia torque of cylinders.

    Limits
    ------
    Linear, steady: inertias do not depend on the crank angle, and the mean speed is constant.
    Inertias are numbered from 1. Shaft s connects shaft_from[s] to shaft_to[s]; 0 is ground. A gear makes the
    angle of gear_to its ratio times that of gear_from, negative for an external mesh; teeth are rigid,
    without backlash. Torques of a shaft are at its own speed.
    Damping of a shaft is viscous, shaft_damping, and hysteretic, loss_factors: k (1 + i eta).
    A viscous damper is an inertia on a shaft without stiffness but with damping, a tuned damper has both; a
    rubber damper has a loss factor.
    The torque of a propeller is proportional to the square of its speed; its damping is propeller_factor
    times mean torque over mean speed: 2 on its own propeller curve.
    Torques are those of the first cylinder over one cycle, at its own crank angle; the others have the same
    torque, delayed by their firing angle minus that of the first. Gas torque does not depend on speed;
    inertia torque is given at inertia_speed and is proportional to the square of speed. A gas factor of 0 is
    a misfire. A last point that repeats the first is omitted. The mean torque does not twist the shafts here.
    Vibratory torque, twist, stress and angle are half the range of the sum of all orders up to highest_order.
    Adding amplitudes would give more. Rows are shafts or inertias, columns are speeds. A power_balance_error
    below 1e-12 is rounding error, and shown as 0.
    A section modulus of 0 means that no stress is wanted for the shaft. There is no factor for notches.
    Critical speeds are those without damping; rows are orders, columns are modes. Those of modes at 0 Hz are
    0.
    At most 100 inertias, 300 shafts, 100 cylinders and 2000 speeds.

    References
    ----------
    H. Holzer: Die Berechnung der Drehschwingungen, 1921.
    W. Ker Wilson: Practical Solution of Torsional Vibration Problems, 3rd ed., 1956, for propellers.
    J. P. Den Hartog: Mechanical Vibrations, 4th ed., 1956, for tuned and viscous dampers, the check cases.
    """

    precision = 1e-7
    example = {
        "inertias": {"value": [0.06, 0.02, 0.05, 0.05, 0.9, 0.05, 0.4, 1.5], "unit": "kg*m**2"},
        "shaft_from": [1, 2, 3, 4, 5, 7],
        "shaft_to": [2, 3, 4, 5, 6, 8],
        "shaft_stiffness": {"value": [0, 400, 350, 500, 12, 90], "unit": "kN*m/rad"},
        "shaft_damping": {"value": [9, 0, 0, 0, 0, 0], "unit": "N*m*s/rad"},
        "loss_factors": [0, 0.004, 0.004, 0.004, 0.12, 0],
        "section_moduli": {"value": [0, 24, 24, 24, 0, 30], "unit": "cm**3"},
        "gear_from": [6],
        "gear_to": [7],
        "gear_ratios": [-0.4],
        "absolute_damping": {"value": [0, 0, 1, 1, 0, 0, 0, 0], "unit": "N*m*s/rad"},
        "propeller_inertia": 8,
        "propeller_torque": "900 N*m",
        "propeller_speed": "900 rpm",
        "excited_inertias": [3, 4],
        "firing_angles": {"value": [0, 360], "unit": "deg"},
        "crank_angle": {"value": list(range(0, 720, 45)), "unit": "deg"},
        "gas_torque": {
            "value": [0, 700, 400, 200, 0, -20, -30, -20, 0, 20, 30, 20, 0, -90, -200, -260], "unit": "N*m",
        },
        "inertia_torque": {
            "value": [0, -60, 0, 60, 0, -60, 0, 60, 0, -60, 0, 60, 0, -60, 0, 60], "unit": "N*m",
        },
        "inertia_speed": "1500 rpm",
        "highest_order": 2,
        "speeds": {"value": [800, 1300, 1800, 2300], "unit": "rpm"},
        "observed_inertia": 5,
    }  # fmt: skip
    main_results = ("natural_frequencies[1]", "largest_torque[1]", "largest_stress[1]", "worst_speed[1]")
    criteria = {
        "stress": {
            "require": "stress_envelope <= permissible_vibratory_stress",
            "words": "the vibratory stress of every shaft is within the permissible one at all speeds",
            "limits": {
                "permissible_vibratory_stress": {"unit": "MPa", "words": "largest amplitude of shear stress"}
            },
        },
        "torque": {
            "require": "largest_torque <= permissible_vibratory_torque",
            "words": "the vibratory torque of every shaft is within the permissible one at all speeds",
            "limits": {
                "permissible_vibratory_torque": {"unit": "N*m", "words": "largest amplitude of torque"}
            },
        },
        "heat": {
            "require": "largest_shaft_heat <= permissible_shaft_heat",
            "words": "no damper or coupling has more heat to give off than it can",
            "limits": {"permissible_shaft_heat": {"unit": "W", "words": "largest heat of one shaft"}},
        },
        "separation": {
            "require": "abs(worst_speed - (highest_running_speed + lowest_running_speed) / 2)"
            " >= (highest_running_speed - lowest_running_speed) / 2",
            "words": "no shaft has its largest vibratory torque within the running range",
            "limits": {
                "lowest_running_speed": {"unit": "rpm", "words": "lowest speed of the running range"},
                "highest_running_speed": {"unit": "rpm", "words": "highest speed of the running range"},
            },
        },
    }

    E: Array = curve("1", "excited inertias", along=CYLINDERS, integer=True, ge=1, remedy=NUMBERS)
    phi: Array = curve("deg", "firing angles", along=CYLINDERS, ge=-1440, le=1440, symbol=r"\varphi")
    f_g: Array = curve("1", "gas factors", along=CYLINDERS, constant=True, default="1", ge=0, le=100)
    theta: Array = curve("deg", "crank angle", along=ANGLE, symbol=r"\theta", ge=-1440, le=1440)
    T_g: Array = curve("N*m", "gas torque", along=ANGLE, alternative=True, ge=-1e12, le=1e12)
    T_m: Array = curve("N*m", "inertia torque", along=ANGLE, alternative=True, ge=-1e12, le=1e12)
    n_m: Array = given("rpm", "inertia speed", alternative=True, gt=0, le=1e6)
    h_max: Array = given("1", "highest order", default="12", single=True, ge=0.5, le=100)
    omega: Array = curve("rpm", "speeds", along=SPEEDS, gt=0, le=1e6, symbol=r"\omega")
    o: Array = given("1", "observed inertia", default="1", single=True, integer=True, ge=1, symbol="o",
                     remedy=NUMBERS)  # fmt: skip

    @require("excited_inertias", "inertias", remedy=NUMBERS)
    def excited_exist(self) -> Truth:
        """The excited inertias are a list of existing inertias."""
        return exist(self.J, self.E)

    @require("excited_inertias", missing=True, remedy="speeds are those of one crankshaft; reduce the other")
    def excited_alike(self) -> Truth:
        """The excited inertias have the same mean speed."""
        return turn_alike(self.layout, self.E)

    @require("firing_angles", "excited_inertias", remedy="give two lists of one value for each cylinder")
    def firing_of_each(self) -> Truth:
        """Each of at most 100 excited inertias has a firing angle."""
        return fire_each(self.E, self.phi)

    @require("observed_inertia", "inertias", remedy=NUMBERS)
    def observed_exists(self) -> Truth:
        """The observed inertia exists."""
        return exist(self.J, self.o)

    @require("crank_angle", remedy="8 to 20 000 angles over 360 deg in two strokes or 720 deg in four")
    def one_cycle(self) -> Truth:
        """The crank angles are a list that ascends in equal steps over one cycle."""
        return is_one_cycle(self.theta)

    @require("gas_torque", "inertia_torque", missing=True, remedy="give one of them or both, in N*m")
    def excited(self) -> Truth:
        """A gas torque or an inertia torque is given."""
        return are_excited(self.T_g, self.T_m)

    @require("inertia_speed", "inertia_torque", missing=True, remedy="give both, or none")
    def speed_of_inertia(self) -> Truth:
        """An inertia torque is given together with its speed."""
        return has_its_speed(self.T_m, self.n_m)

    @require("gas_torque", "crank_angle", missing=True, remedy="omit the last point")
    def gas_closes(self) -> Truth:
        """If the last crank angle closes the cycle, the gas torque there equals the first one."""
        return closes(self.theta, self.T_g)

    @require("inertia_torque", "crank_angle", missing=True, remedy="omit the last point")
    def inertia_closes(self) -> Truth:
        """If the last crank angle closes the cycle, the inertia torque there equals the first one."""
        return closes(self.theta, self.T_m)

    @require("highest_order", "crank_angle", remedy="take a lower order, or smaller steps of the crank angle")
    def resolved(self) -> Truth:
        """The cycle has more than two crank angles for each period of the highest order."""
        return resolves(self.theta, self.h_max)

    @require("speeds", "inertias", "highest_order", remedy="take fewer speeds, orders or points at once")
    def manageable(self) -> Truth:
        """There are at most 2000 speeds, and the calculation takes only seconds."""
        return is_manageable(self.shape_of_points(), self.J, self.omega, self.theta, self.h_max)

    @shared
    def train(self) -> Train:
        """Return the train."""
        return train_of(
            self.layout, self.J, self.k, self.c, self.eta, self.c_a, self.E,
            propeller_of(self.p, self.T_p, self.n_p, self.f_p),
        )  # fmt: skip

    @shared
    def excitation(self) -> Excitation:
        """Return the harmonics of one cylinder."""
        return excitation(self.theta, self.T_g, self.T_m, self.n_m, self.h_max)

    @shared
    def response(self) -> Response:
        """Return the response of the train."""
        return response_of(self.train, self.excitation, self.omega, self.E, self.f_g, self.phi)

    @profile("Hz", "natural frequencies", along="natural_frequencies", symbol="f")
    def f(self) -> Array:
        return natural_frequencies(self.train) / (2 * np.pi)

    @profile("1", "mode shapes", along=INERTIAS, axes=2, symbol=r"\phi_{m}")
    def modes(self) -> Array:
        return mode_shapes(self.train)

    @profile("1", "engine orders", along=ORDERS, symbol="h")
    def h(self) -> Array:
        return orders_of(self.theta, self.h_max)

    @profile("rpm", "critical speeds", along="natural_frequencies", axes=2, symbol="n_{c}")
    def n_c(self) -> Array:
        return critical_speeds(2 * np.pi * self.f, self.h)

    @profile("N*m", "vibratory torque", along=SPEEDS, axes=2, symbol="T_{v}", remedy=RESONANT)
    def T_v(self) -> Array:
        return vibratory_torque(self.response)

    @profile("MPa", "vibratory stress", along=SPEEDS, axes=2, symbol=r"\tau_{v}", absent=NO_SECTION)
    def tau(self) -> Array:
        return stress_of(self.T_v, self.W)

    @profile("deg", "vibratory twist", along=SPEEDS, axes=2, symbol=r"\Delta\Phi_{v}", remedy=RESONANT)
    def dPhi(self) -> Array:
        return vibratory_twist(self.response)

    @profile("deg", "vibratory angle", along=SPEEDS, axes=2, symbol=r"\Phi_{v}", remedy=RESONANT)
    def Phi(self) -> Array:
        return vibratory_angle(self.response)

    @profile("N*m", "torque of orders", along=ORDERS, axes=3, symbol="T_{h}", remedy=RESONANT)
    def T_h(self) -> Array:
        return amplitudes_of_orders(self.response)

    @profile("N*m", "largest torque", along=SHAFTS, symbol=r"T_\mathrm{v,max}")
    def T_max(self) -> Array:
        return largest_of_torques(self.T_v)

    @profile("MPa", "largest stress", along=SHAFTS, symbol=r"\tau_\mathrm{v,max}", absent=NO_SECTION)
    def tau_max(self) -> Array:
        return largest_of_stresses(self.tau)

    @profile("deg", "largest twist", along=SHAFTS, symbol=r"\Delta\Phi_\mathrm{v,max}")
    def dPhi_max(self) -> Array:
        return largest_of_angles(self.dPhi)

    @profile("deg", "largest angle", along=INERTIAS, symbol=r"\Phi_\mathrm{v,max}")
    def Phi_max(self) -> Array:
        return largest_of_angles(self.Phi)

    @profile("rpm", "worst speed", along=SHAFTS, symbol=r"n_\mathrm{v,max}")
    def n_max(self) -> Array:
        return speed_of_largest(self.T_v, self.omega)

    @profile("1", "worst order", along=SHAFTS, symbol=r"h_\mathrm{v,max}")
    def h_worst(self) -> Array:
        return order_of_largest(self.T_v, self.T_h, self.h)

    @profile("N*m", "torque envelope", along=SPEEDS, symbol=r"\hat{T}_{v}")
    def T_e(self) -> Array:
        return torque_envelope(self.T_v)

    @profile("MPa", "stress envelope", along=SPEEDS, symbol=r"\hat{\tau}_{v}", absent=NO_SECTION)
    def tau_e(self) -> Array:
        return stress_envelope(self.tau)

    @profile("W", "shaft heat", along=SPEEDS, axes=2, symbol="P_{s}", remedy=RESONANT)
    def P_s(self) -> Array:
        return heat_of_shafts(self.response)

    @profile("W", "largest shaft heat", along=SHAFTS, symbol=r"P_\mathrm{s,max}")
    def P_s_max(self) -> Array:
        return largest_of_powers(self.P_s)

    @profile("W", "inertia loss", along=SPEEDS, axes=2, symbol="P_{a}", remedy=RESONANT)
    def P_a(self) -> Array:
        return loss_of_inertias(self.response)

    @profile("W", "power in", along=SPEEDS, symbol=r"P_\mathrm{in}", remedy=RESONANT)
    def P_in(self) -> Array:
        return power_put_in(self.response)

    @profile("W", "power lost", along=SPEEDS, symbol=r"P_\mathrm{lost}")
    def P_lost(self) -> Array:
        return power_lost(self.P_s, self.P_a)

    @formula("1", "power balance error", symbol=r"\epsilon_{P}")
    def error(self) -> Array:
        return power_error(self.P_in, self.P_lost, self.response)

    @profile("rad/s", "angular speed spectrum", along=ORDERS, axes=2, symbol=r"\Omega_{h}", remedy=RESONANT)
    def spectrum(self) -> Array:
        return speed_spectrum(self.response, self.o)

    @profile("1", "irregularity", along=SPEEDS, symbol=r"\delta_{o}", remedy=RESONANT)
    def delta(self) -> Array:
        return irregularity(self.response, self.o, self.omega)
