"""Gas cycles of engines and their work: ideal Otto, ideal Diesel, practical four-stroke, tabulated.

The first three share one sequence of events. Between inlet opening and exhaust closing, in either order, the
pressure changes linearly in crank angle from exhaust to intake pressure. It is constant until the inlet
closes, follows a polytrope to top dead centre, stays constant during combustion until the volume is `cutoff`
times that at dead centre, and follows a polytrope until the exhaust opens. Then it falls linearly to the
exhaust pressure at bottom dead centre (instantly if the exhaust opens later), and stays constant during
exhaust.

Otto has cutoff 1, and Diesel burns at the final compression pressure; in both, valves open and close at dead
centres. In two-stroke engines the gas exchange is at bottom dead centre. Polytropes need absolute pressures.

References
----------
S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94, names the parameters of the practical
    cycle, but not the pressure while valves open and overlap, which is defined above.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.physics.engine.gas_pressure import GasCycle, NoGas, TabulatedCycle, one_cycle
from templates.physics.engine.slider_crank import Motion, angle_of_travel, travel_integral

_SAME = 1e-9
"""Angles closer than this [rad] are equal: at an event the pressure is that after it, despite rounding."""


@dataclass(frozen=True)
class Valves:
    """Crank angles of valve events [rad]; in a four-stroke engine about 0 and 720°, 180°, 540°."""

    inlet_opens: Array
    inlet_closes: Array
    exhaust_opens: Array
    exhaust_closes: Array


AT_DEAD_CENTRES = Valves(*(np.asarray(turns * np.pi) for turns in (0, 1, 3, 4)))


@dataclass(frozen=True)
class Charge:
    """Pressures [Pa], volume ratios and exponents [1] of a cycle."""

    suction: Array
    exhaust: Array
    combustion: Array
    compression_ratio: Array
    cutoff: Array
    compression_exponent: Array
    expansion_exponent: Array


@dataclass(frozen=True)
class Polytropic(GasCycle):
    """The sequence of events, by the crank angles [rad] at which they begin or end; n = l/r [1]."""

    charge: Charge
    n: Array
    cycle: float
    firing: float
    exchange_begins: Array
    exchange_ends: Array
    inlet_closes: Array
    exhaust_opens: Array
    emptied: float

    def in_every_cylinder(self, holds: Truth) -> Truth:
        """Return whether a condition is true for every cylinder; here there is only one."""
        return holds

    def greatest(self, value: Array) -> Array:
        """Return the greatest value over all cylinders; here there is only one."""
        return value

    def pressure(self, theta: Array, travel: Array) -> Array:
        """Return the pressure, computed for the event of the cycle in which each angle lies."""
        c = self.charge
        start = _column(self.exchange_begins)
        place = (theta - start + _SAME) % self.cycle - _SAME

        def until(angle: Array | float) -> NDArray[np.bool_]:
            return place < _column(angle) - start - _SAME

        volume = 1 / (_column(c.compression_ratio) - 1) + travel
        p_s, p_e, p_3, p_o = (_column(p) for p in (c.suction, c.exhaust, c.combustion, self.p_opened))
        expanded = np.minimum(
            _column(self.v_cut) / volume, 1.0
        )  # exactly 1 at the end of combustion, despite rounding
        overlap = _column(self.exchange_ends) - start
        opened = _column(self.exhaust_opens)
        emptying = np.where(self.emptied > opened, self.emptied - opened, 1)
        events: list[tuple[Array | float, Array]] = [
            (self.exchange_ends, p_e + (p_s - p_e) * place / np.where(overlap > 0, overlap, 1)),
            (self.inlet_closes, p_s),
            (self.firing, p_s * (_column(self.v_closed) / volume) ** _column(c.compression_exponent)),
            (self.cut, p_3),
            (self.exhaust_opens, p_3 * expanded ** _column(c.expansion_exponent)),
            (self.emptied, p_o + (p_e - p_o) * (place + start - opened) / emptying),
        ]
        p = p_e + 0 * volume
        for end, during in reversed(events):
            p = np.where(until(end), during, p)
        return p

    @cached_property
    def v_dead(self) -> Array:
        """Return the volume at top dead centre; all volumes are relative to the swept volume."""
        return 1 / (self.charge.compression_ratio - 1)

    @cached_property
    def v_closed(self) -> Array:
        """Return the volume at inlet closing."""
        return self.volume(self.inlet_closes)

    @cached_property
    def v_cut(self) -> Array:
        """Return the volume at the end of combustion."""
        return self.charge.cutoff * self.v_dead

    @cached_property
    def v_opened(self) -> Array:
        """Return the volume at exhaust opening."""
        return self.volume(self.exhaust_opens)

    @cached_property
    def p_opened(self) -> Array:
        """Return the pressure at exhaust opening."""
        c = self.charge
        return c.combustion * (self.v_cut / self.v_opened) ** c.expansion_exponent

    @cached_property
    def p_compressed(self) -> Array:
        """Return the pressure at the end of compression."""
        return self.charge.suction * (self.v_closed / self.v_dead) ** self.charge.compression_exponent

    @cached_property
    def cut(self) -> Array:
        """Return the crank angle at which combustion ends."""
        return self.firing + angle_of_travel((self.charge.cutoff - 1) * self.v_dead, self.n)

    def volume(self, angle: Array | float) -> Array:
        """Return the volume at one angle per point."""
        return self.v_dead + self.way(angle)

    def way(self, angle: Array | float) -> Array:
        """Return the travel of the piston from top dead centre per stroke, at one angle per point."""
        return _travel(angle, self.n)

    def way_between(self, begin: Array, end: Array) -> Array:
        """Return the integral of the travel between two angles [rad]."""
        return travel_integral(end, self.n) - travel_integral(begin, self.n)

    def mean_effective(self) -> Array:
        """Return the work of all events in closed form, per swept volume."""
        c, dead = self.charge, self.v_dead
        end = np.maximum(self.exhaust_opens, self.emptied)
        return (
            self._linear_work(self.exchange_begins, self.exchange_ends, c.exhaust, c.suction)
            + c.suction * (self.way(self.inlet_closes) - self.way(self.exchange_ends))
            + _polytropic_work(c.suction, self.v_closed, dead, c.compression_exponent)
            + c.combustion * (c.cutoff - 1) * dead
            + _polytropic_work(c.combustion, self.v_cut, self.v_opened, c.expansion_exponent)
            + self._linear_work(self.exhaust_opens, end, self.p_opened, c.exhaust)
            + c.exhaust * (self.way(self.exchange_begins) - self.way(end))
        )

    def corners(self) -> Array:
        """Return the angles of events at which the pressure may jump, and of the end of combustion."""
        events = (
            self.exchange_begins,
            self.exchange_ends,
            np.asarray(self.firing),
            self.cut,
            self.exhaust_opens,
        )
        return np.stack(np.broadcast_arrays(*events), axis=-1)

    def _linear_work(self, begin: Array, end: Array, p_1: Array, p_2: Array) -> Array:
        """Return the work while the pressure changes linearly in angle from p_1 to p_2; 0 if instantly."""
        angle = end - begin
        slope = (p_2 - p_1) / np.where(angle > 0, angle, 1)
        work = p_2 * self.way(end) - p_1 * self.way(begin) - slope * self.way_between(begin, end)
        return np.where(angle > 0, work, 0.0)


def _column(value: Array | float) -> Array:
    return np.asarray(value)[..., None]


def _travel(angle: Array | float, n: Array) -> Array:
    return Motion(np.asarray(angle), n).travel


def _polytropic_work(p_1: Array, v_1: Array, v_2: Array, exponent: Array) -> Array:
    """Return the work along p v^k: p_1 v_1 (1 − (v_1/v_2)^(k − 1))/(k − 1), also for k = 1."""
    power = (exponent - 1) * np.log(v_2 / v_1)
    mean = np.where(power == 0, 1.0, -np.expm1(-power) / np.where(power == 0, 1.0, power))
    return p_1 * v_1 * np.log(v_2 / v_1) * mean


def gas_cycle(
    name: str, strokes: Array, n: Array, charge: Charge, valves: Valves, angle: Array, p: Array, p_c: Array
) -> GasCycle:
    """Return the named gas cycle.

    `angle` [rad] and `p` [Pa] are the table, `p_c` [Pa] is the crankcase pressure.
    """
    cycle = float(np.pi * strokes)
    if name == "none":
        return NoGas(np.asarray(p_c))
    if name == "table":
        return TabulatedCycle(*one_cycle(angle, p, cycle), n, cycle)
    if name != "four_stroke":
        charge, valves = ideal(name, charge), AT_DEAD_CENTRES
    if strokes == 2:
        begins, ends, closes, opens = (np.asarray(turns * np.pi) for turns in (1, 1, 1, 3))
    else:
        io, ec = wrapped(valves.inlet_opens), wrapped(valves.exhaust_closes)
        begins, ends = np.minimum(io, ec), np.maximum(io, ec)
        closes, opens = valves.inlet_closes, valves.exhaust_opens
    return Polytropic(charge, n, cycle, 2 * np.pi, begins, ends, closes, opens, 3 * np.pi)


def ideal(name: str, charge: Charge) -> Charge:
    """Return an ideal cycle: Otto burns at top dead centre, Diesel at the final compression pressure."""
    if name == "otto":
        return replace(charge, cutoff=np.asarray(1.0))
    return replace(charge, combustion=charge.suction * charge.compression_ratio**charge.compression_exponent)


def wrapped(angle: Array) -> Array:
    """Return a crank angle [rad] of a four-stroke cycle, wrapped to −360° … 360°."""
    return (angle + 2 * np.pi) % (4 * np.pi) - 2 * np.pi
