"""Process measured indicator diagrams: average cycles, and convert times with TDC pulses to crank angles.

A table is an indicator diagram if it has a pressure, or the volts of its sensor, over a crank angle, or over
time with a column of the pulses at top dead centre (TDC). Every other table stays unchanged. The answer
lists every assumption. Crank angles are counted as in `engine`: combustion is at 360° in a four-stroke
engine and at 0° in a two-stroke engine.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from app.calculations.tables import Table, TableColumn
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs
from templates.core.units.units import compatible, unit

TURN, FOUR_STROKES = 360.0, 720.0
MOST_POINTS = 7200
"""Largest number of points of a cycle that is calculated from pulses."""

_ANGLE = re.compile(r"angle|winkel|crank|kurbel|phi|theta|alpha|deg|φ|ϕ|θ|α", re.IGNORECASE)
_PULSE = re.compile(
    r"(?<![a-z])(?:tdc|o\.?t\.?|zot|lwot|top ?dead|trigger|pulse|puls|marker|marke)", re.IGNORECASE
)
_CYCLE = re.compile(
    r"(?:cycle|zyklus|arbeitsspiel|asp|cyc)(?:[ _.-]*(?:no|nr|number|nummer|#)\.?)?", re.IGNORECASE
)
_OF_CYCLE = re.compile(
    r"(?P<name>.*?)[ _,.-]*(?:cycle|zyklus|arbeitsspiel|asp|cyc)[ _.#-]{0,3}[0-9]{1,5}", re.IGNORECASE
)
LONGEST_NAME = 80


def as_cycle(table: Table) -> Table:
    """Return an indicator diagram as one cycle, with the assumptions made; return other tables unchanged.

    Raises
    ------
    InvalidInputs
        If the TDC pulses do not determine the crank angle.
    """
    columns, assumed = _over_cycles(table.columns)
    pressure = next((column for column in columns if _is_pressure(column)), None)
    if pressure is None:
        return table
    axis, pulse = _axis(columns), _pulse(columns)
    if axis is None:
        time = next((column for column in columns if _measures(column, "s")), None)
        if time is None or pulse is None:
            return table
        columns, more = _over_angles(columns, time, pulse, pressure)
    else:
        columns, more = _mean(columns, axis, pressure)
        if not more:
            columns, more = _ascending(columns, axis)
    volts = [f"{column.name} in volts: its heading may contain a calibration, such as `pressure [20 bar/V]`"
             for column in columns if column.unit and _measures(column, "V")]  # fmt: skip
    return Table(columns, [*table.assumed, *assumed, *more, *volts])


def is_cycle_number(name: str) -> bool:
    """Return whether a column counts the cycles."""
    return bool(_CYCLE.fullmatch(name.strip()))


def _measures(column: TableColumn, name: str) -> bool:
    return bool(column.unit) and column.unit != "1" and compatible(unit(column.unit), unit(name))


def _is_pressure(column: TableColumn) -> bool:
    is_volts = _measures(column, "V") and not _PULSE.search(column.name[:LONGEST_NAME])
    return _measures(column, "Pa") or is_volts


def _axis(columns: Sequence[TableColumn]) -> TableColumn | None:
    """Return the column of crank angles, recognised by its unit or its name."""
    angles = [column for column in columns if column.is_crank or _measures_angle(column)]
    named = (c for c in angles if c.is_crank or _ANGLE.search(c.name[:LONGEST_NAME]))
    return next(named, angles[0] if len(angles) == 1 else None)


def _measures_angle(column: TableColumn) -> bool:
    return bool(column.unit) and unit(column.unit).base == unit("deg").base


def _pulse(columns: Sequence[TableColumn]) -> TableColumn | None:
    named = (column for column in columns if _PULSE.search(column.name[:LONGEST_NAME]))
    return next((column for column in named if not _measures(column, "s")), None)


def _over_cycles(columns: list[TableColumn]) -> tuple[list[TableColumn], list[str]]:
    """Return the columns without the cycle counter, averaged over the cycles."""
    kept = [column for column in columns if not is_cycle_number(column.name)]
    if len(kept) == len(columns) or len(kept) < 2:
        kept = columns
    groups: dict[tuple[str, str], list[TableColumn]] = {}
    for column in kept:
        match = _OF_CYCLE.fullmatch(column.name[:LONGEST_NAME])
        if match and column.unit:
            groups.setdefault((match["name"].strip(), column.unit), []).append(column)
    assumed = []
    for (name, _), group in groups.items():
        if len(group) > 1:
            values = tuple(np.mean([column.values for column in group], axis=0).tolist())
            mean = replace(group[0], name=name or "pressure", values=values)
            kept = [mean if column is group[0] else column for column in kept if column not in group[1:]]
            assumed.append(f"{len(group)} cycles averaged")
    return kept, assumed


def _mean(
    columns: list[TableColumn], axis: TableColumn, pressure: TableColumn
) -> tuple[list[TableColumn], list[str]]:
    """Return the mean cycle of a table over crank angles; a table of one cycle is returned unchanged."""
    to_degrees = unit(axis.unit).factor / unit("deg").factor
    angles = np.array(axis.values) * to_degrees
    steps = np.diff(angles)
    if len(angles) < 6 or not np.any(steps > 0):
        return columns, []
    step = float(np.median(steps[steps > 0]))
    restarts = np.flatnonzero(steps < -TURN / 2) + 1
    if np.any(steps[np.setdiff1d(np.arange(len(steps)), restarts - 1)] <= 0):
        return columns, []  # no angles that grow from cycle to cycle
    if len(restarts):
        parts = [slice(a, b) for a, b in _pairs([0, *restarts.tolist(), len(angles)])]
        length = _length(float(np.ptp(angles)), step)  # of all: a part may be half a cycle
        starts: Array = np.zeros(len(parts))
    else:
        length = _repeated(angles, np.array(pressure.values), step)
        if length is None:
            return columns, []
        numbers = np.floor((angles - angles[0] + 1e-6 * step) / length).astype(int)
        parts = [slice(a, b) for a, b in _pairs(np.searchsorted(numbers, range(numbers[-1] + 2)).tolist())]
        starts = np.asarray(length * np.arange(len(parts)), dtype=float)
    if length is None:
        return columns, []
    whole = [n for n, part in enumerate(parts) if np.ptp(angles[part]) >= length - 1.5 * step]
    if not whole or len(parts) < 2:
        return columns, []
    cycles = [(parts[n], angles[parts[n]] - starts[n]) for n in whole]
    grid = cycles[0][1]
    grid = grid[grid - grid[0] < length - 1e-6 * step]
    averaged = [
        replace(axis, values=tuple((grid / to_degrees).tolist()))
        if column is axis
        else replace(column, values=_averaged(np.array(column.values), cycles, grid, length))
        for column in columns
    ]
    return averaged, _counted(len(whole), len(parts) - len(whole), length)


def _ascending(columns: list[TableColumn], axis: TableColumn) -> tuple[list[TableColumn], list[str]]:
    """Return the rows of one cycle by ascending crank angle; repeated angles are left to the template."""
    angles = np.array(axis.values)
    if np.all(np.diff(angles) > 0) or len(np.unique(angles)) < len(angles):
        return columns, []
    order = np.argsort(angles)
    ordered = [replace(one, values=tuple(np.array(one.values)[order].tolist())) for one in columns]
    return ordered, ["rows put in order of the crank angle"]


def _pairs(places: Sequence[int]) -> Iterator[tuple[int, int]]:
    return ((a, b) for a, b in pairwise(places) if b > a)


def _length(span: float, step: float) -> float | None:
    """Return the cycle length [deg] for a range of angles and its step [deg]; None if not 360° or 720°."""
    return next((length for length in (TURN, FOUR_STROKES) if abs(span + step - length) <= 2 * step), None)


def _repeated(angles: Array, pressure: Array, step: float) -> float | None:
    """Return the length of each of several consecutive cycles [deg]; None if there is only one cycle."""
    total = float(angles[-1] - angles[0]) + step
    if total < FOUR_STROKES + 2 * step:
        return None
    grid = np.linspace(angles[0], angles[0] + TURN, 361)
    one, other = (np.interp(grid + turn, angles, pressure) for turn in (0.0, TURN))
    is_equal = float(np.max(np.abs(one - other))) <= 0.2 * float(np.ptp(pressure))
    return TURN if is_equal else FOUR_STROKES


def _averaged(
    values: Array, cycles: Sequence[tuple[slice, Array]], grid: Array, length: float
) -> tuple[float, ...]:
    total = np.zeros(len(grid))
    for part, angles in cycles:
        total += np.interp(grid, angles, values[part], period=length)
    return tuple((total / len(cycles)).tolist())


def _counted(count: int, incomplete: int, length: float) -> list[str]:
    of = f" of {length:g}°"
    said = [f"{count} cycles{of} averaged" if count > 1 else f"1 cycle{of} taken"]
    return said + ([f"{incomplete} incomplete left out"] if incomplete else [])


def _over_angles(
    columns: list[TableColumn], time: TableColumn, pulse: TableColumn, pressure: TableColumn
) -> tuple[list[TableColumn], list[str]]:
    """Compute crank angles from the pulses, one per revolution, and return the mean cycle over them."""
    seconds = np.array(time.values) * unit(time.unit).factor
    marks = _middles(seconds, np.array(pulse.values), pulse.name)
    turns = np.interp(seconds, marks, np.arange(len(marks)))
    level = np.interp(marks, seconds, np.array(pressure.values))
    span = float(np.ptp(np.array(pressure.values)))
    in_turn = float(level[0::2].mean() - level[1::2].mean())
    is_four = abs(in_turn) > 0.1 * span
    count = 2 if is_four else 1
    first = 1 if is_four and in_turn > 0 else 0  # start at gas exchange, so that combustion is at 360 deg
    whole = (len(marks) - 1 - first) // count
    if whole < 1:
        raise _wrong(pulse, "no whole cycle lies between its pulses; send at least three revolutions")
    end = first + count * whole
    inside = int(np.count_nonzero((turns >= first) & (turns < end)))
    points = max(min(inside // whole, MOST_POINTS), 4)
    grid = np.arange(points) * (count / points)
    places = (first + count * np.arange(whole)[:, None] + grid[None, :]).ravel()
    at = np.interp(places, np.arange(len(marks)), marks)
    kept = [column for column in columns if column is not time and column is not pulse]
    means = [
        replace(c, values=tuple(_rows(np.interp(at, seconds, np.array(c.values)), points).tolist()))
        for c in kept
    ]
    speed = 60 * (end - first) / float(marks[end] - marks[first])
    cycle = f"{count * TURN:g}°"
    angle = TableColumn("crank angle", "deg", tuple((TURN * grid).round(9).tolist()), is_crank=True)
    return [angle, *means], [
        f"one TDC pulse a revolution, TDC at its middle, {speed:.4g} rpm",
        "four strokes, combustion at 360°" if is_four else "two strokes, combustion at 0°",
        f"{whole} cycles of {cycle} averaged" if whole > 1 else f"1 cycle of {cycle} taken",
    ]


def _rows(values: Array, points: int) -> Array:
    mean: Array = values.reshape(-1, points).mean(axis=0)
    return mean


def _middles(seconds: Array, level: Array, name: str) -> Array:
    """Return the times of the midpoints of pulses [s]; pulses may be positive or negative.

    Raises
    ------
    InvalidInputs
        If the times do not increase, there are fewer than three pulses, or a pulse in between is missing.
    """
    if np.any(np.diff(seconds) <= 0):
        raise InvalidInputs([Fault("table", "unordered", "the times must increase from row to row")])
    low, high = float(level.min()), float(level.max())
    share = (level - low) / (high - low) if high > low else np.zeros(len(level))
    if np.median(share) > 0.5:
        share = 1.0 - share
    states = np.where(share > 0.6, 1, np.where(share < 0.4, 0, -1))  # in between, the state persists
    places = np.maximum.accumulate(np.where(states >= 0, np.arange(len(states)), 0))
    is_high = states[places] == 1
    edges = np.diff(is_high.astype(np.int8))
    rises, falls = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    falls = falls[falls > rises[0]] if len(rises) else falls[:0]
    rises = rises[: len(falls)]
    if len(rises) < 3:
        detail = (
            f"column {name} has {len(rises)} whole pulses; a cycle needs at least three, one a revolution"
        )
        raise InvalidInputs([Fault("table", "no_pulses", detail)])
    edges_of = (rises.tolist(), falls.tolist())
    middles: Array = np.mean([_crossing(seconds, share, places) for places in edges_of], axis=0)
    gaps = np.diff(middles)
    if gaps.max() > 1.6 * gaps.min():
        detail = (
            f"column {name}: pulses are {gaps.min():.4g} s to {gaps.max():.4g} s apart, so that one is"
            " missing or too many; there must be one a revolution"
        )
        raise InvalidInputs([Fault("table", "uneven_pulses", detail)])
    return middles


def _crossing(seconds: Array, share: Array, places: Sequence[int]) -> Array:
    """Return the time at which the pulse crosses half its height between two samples [s]."""
    before = np.asarray(places, dtype=int)
    one, other = share[before], share[before + 1]
    part = np.clip((0.5 - one) / (other - one), 0.0, 1.0)
    times: Array = seconds[before] + part * (seconds[before + 1] - seconds[before])
    return times


def _wrong(column: TableColumn, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault("table", "no_cycle", f"column {column.name}: {detail}")])
