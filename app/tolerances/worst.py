"""Find the smallest and the largest value of each output within the limits, even in the interior.

A lattice with all corners and 512 quasi-random rows supply starting points; L-BFGS-B starts from the best
three. Slopes and corners alone would miss interior extremes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import fmin_l_bfgs_b

from app.tolerances.factors import Factor, lattice, placed, sobol
from templates.core.arrays import Array

Outputs = Callable[[Array], Array]
"""Function from rows of factors [SI] to outputs [SI], shape (rows, outputs); NaN where a row is refused."""

SCANNED = 512  # quasi-random rows in addition to the lattice
STARTS = 3
MOST_STEPS = 30  # steps of one local search
STEP = 1e-3  # step of a difference quotient, relative to half the tolerance range
APART = 0.25  # starts closer than this, relative to half the range, find the same extreme


@dataclass(frozen=True)
class Extreme:
    """An end of the range of an output [SI], and the values of the factors [SI] there."""

    value: float
    at: Array


@dataclass(frozen=True)
class Worst:
    """Both ends for each output (None for one without any value), and statistics of the search.

    Attributes
    ----------
    ends
        Low and high for each output.
    rows, refused
        Number of calculated rows, and of those that the design refused.
    first_refused
        The factors [SI] of one refused row.
    """

    ends: Sequence[tuple[Extreme, Extreme] | None]
    rows: int
    refused: int
    first_refused: Array | None


def worst(factors: Sequence[Factor], outputs: Outputs, seed: int) -> Worst:
    """Return the ends of each output, found by a search within the limits."""
    search = _Search(factors, outputs)
    nominal = np.array([[_position(f) for f in factors]])
    random = 2 * sobol(len(factors), SCANNED, (seed, 1)) - 1
    positions = np.vstack([nominal, lattice(len(factors)), random])
    values = search.values(positions)
    ends = [search.ends(positions, values[:, column], column) for column in range(values.shape[1])]
    return Worst(ends, search.rows, search.refused, search.first_refused)


def _position(factor: Factor) -> float:
    """Return the position of the nominal value between the limits, −1 to 1; the nearer end if outside."""
    half = (factor.high - factor.low) / 2
    return float(np.clip((factor.nominal - (factor.high + factor.low) / 2) / half, -1, 1))


class _Search:
    """One search, which counts its rows and keeps a refused one."""

    def __init__(self, factors: Sequence[Factor], outputs: Outputs) -> None:
        self.factors, self.outputs = factors, outputs
        self.rows = self.refused = 0
        self.first_refused: Array | None = None

    def values(self, positions: Array) -> Array:
        """Return the outputs at given positions."""
        rows = placed(self.factors, positions)
        values = self.outputs(rows)
        refused = np.isnan(values).all(axis=1)
        self.rows += len(rows)
        self.refused += int(refused.sum())
        if self.first_refused is None and refused.any():
            self.first_refused = rows[int(np.argmax(refused))]
        return values

    def ends(self, positions: Array, values: Array, column: int) -> tuple[Extreme, Extreme] | None:
        """Return the smallest and the largest value of one output."""
        if np.isnan(values).all():
            return None
        return self._end(positions, values, column, 1.0), self._end(positions, values, column, -1.0)

    def _end(self, positions: Array, values: Array, column: int, sign: float) -> Extreme:
        """Return the smallest value, or for the sign −1 the largest."""
        best = int(np.nanargmin(sign * values))
        best_end = values[best], positions[best]
        scale = float(np.nanmax(values) - np.nanmin(values))
        if scale > 0:
            for start in _starts(positions, sign * values):
                end = self._climb(positions[start], column, sign / scale)
                if sign * end[0] < sign * best_end[0]:
                    best_end = end
        return Extreme(float(best_end[0]), placed(self.factors, best_end[1][np.newaxis])[0])

    def _climb(self, start: Array, column: int, factor: float) -> tuple[float, Array]:
        """Return the best point found by a local search from a start."""
        best: list[tuple[float, Array]] = []

        def function(position: Array) -> tuple[float, Array]:
            value, slopes = self._slopes(position, column)
            if np.isnan(value):
                return np.inf, np.zeros_like(position)
            best.append((value, position.copy()))
            return factor * value, factor * slopes

        bounds = [(-1.0, 1.0)] * len(start)
        fmin_l_bfgs_b(function, start, bounds=bounds, maxiter=MOST_STEPS, maxfun=2 * MOST_STEPS)
        return min(best, key=lambda one: factor * one[0])

    def _slopes(self, position: Array, column: int) -> tuple[float, Array]:
        """Return an output and its slopes from one call of 1 + 2k rows; 0 where a neighbour is refused."""
        count = len(position)
        steps = STEP * np.eye(count)
        beside = np.clip(np.vstack([position + steps, position - steps]), -1, 1)
        values = self.values(np.vstack([position, beside]))[:, column]
        widths = (beside[:count] - beside[count:]).diagonal()
        slopes = (values[1 : count + 1] - values[count + 1 :]) / widths
        return float(values[0]), np.where(np.isnan(slopes), 0.0, slopes)


def _starts(positions: Array, values: Array) -> list[int]:
    """Return the rows with the smallest values that are far enough from each other."""
    chosen: list[int] = []
    for row in np.argsort(values, kind="stable")[: 20 * STARTS]:
        if np.isnan(values[row]) or len(chosen) == STARTS:
            break
        if all(np.max(np.abs(positions[row] - positions[other])) > APART for other in chosen):
            chosen.append(int(row))
    return chosen
