"""The slope of a sampled curve at given places, by differences on both sides of each place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.crossings import Direction
from templates.core.language.scan import SampledCurve

STEP = 1e-4  # step, relative to the unknown
LEAST = 1e-3  # smallest magnitude of the unknown for the step, relative to the distance between the bounds
APART = 0.01  # largest step, relative to the distance to the nearest other place
ALIKE = 0.05  # largest relative difference between the slopes on both sides of a place
OFFSETS = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])[:, None]  # in steps
SIGNS: dict[Direction, float] = {"rises": 1.0, "falls": -1.0, "touches": 0.0}


@dataclass(frozen=True)
class SideSlopes:
    """Slopes [SI] just below and just above some places, shape (n,); NaN without a value on that side."""

    below: Array
    above: Array

    @property
    def mean(self) -> Array:
        """Return the mean of both sides, the central difference; the one side if the other has no value."""
        below, above = np.isfinite(self.below), np.isfinite(self.above)
        total = np.where(below, self.below, 0.0) + np.where(above, self.above, 0.0)
        with np.errstate(invalid="ignore"):
            return np.asarray(total / (1.0 * below + above))


def side_slopes(curve: SampledCurve, x: Array, bounds: tuple[float, float]) -> SideSlopes:
    """Return the slopes at places `x` [SI] between the bounds, all from one array of samples.

    Each side takes the values at half a step and at a whole step, with an error of second order in the step.
    The step is 1e-4 of the magnitude of the unknown, where this magnitude counts as at least 1e-3 and at most
    the whole of the distance between the bounds. It is at most 0.01 of the distance to the nearest other
    place.
    """
    places = x + OFFSETS * _steps(x, bounds)
    is_inside = (bounds[0] <= places) & (places <= bounds[1])
    samples = curve.sample(np.unique(np.where(is_inside, places, x)))
    miss = samples.miss[np.searchsorted(samples.x, np.where(is_inside, places, x))]
    with np.errstate(all="ignore"):
        rise = np.where(is_inside, (miss - miss[2]) / (places - x), np.nan)
        return SideSlopes(2 * rise[1] - rise[0], 2 * rise[3] - rise[4])


def _steps(x: Array, bounds: tuple[float, float]) -> Array:
    span = bounds[1] - bounds[0]
    between = np.abs(x[:, None] - x)
    nearest = np.min(np.where(between > 0, between, np.inf), axis=1, initial=np.inf)
    return np.asarray(np.minimum(STEP * np.clip(np.abs(x), LEAST * span, span), APART * nearest))


def missing_slope(direction: Direction, touches: bool, below: float, above: float) -> str | None:
    """Return why there is no slope at a place; None if there is one."""
    sides = np.array([side for side in (below, above) if np.isfinite(side)])
    if touches:
        return "the output touches the target without crossing it"
    if not sides.size:
        return "the output has no value beside this one"
    if not SIGNS[direction] * sides.mean() > 0:
        return "the output is flat here"
    if np.ptp(sides) > ALIKE * abs(sides.mean()):
        return "the output has a kink here: its slopes below and above differ"
    return None
