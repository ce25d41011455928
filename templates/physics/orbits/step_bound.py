"""Error bound of an orbit's smallest gap from the step size: from three rings of nodes, each twice as fine.

The nodes rarely meet the smallest gap: it lies between them, at the vertex of a parabola through the lowest
three. The error of that gap falls with the square of the step, once the step is small enough. With the
changes d1 from ring 4h to 2h and d2 from 2h to h, and r = d1/d2, the error is estimated as

    d2/3, a quarter added        where 3 <= r <= 5.5: the order is seen
    d1/4, or d2 if that is more  where r > 5.5: d2 is small by chance
    d2                           where 1.5 < r < 3: it falls, but not yet as it should
    3 max(d1, d2)                where r <= 1.5: it does not fall
    max(d1, d2)                  where the changes have opposite signs and r > 1.5

The bound is three times this estimate. There is no bound where the coarse ring has no orbit, or where the
changes grow by more than rounding. The bound is an estimate with a margin, not a proof; `python -m
benchmarks.step_bound` compares it with steps sixteen times as fine on random duties.
"""

from collections.abc import Sequence

import numpy as np

from templates.core.arrays import Array

SEEN = (3.0, 5.5)
"""Ratios of two changes between which the second order is seen: 4, in the limit [-]."""
FALLING = 1.5
"""Ratio above which the changes fall [-]."""
GROWING = 1e-6
"""Last change over the gap, above which changes that grow leave the error unknown [-]."""
MARGIN = 3.0


def least_between(place: Array, period: float, gap: Array) -> Array:
    """Return the smallest gap around a ring, by a parabola through its lowest node and neighbours.

    Parameters
    ----------
    place
        (K,) rising angles [rad].
    period
        After which the ring repeats [rad].
    gap
        (C, K) gaps at the nodes [-].

    Returns
    -------
    (C,) never above the lowest node, and above zero [-].
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
    """Return the bound of the relative error of the last of three gaps, by rings with steps 4h, 2h and h.

    Parameters
    ----------
    films
        Three times (C,) smallest gaps between the nodes, NaN where a ring has none [-].

    Returns
    -------
    (C,) relative error; NaN where a ring has no gap, or there are fewer than three [-].
    """
    if len(films) < 3:
        return np.full_like(films[-1], np.nan)
    coarse, middle, fine = films[-3:]
    first, second = coarse - middle, middle - fine
    d1, d2 = np.abs(first), np.abs(second)
    with np.errstate(all="ignore"):
        ratio = np.where(d2 > 0, d1 / d2, np.inf)
    error = np.where(first * second > 0, _straight(d1, d2, ratio), _alternating(d1, d2, ratio))
    grows = (ratio < 1) & (d2 > GROWING * fine)
    return np.asarray(np.where(grows, np.nan, MARGIN * error / fine))


def _straight(d1: Array, d2: Array, ratio: Array) -> Array:
    """Return the error where both changes go the same way."""
    falling = np.where(ratio > FALLING, d2, 3 * np.maximum(d1, d2))
    seen = np.where(ratio >= SEEN[0], 1.25 * d2 / 3, falling)
    return np.where(ratio > SEEN[1], np.maximum(d2, d1 / 4), seen)


def _alternating(d1: Array, d2: Array, ratio: Array) -> Array:
    """Return the error where the last change goes back."""
    return np.asarray(np.maximum(d1, d2) * np.where(ratio > FALLING, 1.0, 3.0))
