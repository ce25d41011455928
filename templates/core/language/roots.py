"""Find every value of an unknown that gives a wanted output, and the curve between the bounds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language.confirmation import POLISHES, Root, confirmed
from templates.core.language.crossings import Crossings, Leap, meetings
from templates.core.language.ledger import Notice
from templates.core.language.scan import SampledCurve, Samples

NAMED = 10  # most solutions that a warning names
AT_BOUND = 1e-9  # fraction of the search interval within which a solution counts as lying on a bound
BESIDE = (
    12  # distance, in scan samples, from a solution to the drawn samples of a level that accepts few points
)
MISSED = 1e-6  # relative miss of a solution above which there is a warning


@dataclass(frozen=True)
class Jump:
    """A value of the unknown at which the output jumps across the target, and the output on both sides.

    All values are in the declared units.
    """

    value: float
    before: float
    after: float


@dataclass(frozen=True)
class TracedCurve:
    """The output as a function of the unknown: samples between the bounds at one level, in declared units.

    Missing values are NaN; `reasons` explains them and is None where there is a value.
    """

    x: Array
    y: Array
    reasons: NDArray[np.object_]
    level: str | None


@dataclass(frozen=True)
class Roots:
    """All values of an unknown that give a target.

    `roots` are all crossings, `touching` the extrema that just reach the target, each in ascending order;
    `lowest` is the first of them that is confirmed at the requested level. `curve` is the scanned curve;
    `finer` are the curves at the levels that confirmed solutions, if these differ from that of the scan.
    """

    lowest: Root
    roots: list[Root]
    touching: list[Root]
    jumps: list[Jump]
    curve: TracedCurve
    finer: list[TracedCurve]
    warnings: list[Notice]


def roots_of(requested: SampledCurve, cheap: SampledCurve, bounds: tuple[float, float]) -> Roots:
    """Return every solution between bounds [SI], found on the cheap curve and confirmed on the requested one.

    Raises
    ------
    InvalidInputs
        If the requested level refuses every solution.
    Unreachable
        If no value between the bounds gives the target; the error contains the reachable range.
    """
    scanned, even, samples = cheap.scan(*bounds)
    met = meetings(scanned, samples)
    places = sorted([*met.roots, *met.touching], key=lambda place: place.x)
    if not places:
        raise scanned.unreachable(samples)
    roots = confirmed(requested, scanned, places, bounds)
    lowest = next((root for root in roots if root.confirmed), None)
    if lowest is None:
        first = float(scanned.x.scale.to_si(roots[0].value))
        raise _moved_away(scanned, samples, requested.level_at(first))
    return Roots(
        lowest,
        [root for root in roots if not root.touches],
        [root for root in roots if root.touches],
        [_jump(scanned, leap) for leap in met.leaps],
        _traced(scanned, even),
        list(_finer(requested, scanned, even, roots)),
        [*_warnings(scanned, samples, met, roots, lowest), *_at_bounds(scanned, roots, bounds)],
    )


def _warnings(
    curve: SampledCurve, samples: Samples, met: Crossings, roots: list[Root], lowest: Root
) -> list[Notice]:
    return [
        *_not_monotone(curve, samples.miss),
        *_others(curve, lowest, roots, met.more),
        *_unsettled(curve, roots),
    ]


def _at_bounds(curve: SampledCurve, roots: list[Root], bounds: tuple[float, float]) -> list[Notice]:
    """Return a warning for each solution that lies on a bound of the search [SI]."""
    near, scale = AT_BOUND * (bounds[1] - bounds[0]), curve.x.scale
    ends = [(end, float(scale.to_si(root.value))) for root in roots for end in bounds]
    detail = "{} lies on a bound of the search; there may be more beyond"
    return [
        Notice("at_bound", curve.x.name, detail.format(curve.x.with_unit(end)))
        for end, si in ends
        if abs(end - si) <= near
    ]


def _moved_away(scanned: SampledCurve, samples: Samples, level: str | None) -> Unreachable:
    """Return the error to raise if the requested level confirms no solution of the scan."""
    error = scanned.unreachable(samples)
    there = scanned.level
    detail = (
        f"at level {level} no value between the bounds is found for the target; at level {there} there is"
    )
    return Unreachable(error.name, detail, error.reachable, error.unit)


def _jump(curve: SampledCurve, leap: Leap) -> Jump:
    """Return a leap as a `Jump` in declared units."""
    output = curve.y.scale
    sides = (float(output.from_si(side)) for side in (leap.before, leap.after))
    return Jump(float(curve.x.scale.from_si(leap.x)), *sides)


def _traced(curve: SampledCurve, samples: Samples) -> TracedCurve:
    """Return samples as a `TracedCurve` in declared units."""
    x, y = curve.x.scale, curve.y.scale
    return TracedCurve(
        np.asarray(x.from_si(samples.x)),
        np.asarray(y.from_si(samples.miss + curve.wanted)),
        samples.reasons,
        curve.level,
    )


def _finer(
    requested: SampledCurve, scanned: SampledCurve, even: Samples, roots: Sequence[Root]
) -> Iterator[TracedCurve]:
    """Yield the curve of each level that confirmed solutions, except the level of the scan.

    A level that accepts few points at once gets a sample on either side of each solution.
    """
    confirmed_at = dict.fromkeys(root.level for root in roots if root.confirmed)
    curves = (requested.at_level(level) if level else requested for level in confirmed_at)
    for curve in curves:
        if not curve.is_at_levels_of(scanned):
            own = [root for root in roots if root.confirmed and root.level == curve.level]
            yield _traced(curve, _confirming(curve, even, own))


def _confirming(curve: SampledCurve, even: Samples, roots: Sequence[Root]) -> Samples:
    """Return a finer curve, with the solutions among its samples.

    It has all samples of the scan, or only a few near the solutions. Samples that the level refuses are
    omitted.
    """
    x = np.asarray(curve.x.scale.to_si(np.array([root.value for root in roots])))
    output = np.asarray(curve.y.scale.to_si(np.array([root.output for root in roots])))
    samples = Samples(x, output - curve.wanted, np.full(x.size, None, dtype=object))
    wanted = even.x if curve.rows >= even.x.size else even.x[_beside(even.x, x)]
    for start in range(0, wanted.size, curve.rows):
        with suppress(InvalidInputs):
            samples = samples.joined(curve.sample(wanted[start : start + curve.rows]))
    return samples


def _beside(even: Array, places: Array) -> NDArray[np.intp]:
    """Return the samples that lie a given number of steps on either side of the given places."""
    nearest = np.searchsorted(even, places)
    return np.unique(np.clip(np.concatenate([nearest - BESIDE, nearest + BESIDE]), 0, even.size - 1))


def _not_monotone(curve: SampledCurve, residual: Array) -> list[Notice]:
    finite = residual[np.isfinite(residual)]
    steps, rounding = np.diff(finite), 1e-12 * np.max(np.abs(finite), initial=0.0)
    if (steps >= -rounding).all() or (steps <= rounding).all():
        return []
    detail = f"{curve.y.name} is not monotone in {curve.x.name} between the bounds, in this version"
    return [Notice("not_monotone", curve.x.name, detail)]


def _others(curve: SampledCurve, lowest: Root, roots: list[Root], more: int) -> list[Notice]:
    """Return a warning that names the other solutions if there are several."""
    others = [root for root in roots if root is not lowest]
    if not others:
        return []
    unit = curve.x.scale
    names = ", ".join(curve.x.with_unit(float(unit.to_si(root.value))) for root in others[:NAMED])
    rest = f" and {len(others) + more - NAMED} more" if len(others) + more > NAMED else ""
    detail = f"{names}{rest} give the target too; the lowest is returned, see roots"
    return [Notice("several_solutions", curve.x.name, detail)]


def _unsettled(curve: SampledCurve, roots: list[Root]) -> list[Notice]:
    """Return a warning if a finer level still misses the target after the last step."""
    worst = max((root.miss for root in roots if root.confirmed), default=0.0)
    if worst <= MISSED:
        return []
    detail = (
        f"{curve.y.name} misses the target by {worst:.2g} of it after {POLISHES} steps at the finer level"
    )
    return [Notice("not_settled", curve.y.name, detail)]
