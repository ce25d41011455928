"""Cycles of a periodic stress: rainflow counting by ASTM E1049, starting from the highest point.

A history that begins anywhere else leaves half cycles that only the next engine cycle closes.

References
----------
ASTM E1049-85: Standard practices for cycle counting in fatigue analysis, section 5.4.4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import rainflow

from templates.core.arrays import Array

_SMALL = 0.01
"""Fraction of the largest amplitude of a history below which cycles are ignored."""


@dataclass(frozen=True)
class Cycles:
    """Cycles of each history; rows with fewer cycles are padded with counts of 0."""

    amplitude: Array  # [..., cycle] [Pa]
    mean: Array  # [..., cycle] [Pa]
    count: Array  # [..., cycle] [1], a half cycle as 0.5


def from_the_highest(history: Array) -> Array:
    """Return one period of a periodic history, from its highest point to that point's next occurrence."""
    turned = np.roll(history, -int(np.argmax(history)))
    return np.append(turned, turned[0])


def counted(history: Array) -> list[tuple[float, float, float]]:
    """Return amplitude, mean [Pa] and count of the cycles of one periodic history; equal ones are merged."""
    cycles = rainflow.extract_cycles(from_the_highest(history).tolist())
    sums: dict[tuple[float, float], float] = {}
    for width, mean, count, _, _ in cycles:
        place = (width / 2, mean)
        sums[place] = sums.get(place, 0.0) + count
    largest = max((amplitude for amplitude, _ in sums), default=0.0)
    return [(a, m, n) for (a, m), n in sums.items() if a > 0 and a >= _SMALL * largest]


def by_rainflow(histories: Array) -> Cycles:
    """Return the cycles of histories [..., angle] [Pa]."""
    flat = histories.reshape(-1, histories.shape[-1])
    rows = [counted(row) for row in flat]
    table = np.zeros((len(rows), max(1, *(len(row) for row in rows)), 3))
    for place, row in enumerate(rows):
        if row:
            table[place, : len(row)] = row
    columns = np.moveaxis(table.reshape(*histories.shape[:-1], -1, 3), -1, 0)
    return Cycles(*columns)


def by_extremes(histories: Array) -> Cycles:
    """Return one cycle for each history [..., angle] [Pa], between its extremes."""
    high, low = histories.max(axis=-1), histories.min(axis=-1)
    amplitude = ((high - low) / 2)[..., None]
    return Cycles(amplitude, ((high + low) / 2)[..., None], np.where(amplitude > 0, 1.0, 0.0))
