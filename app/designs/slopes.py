"""Slopes at a point: how much a value changes with each variable, by central differences."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from app.schemas.answers import Quantity
from templates.core.arrays import Array
from templates.core.units.quotient import quotient
from templates.core.units.units import unit


@dataclass(frozen=True)
class Local:
    """The rows of central differences: the point itself, then each variable a step below and above it.

    Attributes
    ----------
    at
        The point [SI], shape (d,).
    steps
        How far each variable is moved [SI], shape (d,), above zero.
    """

    at: Array
    steps: Array

    @property
    def count(self) -> int:
        """Return 1 + 2 d rows."""
        return 1 + 2 * len(self.at)

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, with `last` excluded."""
        moved = np.diag(self.steps)
        with np.errstate(over="ignore"):
            return np.asarray(self.at + np.vstack([np.zeros_like(self.at), -moved, moved]))[first:last]

    def beside(self, variable: int) -> tuple[int, int]:
        """Return the numbers of the rows below and above the point in one variable."""
        return 1 + variable, 1 + len(self.at) + variable


@dataclass(frozen=True)
class Slopes:
    """Slopes of one value [SI] and its elasticities, shape (d,): relative change for relative change.

    An elasticity is NaN where the value is zero; it is zero where the variable is. A slope is one-sided where
    the value is missing on one side of the point, and NaN where it is missing on both.
    """

    value: float
    slopes: Array
    elasticities: Array


def slopes_at(points: Local, y: Array) -> Slopes:
    """Return the slopes of a value at a point from its values [SI] at the rows of `points`.

    NaN means no value.
    """
    dimensions = len(points.at)
    value, below, above = float(y[0]), y[1 : 1 + dimensions], y[1 + dimensions :]
    with np.errstate(all="ignore"):
        sides = 1.0 * np.isfinite(below) + np.isfinite(above)
        rise = np.where(np.isfinite(above), above, value) - np.where(np.isfinite(below), below, value)
        slope = rise / (sides * points.steps)
        elasticity = slope * points.at / value if value else np.full(dimensions, np.nan)
    return Slopes(value, slope, elasticity)


def slope_in(over: str, under: str, slope: float) -> Quantity | None:
    """Return a slope [SI] in units `over` per `under`; None if it is not finite."""
    name = quotient(over, under)
    value = slope / unit(name).factor
    return Quantity(value=value, unit=name) if math.isfinite(value) else None
