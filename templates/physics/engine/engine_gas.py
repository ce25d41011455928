"""Gas pressure in cylinders that may differ: the cycles of `gas_cycle` for offset cranks."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.engine.engine_layout import TURN, Layout
from templates.physics.engine.gas_cycle import AT_DEAD_CENTRES, Charge, Polytropic, Valves, ideal, wrapped
from templates.physics.engine.gas_pressure import GasCycle, NoGas, TabulatedCycle, one_cycle
from templates.physics.engine.offset_crank import OffsetCrank, RodMotion

_HALVINGS = 60
_NODES = 128  # Gauss points for the gas exchange, where the integrand is smooth
_NODES_A_RADIAN = 24  # Gauss points per radian between two angles of a table


@dataclass(frozen=True)
class OffsetPolytropic(Polytropic):
    """The polytropic cycle with the volumes of an offset crank; angles are measured from top dead centre."""

    crank: OffsetCrank

    def in_every_cylinder(self, holds: Truth) -> Truth:
        """Return whether a condition is true for every cylinder (last axis)."""
        return np.all(holds, axis=-1)

    def greatest(self, value: Array) -> Array:
        """Return the greatest value over all cylinders (last axis)."""
        return np.max(value, axis=-1)

    def way(self, angle: Array | float) -> Array:
        """Return the travel of each piston from top dead centre, relative to its stroke."""
        turned = np.asarray(angle + self.crank.top)[..., None]
        return self.crank.travel(turned)[..., 0]

    def way_between(self, begin: Array, end: Array) -> Array:
        """Return the integral of the travel between two angles [rad], by Gauss's rule."""
        node, weight = np.polynomial.legendre.leggauss(_NODES)
        middle, half = np.asarray(end + begin) / 2, np.asarray(end - begin) / 2
        angle = middle[..., None] + half[..., None] * node + self.crank.top[..., None]
        return half * (self.crank.travel(angle) @ weight)

    @cached_property
    def cut(self) -> Array:
        """Return the crank angle at which combustion ends, by bisection between dead centres."""
        wanted = self.v_cut
        low, high = 0 * wanted, 0 * wanted + np.pi
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            reached = self.volume(middle) >= wanted
            low, high = np.where(reached, low, middle), np.where(reached, middle, high)
        return self.firing + high


@dataclass(frozen=True)
class OffsetTabulatedCycle(TabulatedCycle):
    """A table of pressures with the volumes of an offset crank; angles are measured from top dead centre."""

    crank: OffsetCrank

    def mean_effective(self) -> Array:
        """Return the work of a cycle per swept volume [Pa]: −dp/dθ times the integral of travel."""
        width = np.diff(self.angle, append=self.angle[0] + self.cycle)
        count = 6 + int(np.ceil(_NODES_A_RADIAN * width.max()))
        node, weight = np.polynomial.legendre.leggauss(count)
        angle = self.angle[:, None] + width[:, None] * (1 + node) / 2
        travel = self.crank.travel(angle.ravel() + self.crank.top[..., None])
        way = travel.reshape(*travel.shape[:-1], *angle.shape) @ (weight / 2)
        rise = np.diff(self.p, append=self.p[..., :1])
        return -np.sum(rise[..., None, :] * way, axis=-1)


def _for_each(record: Charge | Valves) -> list[Array]:
    """Return the numbers of a record with an additional axis for the cylinders."""
    return [np.asarray(getattr(record, field.name))[..., None] for field in fields(record)]


def engine_gas(
    name: str, strokes: Array, crank: OffsetCrank, charge: Charge, valves: Valves, angle: Array, p: Array,
    p_c: Array,
) -> GasCycle:  # fmt: skip
    """Return the named gas cycle for each cylinder, (…, N); `angle` [rad] and `p` [Pa] are the table.

    `p_c` [Pa] is the crankcase pressure.
    """
    cycle = float(np.pi * strokes)
    if name == "none":
        return NoGas(np.asarray(p_c)[..., None])
    if name == "table":
        return OffsetTabulatedCycle(*one_cycle(angle, p, cycle), crank.l / crank.r, cycle, crank)
    if name != "four_stroke":
        charge, valves = ideal(name, charge), AT_DEAD_CENTRES
    each = Charge(*_for_each(charge))
    io, closes, opens, ec = _for_each(valves)
    if strokes == 2:
        begins, ends, closes, opens = (np.asarray([turns * np.pi]) for turns in (1, 1, 1, 3))
    else:
        begins, ends = np.minimum(wrapped(io), wrapped(ec)), np.maximum(wrapped(io), wrapped(ec))
    return OffsetPolytropic(
        each, crank.l / crank.r, cycle, 2 * np.pi, begins, ends, closes, opens, 3 * np.pi, crank
    )


def pressures(gas: GasCycle, layout: Layout, motion: RodMotion, theta: Array) -> Array:
    """Return the pressure in each cylinder [Pa], (…, N, K), at crank angles theta [rad], (…, K)."""
    own = theta[..., None, :] - layout.firing[..., None] + _firing(layout)
    return gas.pressure(own, motion.crank.travel(motion.alpha))


def corners(gas: GasCycle, layout: Layout) -> Array:
    """Return the crank angles [rad] of the jumps and peaks of the pressure in all cylinders, (…, J)."""
    angles = gas.corners() - _firing(layout) + layout.firing[..., None]
    return angles.reshape(*angles.shape[:-2], -1)


def _firing(layout: Layout) -> float:
    """Return the angle of the gas cycle [rad] at which a cylinder fires."""
    return TURN if layout.strokes == 4 else 0.0


@units(None, "1", None, returns="Pa")
def indicated(gas: GasCycle, factor: Array, layout: Layout) -> Array:
    """Return the indicated mean effective pressure [Pa] of each cylinder, (…, N), times its factor."""
    mean = np.atleast_1d(factor) * gas.mean_effective()
    return np.broadcast_to(mean, (*mean.shape[:-1], layout.firing.shape[-1]))


@units("Pa", "m", None, "1", returns="N*m")
def torque_of_work(p_mi: Array, bore: Array, stroke: Array, strokes: Array) -> Array:
    """Return the mean torque [N m] from the work of all cylinders in a cycle of the given strokes."""
    work = p_mi * np.pi * np.atleast_1d(bore) ** 2 / 4 * np.atleast_1d(stroke)
    return np.asarray(work.sum(axis=-1) / (np.pi * strokes))[()]


def gas_force(p: Array, p_c: Array, factor: Array, bore: Array) -> Array:
    """Return the force of the gas on each piston towards the crank [N], (…, N, K).

    `factor` multiplies the pressure.
    """
    area = np.atleast_1d(np.pi * bore**2 / 4)[..., None]
    return area * (np.atleast_1d(factor)[..., None] * p - np.asarray(p_c)[..., None, None])
