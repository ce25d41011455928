"""Slopes at a point: the change of a value with each variable, by central differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array


@dataclass(frozen=True)
class Local:
    """The rows of central differences: the point itself, then one step below and above it in each variable.

    Attributes
    ----------
    at
        The point [SI], shape (d,).
    steps
        The step of each variable [SI], shape (d,), above zero.
    """

    at: Array
    steps: Array

    @property
    def count(self) -> int:
        """Return the number of rows, 1 + 2 d."""
        return 1 + 2 * len(self.at)

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`; `last` is excluded."""
        moved = np.diag(self.steps)
        with np.errstate(over="ignore"):
            return np.asarray(self.at + np.vstack([np.zeros_like(self.at), -moved, moved]))[first:last]

    def beside(self, variable: int) -> tuple[int, int]:
        """Return the numbers of the two rows in which one variable is below and above the point."""
        return 1 + variable, 1 + len(self.at) + variable


@dataclass(frozen=True)
class Slopes:
    """Slopes [SI] and elasticities of one value, shape (d,).

    An elasticity is the relative change of the value per relative change of a variable. It is NaN if the
    value is zero, and zero if the variable is zero. A slope is one-sided if the value is missing on one side
    of the point, and NaN if it is missing on both sides.
    """

    value: float
    slopes: Array
    elasticities: Array


def slopes_at(points: Local, y: Array) -> Slopes:
    """Return the slopes of a value from its values `y` [SI] in the rows of `points`; NaN means no value."""
    dimensions = len(points.at)
    value, below, above = float(y[0]), y[1 : 1 + dimensions], y[1 + dimensions :]
    with np.errstate(all="ignore"):
        sides = 1.0 * np.isfinite(below) + np.isfinite(above)
        rise = np.where(np.isfinite(above), above, value) - np.where(np.isfinite(below), below, value)
        slope = rise / (sides * points.steps)
        elasticity = slope * points.at / value if value else np.full(dimensions, np.nan)
    return Slopes(value, slope, elasticity)
