"""Check the data of a gas cycle for completeness and order, for use in rules of templates."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.engine.gas_cycle import Polytropic, wrapped
from templates.physics.engine.gas_pressure import GasCycle
from templates.physics.numerics.crank_grid import angles_in

CYCLES = ("none", "otto", "diesel", "four_stroke", "table")
POLYTROPIC, GIVEN_PEAK = ("otto", "diesel", "four_stroke"), ("otto", "four_stroke")
GAUGE = "the crankcase has 0 bar: gas pressures count from it, as gauge pressures"
FEWEST = 8  # points of a table
MOST_VALUES = 2_000_000  # of a curve over all points
_QUARTER = np.pi / 2


@units(None, None, None, returns="1")
def known_for(name: str, cycles: tuple[str, ...], value: Array) -> Truth:
    """Return whether a value is given at each point whose cycle needs the value."""
    return np.logical_or(name not in cycles, ~np.isnan(value))


@units(None, "Pa", returns="1")
def table_is_known(name: str, p: Array) -> Truth:
    """Return whether a table is given, if the cycle needs one."""
    return name != "table" or np.ndim(p) > 0


@units("rad", "rad", "rad", "rad", returns="1")
def valves_in_order(io: Array, ic: Array, eo: Array, ec: Array) -> Truth:
    """Return whether inlet opening and exhaust closing lie within 90° of gas-exchange dead centre."""
    near = (np.abs(wrapped(io)) <= _QUARTER) & (np.abs(wrapped(ec)) <= _QUARTER)
    return near & (ic >= _QUARTER) & (eo <= 4 * np.pi - _QUARTER)


@units(None, None, returns="1")
def burns_before_exhaust(name: str, gas: Callable[[], GasCycle]) -> Truth:
    """Return whether combustion ends before the exhaust opens; other rules report missing inputs."""
    if name not in POLYTROPIC or not isinstance(cycle := gas(), Polytropic):
        return True
    return cycle.in_every_cylinder(~(cycle.v_cut >= cycle.v_opened))


@units(None, None, returns="Pa")
def end_of_compression(name: str, gas: Callable[[], GasCycle]) -> Array:
    """Return the pressure [Pa] at the end of compression; 0 if no rule needs it.

    For several cylinders it is the greatest, reduced by 1e-12 to allow for rounding.
    """
    if name not in GIVEN_PEAK or not isinstance(cycle := gas(), Polytropic):
        return np.asarray(0.0)
    return cycle.greatest(cycle.p_compressed) * (1 - 1e-12)


@units(None, "rad", "Pa", returns="1")
def angles_rise(name: str, angle: Array, p: Array) -> Truth:
    """Return whether a table has no angles, or one ascending list with an angle for each pressure."""
    if name != "table" or np.ndim(angle) == 0:
        return True
    return np.ndim(angle) == 1 and np.shape(p)[-1:] == angle.shape and bool((np.diff(angle) > 0).all())


@units(None, "1", "rad", "Pa", returns="1")
def full_cycle(name: str, strokes: Array, angle: Array, p: Array) -> Truth:
    """Return whether a table of ascending angles covers the cycle.

    The gap from its end to its beginning is at most one step.
    """
    if name != "table" or np.ndim(p) == 0 or not angles_rise(name, angle, p):
        return True  # another rule reports it
    if np.shape(p)[-1:] < (FEWEST,):
        return False
    if np.ndim(angle) == 0:
        return True
    left = np.pi * strokes - (angle[-1] - angle[0])
    return bool(-1e-6 <= left <= 1.001 * np.diff(angle).max())


@units(None, "1", "rad", "Pa", returns="1")
def table_closes(name: str, strokes: Array, angle: Array, p: Array) -> Truth:
    """Return whether a point one cycle after the first repeats its pressure."""
    given = name == "table" and np.ndim(angle) > 0 and np.ndim(p) > 0
    if not given or not angles_rise(name, angle, p) or not full_cycle(name, strokes, angle, p):
        return True  # another rule reports it
    repeats = np.isclose(angle[-1] - angle[0], np.pi * strokes, rtol=1e-9)
    return ~repeats | np.isclose(p[..., 0], p[..., -1], rtol=1e-6)


@units(None, "Pa", returns="1")
def crankcase_is_filled(name: str, p_c: Array) -> Truth:
    """Return whether the crankcase pressure [Pa] is above 0, if the gas cycle has absolute pressures."""
    return np.logical_or(name not in POLYTROPIC, p_c > 0)


@units(None, "Pa", returns="Pa")
def lowest_of_table(name: str, p: Array) -> Array:
    """Return the lowest pressure [Pa] of a table; without a table 0, which fits absolute and gauge scales."""
    return np.min(p, axis=-1) if name == "table" and np.ndim(p) else np.asarray(0.0)


@units(None, "1", "rad", "Pa", returns="1")
def work_between_points(name: str, strokes: Array, angle: Array, p: Array) -> Array:
    """Return the estimated share [1] of the cycle's work that a table misses between its points.

    Interpolation is linear, so the error of the work falls with the square of the spacing: it is a third of
    what the work changes if every second point is left out. The piston's speed counts as sin θ.
    """
    if name != "table" or np.ndim(p) == 0 or not angles_rise(name, angle, p):
        return np.asarray(0.0)
    if not full_cycle(name, strokes, angle, p):
        return np.asarray(0.0)
    cycle, count = np.pi * float(np.max(strokes)), np.shape(p)[-1]
    places = np.arange(count) * cycle / count if np.ndim(angle) == 0 else np.asarray(angle)
    if places[-1] - places[0] > cycle * (1 - 1e-9):
        places, p = places[:-1], p[..., :-1]
    whole, *halves = (_work(places[part], p[..., part], cycle) for part in _PARTS)
    least = 0.1 * np.ptp(p, axis=-1)  # without combustion there is hardly any work
    change = np.maximum(*(np.abs(half - whole) for half in halves))
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(change / 3 / np.maximum(np.abs(whole), least))


_PARTS = slice(None), slice(0, None, 2), slice(1, None, 2)


def _work(angle: Array, p: Array, cycle: float) -> Array:
    """Return the integral of a linear, periodic pressure times sin θ over the cycle."""
    step = np.diff(angle, append=angle[0] + cycle)
    slope = (np.roll(p, -1, axis=-1) - p) / step
    return (slope * (np.sin(angle + step) - np.sin(angle))).sum(axis=-1)


@units(returns="Pa")
def absolute_table() -> float:
    """Return the lowest pressure [Pa] above which a table counts as absolute; below it is gauge pressure."""
    return 0.3e5


@units(returns="Pa")
def absolute_crankcase() -> float:
    """Return the pressure [Pa] above which a crankcase pressure counts as absolute; 0 is gauge pressure."""
    return 0.5e5


@units(None, "1", "rad", returns="1")
def is_manageable(points: tuple[int, ...], strokes: Array, step: Array) -> Truth:
    """Return whether curves over the internal grid of angles fit into memory at this number of points."""
    return bool(math.prod(points) * angles_in(strokes, step) <= MOST_VALUES)
