"""Local optimisation by SciPy's SLSQP; one array call of 1 + 2 n rows gives the value and its slopes.

References
----------
Kraft 1988, A software package for sequential quadratic programming, DFVLR-FB 88-28.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, TypedDict

import numpy as np
from scipy.optimize import minimize

from app.studies.methods.correction import CorrectedAnswer
from templates.core.arrays import Array, Mask

STEP = 1e-5
"""Step of central differences, as a share of a variable's range."""
HOLD = 1e-9
"""Relative margin that the polish keeps, so that rounding does not violate a limit."""
REFUSED = 1e3
"""Scaled objective of a refused row, worse than any other, so that the polish turns back."""
STALE, WORTH = 12, 1e-9
"""A polish ends after this many points without an improvement of this size (scaled)."""
ACCURACY, ROUGH, MOST_STEPS = 1e-12, 1e-6, 100
"""Accuracy of SLSQP in the scaled objective, final or only for comparison; and its iterations."""


@dataclass(frozen=True)
class Place:
    """The end of a search: a point in the unit cube, shape (d,), its objective and its relative violation."""

    unit: Array
    objective: float
    violation: float


def rank(place: Place) -> tuple[float, float]:
    """Return a sort key for points: smaller violation first, then smaller objective."""
    return (place.violation, place.objective)


@dataclass(frozen=True)
class ScaledProblem:
    """The first objective, scaled to about one, and the margins of a surface.

    `middle` and `width` describe the values of all objectives, shape (k,). `most` bounds the other
    objectives, shape (k - 1,), so that a point of a front improves in one objective and gets worse in none.
    """

    surface: CorrectedAnswer
    middle: Array
    width: Array
    most: Array | None = None

    def __call__(self, unit: Array) -> tuple[Array, Array]:
        """Return objectives, (N,), and margins, (N, m); (N, m + k - 1) if other objectives are bounded."""
        seen = self.surface(unit)
        scaled = (seen.objectives - self.middle) / self.width
        margins = seen.margins - HOLD
        if self.most is not None:
            margins = np.hstack([margins, (self.most - seen.objectives[:, 1:]) / self.width[1:]])
        return scaled[:, 0], margins


Linear = tuple[float, Array, Array, Array]
"""Objective, its slopes (n,), margins (m,), and their slopes (m, n)."""


class _Stale(Exception):
    """Raised if the polish no longer improves anything."""


class _Tangent:
    """Values and slopes over the free variables around a start; it records all evaluated points."""

    def __init__(self, scaled: ScaledProblem, start: Array, free: Mask) -> None:
        self._scaled, self._start, self.free = scaled, start, np.flatnonzero(free)
        self._kept: dict[bytes, Linear] = {}
        self.places: list[Place] = []

    def unit(self, z: Array) -> Array:
        """Return the point in the unit cube for given values of the free variables."""
        place = self._start.copy()
        place[self.free] = np.clip(z, 0.0, 1.0)
        return place

    def __call__(self, z: Array) -> Linear:
        place = self.unit(z)
        if (key := place.tobytes()) not in self._kept:
            if self._is_stale():
                raise _Stale
            self._kept[key] = self._asked(place)
        return self._kept[key]

    def _is_stale(self) -> bool:
        """Return whether the last points improved nothing; SLSQP would otherwise follow solver noise."""
        if len(self.places) < STALE:
            return False
        before, after = (min(part, key=rank) for part in (self.places[: 1 - STALE], self.places[1 - STALE :]))
        nearer = before.violation - after.violation > WORTH
        better = before.violation >= after.violation and before.objective - after.objective > WORTH
        return not (nearer or better)

    def _asked(self, place: Array) -> Linear:
        below, above = self._steps(place)
        rows = np.repeat(place[None], 1 + 2 * self.free.size, axis=0)
        each = np.arange(self.free.size)
        rows[1 + each, self.free] += below
        rows[1 + self.free.size + each, self.free] += above
        objective, margins = self._scaled(rows)
        both = np.column_stack([objective, margins])
        if not np.isfinite(both[0]).all():
            return _refused(each.size, both.shape[1] - 1)
        self._remember(place, both[0])
        slopes = _slopes(both[0], both[1 : 1 + each.size], both[1 + each.size :], below, above)
        # SciPy's SLSQP reads the memory of its arrays as if they were contiguous.
        across = np.ascontiguousarray(slopes.T)
        return float(both[0, 0]), across[0], both[0, 1:], across[1:]

    def _steps(self, place: Array) -> tuple[Array, Array]:
        """Return two steps for each free variable: one to each side, or both to one side at a bound."""
        z = place[self.free]
        below = np.where(z < STEP, 2 * STEP, -STEP)
        above = np.where(z > 1 - STEP, -2 * STEP, STEP)
        return below, above

    def _remember(self, place: Array, both: Array) -> None:
        violation = max(0.0, float(np.max(-(both[1:] + HOLD), initial=0.0)))
        self.places.append(Place(place, float(both[0]), violation))


def _refused(free: int, held: int) -> Linear:
    """Return a constant result that is poor enough to make the line search turn back."""
    return REFUSED, np.zeros(free), np.full(held, -1.0), np.zeros((held, free))


def _slopes(middle: Array, one: Array, other: Array, a: Array, b: Array) -> Array:
    """Return the slopes at 0 of parabolas through (0, middle), (a, one), (b, other).

    If one point is missing, a straight line is used.
    """
    a, b = a[:, None], b[:, None]
    with np.errstate(all="ignore"):
        first, second = (one - middle) / a, (other - middle) / b
        slopes = (first * b - second * a) / (b - a)
    for line in (first, second):
        slopes = np.where(np.isfinite(slopes), slopes, line)
    return np.where(np.isfinite(slopes), slopes, 0.0)


def polished(
    scaled: ScaledProblem, start: Array, accuracy: float = ACCURACY, free: Mask | None = None
) -> Place:
    """Return the best point on the path of SLSQP from a start, to an accuracy of the scaled objective.

    Only the variables of the mask `free` move; by default all that are continuous.
    """
    tangent = _Tangent(scaled, start, scaled.surface.problem.space.continuous if free is None else free)
    first = tangent(start[tangent.free])
    if tangent.free.size and first[0] < REFUSED:
        _slsqp(tangent, start[tangent.free], len(first[2]), accuracy)
    return min(tangent.places, key=rank, default=Place(start, REFUSED, np.inf))


def _slsqp(tangent: _Tangent, start: Array, held: int, accuracy: float) -> None:
    limits = _Limits(type="ineq", fun=lambda z: tangent(z)[2], jac=lambda z: tangent(z)[3])
    _minimise(lambda z: tangent(z)[:2], start, [(0.0, 1.0)] * start.size, [limits] if held else [], accuracy)


def relaxed(scaled: ScaledProblem, place: Place, free: Mask | None = None) -> Place:
    """Return the point of least violation near a given point; `free` as for `polished`.

    The violation t becomes the objective, with the constraints margins + t >= 0.
    """
    space = scaled.surface.problem.space
    tangent = _Tangent(scaled, place.unit, space.continuous if free is None else free)
    start = place.unit[tangent.free]
    margins = tangent(start)[2]
    if not start.size or not np.isfinite(place.violation):
        return place
    down = np.append(np.zeros(start.size), 1.0)
    limits = _Limits(
        type="ineq",
        fun=lambda y: tangent(y[:-1])[2] + y[-1],
        jac=lambda y: np.column_stack([tangent(y[:-1])[3], np.ones(len(margins))]),
    )
    most = float(np.max(-margins))
    bounds = [(0.0, 1.0)] * start.size + [(0.0, 2 * most)]
    _minimise(lambda y: (y[-1], down), np.append(start, most), bounds, [limits])
    return min(tangent.places, key=rank)


class _Limits(TypedDict):
    """Functions that SLSQP keeps at zero or above, and their slopes (m, n)."""

    type: Literal["ineq"]
    fun: Callable[[Array], Array]
    jac: Callable[[Array], Array]


def _minimise(
    objective: Callable[[Array], tuple[float, Array]],
    start: Array,
    bounds: list[tuple[float, float]],
    limits: list[_Limits],
    accuracy: float = ACCURACY,
) -> None:
    """Run SLSQP; the functions record the points that it visits."""
    with suppress(_Stale):
        minimize(  # type: ignore[call-overload] # its stubs know functions of arrays of one axis only
            objective,
            start,
            jac=True,
            method="SLSQP",
            bounds=bounds,
            constraints=limits,
            options={"ftol": accuracy, "maxiter": MOST_STEPS},
        )
