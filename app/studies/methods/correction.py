"""A coarse level of a design, corrected by its ratios to a fine level at some points.

The logarithm of the ratio is interpolated between the confirmed rows by ordinary kriging with a smooth
covariance. Inverse-distance weights would keep the slope of the coarse level at a confirmed row. Kriging uses
the slope between the confirmed rows, so the rounds approach the optimum of the fine level
(docs/decisions/044). Where a column is zero or changes its sign, differences replace ratios.

References
----------
Cressie 1993, Statistics for Spatial Data, section 3.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.studies.methods.answers import Answer, Columns, Problem
from templates.core.arrays import Array, Mask

REACH = 1.0
"""Distance in the unit cube over which ratios are correlated."""
CLOSE = 0.02
"""Distance in the unit cube within which a further confirmation adds little."""
NUGGET = 1e-9
"""Variance of the ratios at one point, relative to that over the box, because solvers are not exact."""


@dataclass(frozen=True)
class SearchView:
    """The predictions for N rows that a search uses: objectives to minimise, and margins of criteria.

    Attributes
    ----------
    objectives
        Shape (N, k); objectives to maximise have the opposite sign.
    margins
        Margins relative to the scale of the criterion, reduced by the guard, shape (N, m); zero or more is
        feasible.
    columns
        Predicted objectives, values and limits [SI], shape (N, k + 2 m).
    """

    objectives: Array
    margins: Array
    columns: Array

    @property
    def violation(self) -> Array:
        """Return the largest relative violation of a limit, shape (N,); zero is feasible."""
        worst = np.max(-self.margins, axis=1, initial=0.0)
        return np.where(np.isnan(self.margins).any(axis=1), np.nan, worst)

    @property
    def complete(self) -> Mask:
        """Return a mask of the rows with all results, shape (N,)."""
        return np.asarray(np.isfinite(np.hstack([self.objectives, self.margins])).all(axis=1))


def stacked(columns: Columns) -> Array:
    """Return objectives, values and limits as columns of one array, shape (N, k + 2 m)."""
    return np.hstack([columns.objectives, columns.values, columns.limits])


class CorrectedAnswer:
    """The coarse level over the unit cube, corrected and guarded by the confirmed points."""

    def __init__(self, problem: Problem, answer: Answer, scales: Array) -> None:
        """Set the positive scale [SI] of each criterion; shape (m,)."""
        self.problem, self.answer, self.scales = problem, answer, scales
        self.places: list[Array] = []
        self.coarse: list[Array] = []
        self.fine: list[Array] = []
        self.guards: list[Array] = []
        self.reserve = np.zeros(len(problem.held))

    def __call__(self, unit: Array) -> SearchView:
        """Return the predictions at points of the unit cube, shape (N, d)."""
        return self.seen(unit, self.answer(self.problem.space.at(unit)))

    def seen(self, unit: Array, columns: Columns) -> SearchView:
        """Return the predictions at points whose coarse results are given as `columns`."""
        weights = self._weights(unit)
        promise = self._promise(stacked(columns), weights)
        count, held = len(self.problem.objectives), len(self.problem.held)
        values, limits = promise[:, count : count + held], promise[:, count + held :]
        margins = self.problem.signs * (values - limits) - self._guard(values, weights)
        margins = margins / self.scales - self.reserve
        return SearchView(self.problem.senses * promise[:, :count], margins, promise)

    def learn(self, unit: Array, coarse: Columns, fine: Columns) -> None:
        """Add one confirmed point, shape (1, d), to the corrections, and its error bands to the guards."""
        self.places.append(unit[0])
        self.coarse.append(stacked(coarse)[0])
        self.fine.append(stacked(fine)[0])
        width = (self.problem.signs * (fine.values - fine.limits) - fine.low)[0]
        with np.errstate(all="ignore"):
            share = width / np.abs(fine.values[0])
        self.guards.append(np.where(np.isfinite(share), np.maximum(share, 0.0), 0.0))

    @property
    def ratio_spread(self) -> float:
        """Return by how much the ratio of both levels' first objective differs between confirmed points."""
        before, after = np.array(self.coarse)[:, 0], np.array(self.fine)[:, 0]
        with np.errstate(all="ignore"):
            ratios = np.log(after / before)
        ratios = ratios[np.isfinite(ratios)]
        return float(np.ptp(ratios)) if len(ratios) else 0.0

    def is_known(self, unit: Array) -> bool:
        """Return whether a point, shape (d,), is close to a confirmed one."""
        return any(float(np.linalg.norm(unit - place)) < CLOSE for place in self.places)

    def _weights(self, unit: Array) -> Array:
        """Return the weight of each confirmed point, shape (N, a); each row adds up to one."""
        if not self.places:
            return np.empty((len(unit), 0))
        return kriging_weights(np.array(self.places), unit)

    def _guard(self, values: Array, weights: Array) -> Array:
        """Return the unsafe half of each error band at the fine level [SI], shape (N, m).

        It is zero before the first confirmation.
        """
        if not self.guards:
            return np.zeros_like(values)
        return np.asarray(np.abs(values) * np.maximum(weights @ np.array(self.guards), 0.0))

    def _promise(self, coarse: Array, weights: Array) -> Array:
        if not self.places:
            return coarse
        before, after = np.array(self.coarse), np.array(self.fine)
        alike = (before * after > 0).all(axis=0)
        with np.errstate(all="ignore"):
            ratios = np.log(np.where(alike, after / before, 1.0))
        shifts = np.where(alike, 0.0, after - before)
        return np.asarray(coarse * np.exp(_kriged(weights, ratios)) + _kriged(weights, shifts))


def _kriged(weights: Array, values: Array) -> Array:
    """Return interpolated values; they exceed the range of `values` by no more than its width."""
    low, high = values.min(axis=0), values.max(axis=0)
    return np.clip(weights @ values, 2 * low - high, 2 * high - low)


def kriging_weights(places: Array, unit: Array) -> Array:
    """Return the weight of each of the points (a, d) at each row of `unit` (N, d), shape (N, a).

    The weights of a row add up to one. Ordinary kriging with the covariance exp(-r²/2 l²).
    """
    count = len(places)
    system = np.ones((count + 1, count + 1))
    system[:count, :count] = _covariance(places, places) + NUGGET * np.eye(count)
    system[count, count] = 0.0
    right = np.vstack([_covariance(places, unit), np.ones(len(unit))])
    return np.ascontiguousarray(np.linalg.solve(system, right)[:count].T)


def _covariance(places: Array, unit: Array) -> Array:
    squares = np.sum((places[:, None] - unit[None]) ** 2, axis=2)
    return np.asarray(np.exp(-squares / (2 * REACH**2)))
