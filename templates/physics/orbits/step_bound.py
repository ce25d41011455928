"""Error bound of an orbit's smallest gap due to the step, from rings of nodes that are each twice as fine.

The nodes rarely coincide with the smallest gap: it lies between them, at the vertex of a parabola through the
lowest three. The error of that gap decreases with the square of the step, once the step is small enough: a
change from ring to ring is then a quarter of the previous change. The bound is

    LEAST + MARGIN · max(d0, d1/4, d2/16) / gap

with d0 the last change, d1 and d2 the two before. In the asymptotic range it is 3.75 times the error. A
change that is small by chance does not make the bound small, and the bound varies continuously with the load.
There is no bound if the coarse ring has no orbit. It is an estimate with a margin, not a proof; `python -m
benchmarks.step_bound` compares it with steps sixteen times as fine on random duties.
"""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

import numpy as np

from templates.core.arrays import Array

MARGIN = 1.25
"""Bound over the largest change from ring to ring, each extrapolated to the finest ring [-]."""
LEAST = 5e-4
"""Smallest stated bound: below it, kinks of the load determine the error [-]."""
RINGS = 4
"""Number of rings whose changes are used: the finest and those before it."""


def least_between(place: Array, period: float, gap: Array) -> Array:
    """Return the smallest gap on a ring, by a parabola through its lowest node and both neighbours.

    Parameters
    ----------
    place
        (K,) ascending angles [rad].
    period
        The period of the ring [rad].
    gap
        (C, K) gaps at the nodes [-].

    Returns
    -------
    (C,) at or below the lowest node, and above zero [-].
    """
    lowest, cases = gap.argmin(axis=-1), np.arange(gap.shape[0])
    count = place.size
    low, here, high = (gap[cases, (lowest + shift) % count] for shift in (-1, 0, 1))
    before = (place[lowest] - place[lowest - 1]) % period
    after = (place[(lowest + 1) % count] - place[lowest]) % period
    rise_before, rise_after = (low - here) / before, (high - here) / after
    bend = (rise_before + rise_after) / (before + after)
    slope = (rise_after * before - rise_before * after) / (before + after)
    dip = np.where(bend > 0, slope**2 / (4 * np.where(bend > 0, bend, 1.0)), 0.0)
    return np.maximum(here - dip, here / 2)


def step_bound(films: Sequence[Array]) -> Array:
    """Return the bound of the relative error of the last gap, from rings of which each is twice as fine.

    Parameters
    ----------
    films
        (C,) smallest gaps between the nodes of each ring, the finest last, NaN without an orbit [-].

    Returns
    -------
    (C,) relative error; NaN if the last two rings have no gap, or there are fewer than two [-].
    """
    fine = films[-1]
    if len(films) < 2:
        return np.full_like(fine, np.nan)
    changes = [np.abs(coarse - finer) for coarse, finer in pairwise(films[-RINGS:])]
    reduced = [change / 4**rings for rings, change in enumerate(reversed(changes))]
    largest = reduce(np.fmax, reduced)
    return np.asarray(np.where(np.isnan(reduced[0]), np.nan, LEAST + MARGIN * largest / fine))
