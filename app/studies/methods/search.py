"""The optimum of one objective at one level: a scan of the whole box, then a polish of its best points.

Variables with a list of values keep the values of the scan, so each promising combination is polished
separately. The optimum is not proven to be global.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, product
from math import prod

import numpy as np

from app.studies.methods.answers import Answer, Columns, Problem, all_refused
from app.studies.methods.correction import CorrectedAnswer, SearchView
from app.studies.methods.points import sobol_sequence
from app.studies.methods.polish import ROUGH, Place, ScaledProblem, polished, rank, relaxed
from app.studies.methods.space import Interval, Space, Values
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
MOST_TOGETHER = 3
"""Largest number of grids whose values all move at once to a neighbour; of more grids, two move at once."""
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
    lists = _lists(space)
    return min(prod(map(len, lists)), SCANNED) if len(lists) == len(space) else SCANNED


def _lists(space: Space) -> list[tuple[float, ...]]:
    """Return the values of each variable that has a list or a grid."""
    lists = (v.values if isinstance(v, Values) else v.grid for v in space.variables)
    return [one for one in lists if one]


def _places(space: Space, seed: int) -> Array:
    lists = _lists(space)
    if len(lists) == len(space) and prod(map(len, lists)) <= SCANNED:
        rows = np.stack(np.meshgrid(*lists, indexing="ij"), axis=-1).reshape(-1, len(space))
        return space.place(rows)
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
    end = min(ends[0], polished(scaled, ends[0].unit), key=rank)
    return on_grid(scaled, end) if surface.problem.space.gridded.any() else end


def on_grid(scaled: ScaledProblem, end: Place) -> Place:
    """Return the best point on the grid near the end of a search.

    All neighbouring values of the grid are tried, each with the other variables polished, until no neighbour
    of the best point is better.
    """
    space = scaled.surface.problem.space
    free = space.continuous & ~space.gridded
    tried: dict[bytes, Place] = {}

    def tried_at(unit: Array) -> Place:
        if (key := unit[space.gridded].tobytes()) not in tried:
            place = polished(scaled, unit, free=free)
            tried[key] = relaxed(scaled, place, free) if place.violation > 0 and free.any() else place
        return tried[key]

    here = tried_at(space.snapped(end.unit[None])[0])
    while True:
        near = min((tried_at(unit) for unit in neighbours(space, here.unit)), key=rank, default=here)
        if rank(near) >= rank(here):
            return here
        here = near


def neighbours(space: Space, unit: Array) -> list[Array]:
    """Return the points whose values of grids are at most one step away, and of at most two grids if many."""
    gridded = np.flatnonzero(space.gridded).tolist()
    most = len(gridded) if len(gridded) <= MOST_TOGETHER else 2
    moved = []
    for signs in _steps(len(gridded), most):
        place = unit.copy()
        for column, sign in zip(gridded, signs, strict=True):
            variable = space.variables[column]
            assert isinstance(variable, Interval)
            stop = int(np.abs(variable.stops - unit[column]).argmin()) + sign
            place[column] = variable.stops[min(max(stop, 0), len(variable.stops) - 1)]
        moved.append(place)
    return moved


@lru_cache
def _steps(count: int, most: int) -> tuple[tuple[int, ...], ...]:
    """Return all combinations of steps -1, 0 and 1 of which 1 to `most` are not 0."""
    if count <= MOST_TOGETHER:
        return tuple(signs for signs in product((-1, 0, 1), repeat=count) if any(signs))
    moved = (which for k in range(1, most + 1) for which in combinations(range(count), k))
    return tuple(
        tuple(dict(zip(which, signs, strict=True)).get(n, 0) for n in range(count))
        for which in moved
        for signs in product((-1, 1), repeat=len(which))
    )


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
