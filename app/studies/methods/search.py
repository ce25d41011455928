"""The optimum of one objective at one level: a scan of the whole box, then a polish of its best points.

Variables with a list of values keep the values of the scan, so each promising combination is polished
separately. The optimum is not proven to be global.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import prod

import numpy as np

from app.studies.methods.answers import Answer, Columns, Problem, all_refused
from app.studies.methods.correction import CorrectedAnswer, SearchView
from app.studies.methods.points import Grid, sobol_sequence
from app.studies.methods.polish import ROUGH, Place, ScaledProblem, polished, rank, relaxed
from app.studies.methods.space import Space, Values
from templates.core.arrays import Array, Integers

SCANNED = 4096
"""Number of rows of the scan; a power of two of Sobol' points."""
STARTS = 6
"""Number of points that are polished if all variables are continuous."""
AGAIN = 3
"""Number of points that are polished if starting points are given as well."""
COMBINATIONS = 24
"""Combinations of list values that are polished, each from its best point."""
RELAXED = 3
"""Number of infeasible end points from which the point of least violation is searched."""
APART = 0.15
"""Smallest distance in the unit cube between two starts."""


@dataclass(frozen=True)
class Scan:
    """Points of the unit cube, shape (N, d), and the coarse level's results there."""

    unit: Array
    columns: Columns


def scan(problem: Problem, answer: Answer, seed: int) -> Scan:
    """Calculate rows all over the box; all combinations, if there are few and no variable is continuous.

    Raises
    ------
    InvalidInputs
        If no row has results; the code is `all_refused`.
    """
    unit = _places(problem.space, seed)
    columns = answer(problem.space.at(unit))
    complete = np.isfinite(np.hstack([columns.objectives, columns.values, columns.limits])).all(axis=1)
    if not complete.any():
        raise all_refused(problem, columns, len(unit))
    return Scan(unit, columns)


def scanned(space: Space) -> int:
    """Return the number of rows of a scan."""
    lists = [len(v.values) for v in space.variables if isinstance(v, Values)]
    return min(prod(lists), SCANNED) if len(lists) == len(space) else SCANNED


def _places(space: Space, seed: int) -> Array:
    lists = [len(v.values) for v in space.variables if isinstance(v, Values)]
    if len(lists) == len(space) and prod(lists) <= SCANNED:
        grid = Grid(space)
        return space.place(grid.rows(0, grid.count))
    return sobol_sequence(len(space), seed, 0, SCANNED)


def scales(columns: Columns) -> Array:
    """Return the scale [SI] of each criterion, shape (m,): its limit, or its value if the limit is zero."""
    with np.errstate(all="ignore"):
        return np.array([_scale(*pair) for pair in zip(columns.limits.T, columns.values.T, strict=True)])


def _scale(limits: Array, values: Array) -> float:
    for sizes in (np.abs(limits[np.isfinite(limits)]), np.abs(values[np.isfinite(values)])):
        if sizes.size and (middle := float(np.median(sizes))):
            return middle
    return 1.0


def best(surface: CorrectedAnswer, scanned: Scan, starts: tuple[Array, ...] = ()) -> Place:
    """Return the best point that the polish finds from the best rows of the scan and from `starts`."""
    seen = surface.seen(scanned.unit, scanned.columns)
    scaled = ScaledProblem(surface, *middle_and_width(seen.objectives[seen.complete]))
    count = AGAIN if starts else STARTS
    chosen = [*starts, *scanned.unit[_starts(surface.problem.space, scanned.unit, seen, count)]]
    ends = [polished(scaled, start, ROUGH) for start in chosen]
    ends.sort(key=rank)
    if ends[0].violation > 0:
        ends = sorted((relaxed(scaled, end) for end in ends[:RELAXED]), key=rank)
    # Only the best point is polished to full accuracy. A fresh start also resets SLSQP's Hessian.
    return min(ends[0], polished(scaled, ends[0].unit), key=rank)


def middle_and_width(objectives: Array) -> tuple[Array, Array]:
    """Return the middle and the width of each objective, shape (N, k), over rows; no width is zero."""
    low, middle, high = np.percentile(objectives, [10, 50, 90], axis=0)
    sizes = [high - low, np.abs(middle), np.ones_like(middle)]
    return middle, np.select([size > 0 for size in sizes], sizes)


def _starts(space: Space, unit: Array, seen: SearchView, count: int) -> list[int]:
    """Return the best rows of the scan to polish; no two are close or share a combination of lists."""
    rows = np.flatnonzero(seen.complete)
    order = rows[np.lexsort((seen.objectives[rows, 0], seen.violation[rows]))].astype(np.int64)
    if not space.continuous.all():
        lists = space.at(unit[order])[:, ~space.continuous]
        first = np.unique(lists, axis=0, return_index=True)[1]
        return list(map(int, order[np.sort(first)[:COMBINATIONS]]))
    return _apart(unit, order, count)


def _apart(unit: Array, order: Integers, count: int) -> list[int]:
    chosen: list[int] = []
    left = order
    while left.size and len(chosen) < count:
        chosen.append(int(left[0]))
        left = left[np.linalg.norm(unit[left] - unit[left[0]], axis=1) > APART]
    return chosen
