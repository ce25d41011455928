"""Find where a sampled curve meets its target: crossings, touching points, and jumps.

Crossings are located to within rounding error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from templates.core.arrays import Array
from templates.core.language.scan import SampledCurve, Samples

MOST_ROOTS = 50  # most crossings that are located
JUMP = (
    1e-6  # relative miss at a crossing beyond which it is a jump, and at an extremum within which it touches
)


Direction = Literal["rises", "falls", "touches"]


@dataclass(frozen=True)
class Place:
    """A value of the unknown [SI] where the output meets the target, and how it does so.

    `crossing` is "touches" where the output reaches the target without crossing it, or is flat. Only the
    first of these `touches`.
    """

    x: float
    crossing: Direction
    touches: bool = False


@dataclass(frozen=True)
class Leap:
    """A value of the unknown at which the output jumps across the target; the output on both sides [SI]."""

    x: float
    before: float
    after: float


@dataclass
class Crossings:
    """All places where a curve meets its target, each kind in ascending order."""

    roots: list[Place] = field(default_factory=list)
    touching: list[Place] = field(default_factory=list)
    leaps: list[Leap] = field(default_factory=list)
    more: int = 0
    """Number of crossings that were not located."""


def meetings(curve: SampledCurve, samples: Samples) -> Crossings:
    """Return the places where the curve meets its target."""
    result = Crossings()
    if np.isnan(samples.miss).all():
        return result
    for place in _exact(samples):
        (result.touching if place.touches else result.roots).append(place)
    result.touching += _touching(curve, samples)
    crossings = samples.crossings()
    result.more = max(0, crossings.size - MOST_ROOTS)
    for i in crossings[:MOST_ROOTS]:
        closed = _closed(curve, samples, i)
        if isinstance(closed, Leap):
            result.leaps.append(closed)
        else:
            result.roots.append(closed)
    result.roots.sort(key=lambda place: place.x)
    result.touching.sort(key=lambda place: place.x)
    return result


def _exact(samples: Samples) -> Iterator[Place]:
    """Yield samples that equal the target exactly; of consecutive ones only the first."""
    zero = np.flatnonzero(samples.miss == 0)
    for run in np.split(zero, np.flatnonzero(np.diff(zero) > 1) + 1):
        if run.size:
            before, after = _sign(samples.miss, run[0] - 1), _sign(samples.miss, run[-1] + 1)
            crossing = _direction(0.0 if run.size > 1 else after - before)
            yield Place(float(samples.x[run[0]]), crossing, touches=bool(before * after > 0))


def _direction(rise: float) -> Direction:
    """Return how the output meets the target if it rises by this much there."""
    return "rises" if rise > 0 else "falls" if rise < 0 else "touches"


def _sign(miss: Array, i: int) -> float:
    """Return the side of the target on which a sample lies; 0 outside the samples or without a value."""
    return float(np.nan_to_num(np.sign(miss[i]))) if 0 <= i < miss.size else 0.0


def _touching(curve: SampledCurve, samples: Samples) -> list[Place]:
    """Return the extrema that reach the target within rounding error without crossing it."""
    spread = float(np.nanmax(samples.miss) - np.nanmin(samples.miss))
    size = min(abs(curve.wanted) or spread, spread)
    near = samples.nearest()
    near = near[np.abs(samples.miss[near]) <= JUMP * size]
    crossed = samples.crossings()
    alone = [i for i in near if not ({i - 1, i} & set(crossed.tolist()))]
    return [Place(float(samples.x[i]), "touches", touches=True) for i in _best_of_neighbours(samples, alone)]


def _best_of_neighbours(samples: Samples, near: list[int]) -> list[int]:
    """Return the sample nearest to the target in each run of consecutive samples."""
    best: list[int] = []
    for i in near:
        if best and i - best[-1] <= 2:
            best[-1] = min(best[-1], i, key=lambda k: abs(float(samples.miss[k])))
        else:
            best.append(i)
    return best


def _closed(curve: SampledCurve, samples: Samples, i: int) -> Place | Leap:
    """Return the crossing between two samples, located to within rounding error.

    It is a jump if the output never equals the target.
    """
    low, high = (float(samples.x[k]) for k in (i, i + 1))
    root = float(brentq(curve.miss, low, high, xtol=1e-300, rtol=4e-15, disp=False))
    size = max(abs(curve.wanted), float(np.nanmax(np.abs(samples.miss))) * JUMP)
    if abs(curve.miss(root)) <= JUMP * size:
        return Place(root, _direction(samples.miss[i + 1]))
    step = 1e-9 * (high - low)
    sides = curve.sample(np.array([max(low, root - step), min(high, root + step)])).miss
    before, after = np.where(np.isfinite(sides), sides, samples.miss[[i, i + 1]]) + curve.wanted
    return Leap(root, float(before), float(after))
