"""Group: the cylinders of an engine, which may differ, with their mechanisms and their gas."""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, curve, given, require, shared
from templates.groups.cylinder_gas import CylinderGas
from templates.physics.engine.engine_gas import engine_gas
from templates.physics.engine.engine_sizes import crank_of, is_either, is_within, masses_of
from templates.physics.engine.gas_pressure import GasCycle
from templates.physics.engine.offset_crank import OffsetCrank, RodMasses, turns_through

EACH = "cylinders"


class CylinderSizes(Template):
    """The crank mechanisms of an engine's cylinders, which may differ."""

    omega: Array = given("rpm", "speed", ge=-1e6, le=1e6)
    strokes: Array = given("1", "strokes", symbol="z", integer=True, single=True, ge=2, le=4)
    step: Array = given("deg", "crank angle step", symbol=r"\Delta\theta", default="2 deg", single=True,
                        ge=0.1, le=60)  # fmt: skip
    s: Array = curve("mm", "stroke", along=EACH, constant=True, alternative=True, gt=0, le=1e5)
    r_g: Array = curve("mm", "crank radius", along=EACH, constant=True, alternative=True, gt=0, le=1e5,
                       symbol=r"r_{c}")  # fmt: skip
    l: Array = curve("mm", "rod length", along=EACH, constant=True, gt=0, le=1e5, symbol="l")  # noqa: E741
    e: Array = curve("mm", "cylinder offset", along=EACH, constant=True, default="0 mm", ge=-1e5, le=1e5)
    D: Array = curve("mm", "bore", along=EACH, constant=True, ge=0, le=1e4)
    m_3: Array = curve("kg", "rod mass", along=EACH, constant=True, ge=0, le=1e5)
    b_g: Array = curve("mm", "rod centre", along=EACH, constant=True, ge=0, le=1e5)
    I_3: Array = curve("kg*m**2", "rod inertia", along=EACH, constant=True, alternative=True, ge=0, le=1e6)
    m_4: Array = curve("kg", "piston mass", along=EACH, constant=True, ge=0, le=1e5)
    U_c: Array = curve("kg*mm", "crank unbalance", along=EACH, constant=True, default="0 kg*mm", ge=-1e8,
                       le=1e8, assumed="the throws have no unbalance")  # fmt: skip
    f_p: Array = curve("1", "pressure factor", along=EACH, constant=True, default="1", ge=0, le=100)

    @require("stroke", "crank_radius", remedy="give one of them, in mm", missing=True)
    def one_of_two(self) -> Truth:
        """Either the stroke or the crank radius is given, not both."""
        return is_either(self.s, self.r_g)

    @require("rod_length", "stroke", "crank_radius", "cylinder_offset", remedy="take a longer rod")
    def rod_is_long_enough(self) -> Truth:
        """The rod is longer than crank radius plus offset."""
        return turns_through(self.s, self.r_g, self.l, self.e)

    @require("rod_centre", "rod_length", remedy="it is counted from the big end")
    def centre_on_the_rod(self) -> Truth:
        """The rod's centre of mass lies between its ends."""
        return is_within(self.b_g, self.l)


class EngineCylinders(CylinderGas, CylinderSizes):
    """The cylinders of an engine, which may differ, with their mechanisms and their gas."""

    @shared
    def crank(self) -> OffsetCrank:
        """Return the mechanisms."""
        return crank_of(self.s, self.r_g, self.l, self.e)

    @shared
    def rods(self) -> RodMasses:
        """Return the rods as two masses each."""
        return masses_of(self.m_3, self.b_g, self.I_3, self.l)

    @shared
    def m_rec(self) -> Array:
        """Return the mass that moves with each piston [kg]."""
        return self.rods.at_piston + self.m_4

    @shared
    def gas(self) -> GasCycle:
        """Return the gas cycle of each cylinder."""
        return engine_gas(
            self.gas_cycle,
            self.strokes,
            self.crank,
            self.charge,
            self.valves,
            self.theta_p,
            self.p_t,
            self.p_0,
        )
