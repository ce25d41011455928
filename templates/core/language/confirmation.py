"""Recalculate the solutions of a scan at the requested level.

The first correction uses the slope of the scanned curve; secant steps follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from templates.core.errors import InvalidInputs
from templates.core.language.crossings import Direction, Place
from templates.core.language.scan import Outputs, SampledCurve
from templates.core.language.slopes import missing_slope, side_slopes

CONFIRMED = 8  # most solutions that are recalculated at another level than that of the scan
POLISHES, POLISHED = 8, 1e-9  # most steps at that level, and the relative miss at which they stop
SETTLED = 1e-3  # largest relative miss of a solution after the last step
ALIKE = 1e-9  # fraction of the distance between the bounds within which two solutions are the same


@dataclass(frozen=True)
class Root:
    """A value of the unknown [in its declared unit] that gives the target.

    `crossing` is "touches" where the output is flat or only `touches` the target. `output` [in its declared
    unit], `level` and `error` are those of the output there; the error is None if none is stated. `slope` is
    that of the scanned curve [SI], or None for the reason in `no_slope`. A root that is not
    `confirmed` is a solution at the level of the scan only.
    """

    value: float
    output: float
    crossing: Direction
    touches: bool
    level: str | None
    error: float | None
    confirmed: bool
    miss: float
    """Output minus target, relative to the target."""
    slope: float | None = None
    no_slope: str | None = None


def confirmed(
    requested: SampledCurve, scanned: SampledCurve, places: Sequence[Place], bounds: tuple[float, float]
) -> list[Root]:
    """Return the solutions at the requested level.

    A solution of the scan is returned unconfirmed if the requested level has none nearby, or if there are too
    many solutions to confirm.
    """
    is_other = requested.chooses or not requested.is_at_levels_of(scanned)
    most = CONFIRMED if is_other else len(places)
    slopes = _slopes(scanned, places[:most], bounds) if is_other else [np.nan] * most
    near = [
        _at_requested(requested, scanned, place, slope, bounds)
        for place, slope in zip(places, slopes, strict=False)
    ]
    checked = [*near, *(None for _ in places[most:])]
    roots = [root or _unconfirmed(scanned, place) for root, place in zip(checked, places, strict=True)]
    distinct = _distinct(sorted(roots, key=lambda root: root.value), _shown(scanned, bounds))
    return _with_slopes(scanned, distinct, bounds)


def _shown(curve: SampledCurve, bounds: tuple[float, float]) -> float:
    """Return the distance between the bounds, in the declared unit."""
    scale = curve.x.scale
    return float(scale.from_si(bounds[1])) - float(scale.from_si(bounds[0]))


def _distinct(roots: list[Root], span: float) -> list[Root]:
    """Return each solution once, because two solutions of the scan may have converged to the same one."""
    kept: list[Root] = []
    for root in roots:
        if not (kept and root.confirmed and root.value - kept[-1].value <= ALIKE * span):
            kept.append(root)
    return kept


def _at_requested(
    requested: SampledCurve,
    scanned: SampledCurve,
    place: Place,
    slope: float,
    bounds: tuple[float, float],
) -> Root | None:
    """Return the solution near a scanned one at the requested level; None if there is none.

    `slope` is that of the scanned curve.
    """
    try:
        outputs = requested.outputs(np.array([place.x]))
    except InvalidInputs:
        return None
    fixed = requested.at_level(outputs.level) if outputs.level else requested
    if fixed.is_at_levels_of(scanned):
        return _root(fixed, place, place.x, outputs)
    moved = None if place.touches else _polished(fixed, place, slope, bounds, outputs)
    return moved and _root(fixed, place, *moved)


def _polished(
    curve: SampledCurve,
    place: Place,
    slope: float,
    bounds: tuple[float, float],
    outputs: Outputs,
) -> tuple[float, Outputs] | None:
    """Return the crossing of a curve near that of the scan, with the output there; None without convergence.

    The first step uses the slope of the scanned curve; further steps use secants.
    """
    x = place.x
    size = abs(curve.wanted) or abs(slope) * (bounds[1] - bounds[0])
    miss = curve.miss_of(outputs)
    for _ in range(POLISHES):
        if not abs(miss) > POLISHED * size:
            break
        before, before_miss = x, miss
        x = before - miss / slope
        if not bounds[0] <= x <= bounds[1]:
            return None
        outputs = curve.outputs(np.array([x]))
        miss = curve.miss_of(outputs)
        secant = (miss - before_miss) / (x - before) if x != before else slope
        slope = secant if secant * slope > 0 else slope
    return (x, outputs) if abs(miss) <= SETTLED * size else None


def _slopes(curve: SampledCurve, places: Sequence[Place], bounds: tuple[float, float]) -> list[float]:
    """Return the slope of the curve at each place; NaN if the values beside it are missing."""
    slopes: list[float] = side_slopes(curve, np.array([place.x for place in places]), bounds).mean.tolist()
    return slopes


def _with_slopes(curve: SampledCurve, roots: list[Root], bounds: tuple[float, float]) -> list[Root]:
    """Return the roots with the slope of the scanned curve at each."""
    x = np.clip(curve.x.scale.to_si(np.array([root.value for root in roots])), *bounds)
    slopes = side_slopes(curve, x, bounds)
    sides = zip(roots, slopes.mean.tolist(), slopes.below, slopes.above, strict=True)
    missing = [
        (root, slope, missing_slope(root.crossing, root.touches, below, above))
        for root, slope, below, above in sides
    ]
    return [
        replace(root, slope=None if reason else slope, no_slope=reason) for root, slope, reason in missing
    ]


def _unconfirmed(scanned: SampledCurve, place: Place) -> Root:
    """Return a solution at the level of the scan."""
    root = _root(scanned, place, place.x, scanned.outputs(np.array([place.x])))
    return replace(root, confirmed=False)


def _root(curve: SampledCurve, place: Place, x: float, outputs: Outputs) -> Root:
    stated = np.nan if outputs.error is None else float(outputs.error[0])
    return Root(
        float(curve.x.scale.from_si(x)),
        float(curve.y.scale.from_si(outputs.values[0])),
        place.crossing,
        place.touches,
        outputs.level,
        None if np.isnan(stated) else stated,
        confirmed=True,
        miss=abs(curve.miss_of(outputs)) / abs(curve.wanted) if curve.wanted else 0.0,
    )
