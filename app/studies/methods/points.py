"""The rows of a study. Each chunk is computed independently, and a row does not depend on its chunk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import prod
from typing import Protocol

import numpy as np

from app.studies.methods.space import Space
from templates.core.arrays import Array


class Points(Protocol):
    """A sequence of `count` rows [SI], accessed by number."""

    @property
    def count(self) -> int:
        """Return the number of rows."""
        ...

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`, shape (last - first, d)."""
        ...


@dataclass(frozen=True)
class Table:
    """Rows [SI] that the user gives, shape (N, d)."""

    values: Array

    @property
    def count(self) -> int:
        """Return the number of rows."""
        return len(self.values)

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        return self.values[first:last]


@dataclass(frozen=True)
class Grid:
    """All combinations of the steps of all variables; the last variable changes fastest.

    `steps` gives the number of steps of each interval; a variable with `values` uses all of them.

    Raises
    ------
    InvalidInputs
        If an interval has fewer than two steps; the code is `steps`.
    """

    space: Space
    steps: Mapping[str, int] = field(default_factory=dict)

    @cached_property
    def axes(self) -> tuple[Array, ...]:
        """Return the values [SI] of each variable."""
        return tuple(v.steps(self.steps.get(v.name, 0)) for v in self.space.variables)

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the number of values of each variable."""
        return tuple(len(axis) for axis in self.axes)

    @property
    def count(self) -> int:
        """Return the number of rows."""
        return prod(self.shape)

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        numbers = np.arange(first, min(last, self.count))
        places = np.unravel_index(numbers, self.shape)
        return np.stack([axis[place] for axis, place in zip(self.axes, places, strict=True)], axis=-1)


@dataclass(frozen=True)
class Sobol:
    """The scrambled Sobol' sequence of a seed; a power of two of rows covers the box most evenly."""

    space: Space
    count: int
    seed: int

    def unit(self, first: int, last: int) -> Array:
        """Return the rows as points of the unit cube."""
        return sobol_sequence(len(self.space), self.seed, first, min(last, self.count))

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        return self.space.at(self.unit(first, last))


def sobol_sequence(dimensions: int, seed: int, first: int, last: int) -> Array:
    """Return points `first` to `last`, excluding `last`, of a scrambled sequence in the unit cube."""
    from scipy.stats import qmc  # a slow import: as slow as all others of a small command together

    sequence = qmc.Sobol(dimensions, rng=seed)
    if first:
        return np.asarray(sequence.fast_forward(first).random(last - first), dtype=np.float64)
    # SciPy warns if the first draw is not a power of two; surplus points are dropped.
    drawn = sequence.random_base2(max(last - 1, 0).bit_length())
    return np.asarray(drawn[:last], dtype=np.float64)


@dataclass(frozen=True)
class LatinHypercube:
    """A Latin hypercube of `count` rows: each of `count` equal slices of every variable contains one row."""

    space: Space
    count: int
    seed: int

    @cached_property
    def _unit(self) -> Array:
        """Return all rows of the sample, because each row depends on the others."""
        from scipy.stats import qmc

        return np.asarray(qmc.LatinHypercube(len(self.space), rng=self.seed).random(self.count))

    def unit(self, first: int, last: int) -> Array:
        """Return the rows as points of the unit cube."""
        return self._unit[first:last]

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        return self.space.at(self.unit(first, last))
