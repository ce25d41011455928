"""The box of the varied values: the unit cube, in which methods work, and the values in SI."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.errors import Fault, InvalidInputs

Spacing = Literal["linear", "log"]


@dataclass(frozen=True)
class Interval:
    """A variable between two bounds [SI]; with log spacing, each decade has the same share.

    A search moves freely between the values of a `grid` [SI, ascending], but ends on one of them.

    Raises
    ------
    InvalidInputs
        If the bounds are not finite or not in order (code `not_ascending`), or if log spacing has a bound ≤ 0
        (code `spacing`).
    """

    name: str
    low: float
    high: float
    spacing: Spacing = "linear"
    grid: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise _refusal(
                self.name, "not_ascending", "the lower bound must be less than the upper one, both finite"
            )
        if self.spacing == "log" and self.low <= 0:
            raise _refusal(self.name, "spacing", "spacing `log` needs bounds above zero")

    def at(self, u: Array) -> Array:
        """Return the values [SI] at positions `u` from 0 to 1."""
        if self.spacing == "log":
            values = self.low * np.exp(u * math.log(self.high / self.low))
        else:
            values = self.low + u * (self.high - self.low)
        return np.where(u >= 1.0, self.high, np.clip(values, self.low, self.high))

    def place(self, values: Array) -> Array:
        """Return the positions from 0 to 1 of values [SI] within the bounds."""
        if self.spacing == "log":
            places = np.log(values / self.low) / math.log(self.high / self.low)
        else:
            places = (values - self.low) / (self.high - self.low)
        return np.clip(places, 0.0, 1.0)

    @cached_property
    def stops(self) -> Array:
        """Return the positions from 0 to 1 of the values of the grid."""
        return self.place(np.array(self.grid))

    def steps(self, count: int) -> Array:
        """Return `count` values [SI], including both bounds."""
        if count < 2:
            raise InvalidInputs([Fault(self.name, "steps", f"{self.name}: a grid needs at least 2 steps")])
        return self.at(np.linspace(0.0, 1.0, count))


@dataclass(frozen=True)
class Values:
    """A variable with a list of values: whole numbers, standard sizes [SI], or indices of a list of options.

    Raises
    ------
    InvalidInputs
        If the list is empty or a value is not finite; the code is `values`.
    """

    name: str
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.values or not all(map(math.isfinite, self.values)):
            detail = f"{self.name}: `values` needs at least one value, all of them finite"
            raise InvalidInputs([Fault(self.name, "values", detail)])

    def at(self, u: Array) -> Array:
        """Return the values at positions `u` from 0 to 1; each value has an equal share."""
        index = np.minimum(np.floor(u * len(self.values)).astype(np.int64), len(self.values) - 1)
        return np.array(self.values)[index]

    def place(self, values: Array) -> Array:
        """Return the middle of the share of the nearest value in the list."""
        nearest = np.abs(values[..., None] - np.array(self.values)).argmin(axis=-1)
        return np.asarray((nearest + 0.5) / len(self.values))

    def steps(self, count: int) -> Array:
        """Return all values, whatever the count."""
        return np.array(self.values)


Variable = Interval | Values


@dataclass(frozen=True)
class Space:
    """The varied values of a study, in the order of the columns of its rows."""

    variables: tuple[Variable, ...]

    def __len__(self) -> int:
        return len(self.variables)

    @property
    def names(self) -> list[str]:
        """Return the names of the variables, in the order of the columns."""
        return [variable.name for variable in self.variables]

    @property
    def continuous(self) -> Mask:
        """Return a mask of the variables that are continuous between two bounds, shape (d,)."""
        return np.array([isinstance(variable, Interval) for variable in self.variables], dtype=bool)

    @property
    def gridded(self) -> Mask:
        """Return a mask of the variables that have a grid, shape (d,)."""
        return np.array([isinstance(v, Interval) and bool(v.grid) for v in self.variables], dtype=bool)

    def snapped(self, unit: Array) -> Array:
        """Return points of the unit cube, shape (N, d), moved to the nearest values of each grid."""
        moved = unit.copy()
        for column, variable in enumerate(self.variables):
            if isinstance(variable, Interval) and variable.grid:
                nearest = np.abs(unit[:, column, None] - variable.stops).argmin(axis=1)
                moved[:, column] = variable.stops[nearest]
        return moved

    def at(self, unit: Array) -> Array:
        """Return rows [SI] for points of the unit cube, shape (N, d)."""
        return _by_column([v.at(u) for v, u in zip(self.variables, unit.T, strict=True)], unit)

    def place(self, rows: Array) -> Array:
        """Return points of the unit cube for rows [SI]."""
        return _by_column([v.place(x) for v, x in zip(self.variables, rows.T, strict=True)], rows)


def _by_column(columns: Sequence[Array], like: Array) -> Array:
    return np.stack(columns, axis=-1) if columns else np.empty_like(like)


def _refusal(name: str, code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault(name, code, f"{name}: {detail}")])
