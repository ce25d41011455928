"""Group: rod and wall forces, torque, energy and shaking forces of an engine over its cycle."""

from __future__ import annotations

from templates.core.language.template import Array, Truth, curve, formula, profile, require, shared, text
from templates.groups.engine_balance import EngineBalance
from templates.groups.engine_cylinders import EACH
from templates.physics.crankshaft.main_bearings import (
    Vectors,
    along_x,
    along_y,
    in_engine_axes,
    moment_about_x,
    moment_about_y,
)
from templates.physics.engine.crank_loads import greatest_force
from templates.physics.engine.engine_curves import (
    Parts,
    Rotors,
    area_curve,
    areas_in_words,
    balancers,
    balancers_are_whole,
    energy_curve,
    piston_shaking,
    pressure_curves,
    roll_moment,
    running_energy,
    swing_of,
    torque,
    torque_curve,
)
from templates.physics.engine.engine_gas import corners, gas_force, indicated, pressures, torque_of_work
from templates.physics.engine.engine_sizes import is_manageable
from templates.physics.engine.offset_crank import RodMotion, axial_force, pin_force, rod_speed, wall_force
from templates.physics.engine.slider_crank import crank_angles
from templates.physics.numerics.crank_grid import COARSE, CrankGrid, crank_grid

CYCLE, SHAFTS = "crank_angle", "balance_shafts"
STILL = "no torque that varies"


class EngineMotion(EngineBalance):
    """Rod and wall forces, torque, energy and shaking forces of an engine over its cycle."""

    U_b: Array = curve("kg*mm", "balancer unbalance", along=SHAFTS, alternative=True, ge=0, le=1e8)
    i_b: Array = curve("1", "balancer ratios", along=SHAFTS, alternative=True, integer=True, ge=-4, le=4)
    a_b: Array = curve(
        "deg", "balancer phases", along=SHAFTS, constant=True, default="0 deg", ge=-360, le=360
    )
    z_b: Array = curve("mm", "balancer positions", along=SHAFTS, alternative=True, ge=-1e6, le=1e6)

    @require("crank_angle_step", remedy="take a larger step, or fewer points at once")
    def manageable(self) -> Truth:
        """Points times cylinders times crank angles, at 1 deg or the step, are at most 6 000 000."""
        return is_manageable(self.shape_of_points(), self.layout.throw, self.strokes, self.step)

    @require("crank_angle_step", warning="coarse_curves",
             remedy="take 5 deg or less for curves; greatest loads and energy do not change")  # fmt: skip
    def shows_peaks(self) -> Truth:
        """Curves are returned at steps of at most 5 deg, which show their peaks."""
        return self.step <= COARSE

    @require("balancer_unbalance", "balancer_ratios", "balancer_positions", missing=True,
             remedy="give three lists, of one value for each balance shaft")  # fmt: skip
    def balancers_are_whole(self) -> Truth:
        """Each balance shaft has an unbalance, a speed ratio to the crank and a position."""
        return balancers_are_whole(self.U_b, self.i_b, self.z_b)

    @profile("deg", "crank angle", along=CYCLE, symbol=r"\theta", latex=r"k\,\Delta\theta")
    def theta(self) -> Array:
        """Crank angles of one cycle."""
        return crank_angles(self.strokes, self.step)

    @shared
    def grid(self) -> CrankGrid:
        """Return the crank angles of the calculation, some of which are returned."""
        return crank_grid(self.strokes, self.step, corners(self.gas, self.layout))

    @shared
    def motion(self) -> RodMotion:
        """Return the mechanisms at all angles."""
        return self.crank.at(self.layout.alpha(self.grid.theta))

    @shared
    def pressures(self) -> Array:
        """Return the pressure in each cylinder [Pa], (…, N, K)."""
        return pressures(self.gas, self.layout, self.motion, self.grid.theta)

    @shared
    def gas_forces(self) -> Array:
        """Return the force of the gas on each piston [N], (…, N, K)."""
        return gas_force(self.pressures, self.p_0, self.f_p, self.D)

    @shared
    def axial(self) -> Array:
        """Return the force along each cylinder with which the crank drives the piston against the gas [N]."""
        return axial_force(self.m_rec, self.omega[..., None], self.motion, self.gas_forces)

    @shared
    def wall(self) -> Array:
        """Return the force of each piston on its wall [N]."""
        return wall_force(self.axial, self.rods.excess, self.omega[..., None], self.motion)

    @shared
    def rod_forces(self) -> Vectors:
        """Return the force of each rod on its pin in the cylinder's axes [N], complex."""
        return pin_force(self.rods.at_crank, self.omega[..., None], self.motion, self.axial, self.wall)

    @shared
    def pins(self) -> Vectors:
        """Return the force of each rod on its pin in the engine's axes [N], complex."""
        return in_engine_axes(self.rod_forces, self.layout.bank)

    @shared
    def balancers(self) -> Rotors:
        """Return the balance shafts."""
        return balancers(self.U_b, self.i_b, self.a_b, self.z_b)

    @shared
    def rotors(self) -> tuple[tuple[Vectors, Array], ...]:
        """Return the forces of all parts that rotate at constant speed [N], and their positions [m]."""
        rotors = (*self.turning, self.balancers)
        return tuple((one.forces(self.omega, self.grid.theta), one.place) for one in rotors)

    @shared
    def moving(self) -> Parts:
        """Return all moving parts, with their forces on the frame."""
        return Parts(
            piston_shaking(self.m_rec, self.omega[..., None], self.motion, self.layout.bank),
            self.places,
            self.rotors,
        )

    @shared
    def shaking(self) -> Vectors:
        """Return the force of all moving parts on the frame [N], complex."""
        return self.moving.resultant()

    @shared
    def couple(self) -> Vectors:
        """Return the sum of position times force of all moving parts [N m], complex."""
        return self.moving.couple(self.z_0)

    @profile(
        "bar", "gas pressure", along=CYCLE, axes=2, symbol="p_{i}", latex=r"p\left(\theta-\varphi_{i}\right)"
    )
    def p(self) -> Array:
        """Gas pressure in each cylinder."""
        return pressure_curves(self.pressures, self.grid)

    @shared
    def torques(self) -> Array:
        """Return the torque of all rods on the crank [N m], (…, K)."""
        return torque(self.rod_forces, self.motion)

    @shared
    def energies(self) -> Array:
        """Return the running energy [J], (…, K)."""
        return running_energy(self.torques, self.grid)

    @profile("N*m", "torque", along=CYCLE, symbol="T", latex=r"\sum r\times F")
    def T(self) -> Array:
        """Torque of all rods on the crank."""
        return torque_curve(self.torques, self.grid)

    @profile("bar", "indicated mean effective pressure", along=EACH, symbol="p_{mi}",
             latex=r"\frac{1}{A\,s}\oint p\,dV")  # fmt: skip
    def p_mi(self) -> Array:
        """Indicated mean effective pressure of each cylinder, independent of the step."""
        return indicated(self.gas, self.f_p, self.layout)

    @formula("N*m", "indicated mean torque", name="mean_torque", symbol=r"\overline{T}",
             latex=r"\frac{1}{\pi\,z}\sum p_{mi}\,A\,s")  # fmt: skip
    def T_mean(self) -> Array:
        """Mean torque from the work of the gas, independent of the step."""
        return torque_of_work(self.p_mi, self.D, self.crank.stroke, self.strokes)

    @formula("kW", "indicated mean power", name="mean_power", symbol="P")
    def P(self) -> Array:
        """Mean torque times speed."""
        return self.T_mean * self.omega

    @profile("J", "running energy", along=CYCLE, symbol="E_{r}",
             latex=r"\int\left(T-\overline{T}\right)d\theta")  # fmt: skip
    def E_r(self) -> Array:
        """Energy since the first angle."""
        return energy_curve(self.energies, self.grid)

    @formula("J", "energy fluctuation", symbol=r"\Delta E")
    def dE(self) -> Array:
        """Largest minus smallest running energy, independent of the step."""
        return swing_of(self.energies)

    @profile("J", "energy area", along=CYCLE, symbol="A_{E}")
    def A_E(self) -> Array:
        """The whole energy area to which each angle belongs."""
        return area_curve(self.theta, self.torques, self.grid)

    @text("energy areas", absent=STILL)
    def areas(self) -> str | Array:
        """All energy areas."""
        return areas_in_words(self.torques, self.grid)

    @profile("N", "shaking force x", along=CYCLE, symbol="F_{x}")
    def F_x(self) -> Array:
        """Force of all moving parts on the frame."""
        return along_x(self.shaking, self.grid)

    @profile("N", "shaking force y", along=CYCLE, symbol="F_{y}")
    def F_y(self) -> Array:
        """Force of all moving parts on the frame."""
        return along_y(self.shaking, self.grid)

    @formula("N", "shaking force max", symbol=r"F_\mathrm{max}")
    def F_max(self) -> Array:
        """Largest force over the cycle, independent of the step."""
        return greatest_force(self.shaking)

    @profile("N*m", "shaking moment x", along=CYCLE, symbol="M_{x}")
    def M_x(self) -> Array:
        """Moment of all moving parts about the reference position."""
        return moment_about_x(self.couple, self.grid)

    @profile("N*m", "shaking moment y", along=CYCLE, symbol="M_{y}")
    def M_y(self) -> Array:
        """Moment of all moving parts about the reference position."""
        return moment_about_y(self.couple, self.grid)

    @profile("N*m", "roll moment", along=CYCLE, symbol="M_{z}")
    def M_z(self) -> Array:
        """Moment of cylinder walls and heads on the frame."""
        return roll_moment(self.wall, self.gas_forces, self.motion, self.grid)

    @profile("rad/s", "rod angular velocity", along=CYCLE, axes=2, symbol=r"\omega_{3}")
    def omega_3(self) -> Array:
        """Angular velocity of each rod."""
        return rod_speed(self.omega, self.motion, self.grid)
