"""Sums of two sparse matrices with scaled columns; the sparsity pattern is computed only once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgbtrf, dgbtrs
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from templates.core.arrays import Array

_WIDEST = 40
"""Bandwidth up to which a banded LU is faster than a sparse one: four times at 8 and at 16."""

_SYMMETRIC = {"SymmetricMode": True}
"""Options for a nearly symmetric pattern, for which its own ordering is cheaper and has less fill-in."""


@dataclass(frozen=True)
class ColumnScaledSum:
    """Two matrices on the union of their sparsity patterns and the diagonal.

    SciPy computes a new pattern for every product with a diagonal matrix and for every sum. In Newton's
    method for a film this costs more than the factorisation itself.
    """

    pattern: csc_array
    """(N, N) the union of both patterns; its values are those of the last sum."""
    column: NDArray[np.intp]
    """(non-zeros,) the column of each entry."""
    first: Array
    """(non-zeros,) values of the first matrix."""
    second: Array
    """(non-zeros,) values of the second."""
    diagonal: NDArray[np.intp]
    """(N,) indices of the diagonal entries."""

    @classmethod
    def of(cls, first: csc_array, second: csc_array) -> ColumnScaledSum:
        """Return the scaled sum of two square matrices of the same size.

        The sum is cheapest if both have the same sparsity pattern, which includes the whole diagonal.
        """
        count = first.shape[0]
        column = np.repeat(np.arange(count), np.diff(first.indptr))
        if _has_pattern_of(second, first) and np.count_nonzero(first.indices == column) == count:
            return cls.at(first.indices, column, np.stack([first.data, second.data]), count)
        own = [_places(matrix) for matrix in (first, second)]
        on_diagonal = np.arange(count) * (count + 1)
        places = np.unique(np.concatenate([*own, on_diagonal]))
        column, row = np.divmod(places, count)
        values = np.zeros((2, places.size))
        for line, place, matrix in zip(values, own, (first, second), strict=True):
            line[np.searchsorted(places, place)] = matrix.data
        return cls.at(row, column, values, count)

    @classmethod
    def at(
        cls, row: NDArray[np.integer], column: NDArray[np.integer], values: Array, count: int
    ) -> ColumnScaledSum:
        """Return the scaled sum from the row, column and values (2, entries) of both matrices.

        The entries are in column-major order and include the whole diagonal.
        """
        starts = np.zeros(count + 1, np.int32)
        np.cumsum(np.bincount(column, minlength=count), out=starts[1:])
        pattern = csc_array((np.zeros(row.size), row.astype(np.int32), starts), shape=(count, count))
        return cls(pattern, np.asarray(column, np.intp), values[0], values[1], np.flatnonzero(row == column))

    def among(self, unknowns: NDArray[np.intp]) -> ColumnScaledSum:
        """Return the rows and columns of the given unknowns only, in the given order."""
        number = np.full(self.pattern.shape[0], -1)
        number[unknowns] = np.arange(unknowns.size)
        row, column = number[self.pattern.indices], number[self.column]
        kept = np.flatnonzero((row >= 0) & (column >= 0))
        kept = kept[np.argsort(column[kept] * unknowns.size + row[kept])]
        values = np.stack([self.first[kept], self.second[kept]])
        return self.at(row[kept], column[kept], values, unknowns.size)

    def scaled(self, by_first: Array, by_second: Array, diagonal: Array | float = 0.0) -> csc_array:
        """Return the sum with scaled columns and an added diagonal; valid until the next call."""
        values = self.pattern.data
        np.multiply(self.first, by_first[self.column], out=values)
        values += self.second * by_second[self.column]
        values[self.diagonal] += diagonal
        return self.pattern

    def times(self, by_first: Array, by_second: Array) -> Array:
        """Return the sum of the first matrix times one vector and the second matrix times another."""
        return np.asarray(self.scaled(by_first, by_second) @ np.ones(by_first.size))

    def factorised(self, by_first: Array, by_second: Array, diagonal: Array) -> Callable[[Array], Array]:
        """Return a function that solves the scaled sum for a right-hand side.

        A banded LU factorisation is used if all values are near the diagonal.

        Raises
        ------
        RuntimeError
            If the sum is singular.
        """
        matrix = self.scaled(by_first, by_second, diagonal)
        if self.width > _WIDEST:
            return splu(matrix, "MMD_AT_PLUS_A", relax=4, panel_size=1, options=_SYMMETRIC).solve
        width = self.width
        bands = np.zeros((3 * width + 1, diagonal.size), order="F")  # one third for the fill-in of pivoting
        bands[2 * width + matrix.indices - self.column, self.column] = matrix.data
        factors, pivots, failed = dgbtrf(bands, width, width, overwrite_ab=1)
        if failed:
            raise RuntimeError("the matrix is singular")
        return lambda right: np.asarray(dgbtrs(factors, width, width, right, pivots)[0])

    @cached_property
    def width(self) -> int:
        """Return the bandwidth: the largest distance of a value from the diagonal."""
        return int(np.abs(self.pattern.indices - self.column).max(initial=0))

    def diagonals(self) -> Array:
        """Return the diagonals of both matrices, (2, N)."""
        return np.stack([self.first[self.diagonal], self.second[self.diagonal]])


def _has_pattern_of(second: csc_array, first: csc_array) -> bool:
    return (
        np.array_equal(first.indptr, second.indptr)
        and np.array_equal(first.indices, second.indices)
        and bool(first.has_canonical_format)
    )


def _places(matrix: csc_array) -> NDArray[np.intp]:
    """Return the column-major index of each stored value in the matrix."""
    matrix.sum_duplicates()
    column = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    return np.asarray(column * matrix.shape[0] + matrix.indices, np.intp)
