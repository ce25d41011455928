"""Sums of two sparse matrices whose columns are scaled again and again: the pattern is made once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from templates.core.arrays import Array


@dataclass(frozen=True)
class ColumnScaledSum:
    """Two matrices on the union of their patterns and the diagonal.

    SciPy makes a new pattern for every product with a diagonal and for every sum. In Newton's method for a
    film these cost more than the factorisation itself.
    """

    pattern: csc_array
    """(N, N) the union; its values are those of the last sum."""
    column: NDArray[np.intp]
    """(non-zeros,) the column of each."""
    first: Array
    """(non-zeros,) values of the first matrix."""
    second: Array
    """(non-zeros,) values of the second."""
    diagonal: NDArray[np.intp]
    """(N,) where the diagonal is among them."""

    @classmethod
    def of(cls, first: csc_array, second: csc_array) -> ColumnScaledSum:
        """The sum of two square matrices of one size."""
        count = first.shape[0]
        own = [_places(matrix) for matrix in (first, second)]
        on_diagonal = np.arange(count) * (count + 1)
        places = np.unique(np.concatenate([*own, on_diagonal]))
        column, row = np.divmod(places, count)
        starts = np.concatenate([[0], np.cumsum(np.bincount(column, minlength=count))])
        values = np.zeros((2, places.size))
        for line, place, matrix in zip(values, own, (first, second), strict=True):
            line[np.searchsorted(places, place)] = matrix.data
        pattern = csc_array(
            (np.zeros(places.size), row.astype(np.int32), starts.astype(np.int32)), shape=first.shape
        )
        return cls(pattern, column, values[0], values[1], np.searchsorted(places, on_diagonal))

    def scaled(self, by_first: Array, by_second: Array, diagonal: Array) -> csc_array:
        """The sum with columns times factors, and a diagonal added; valid until the next call."""
        values = self.pattern.data
        np.multiply(self.first, by_first[self.column], out=values)
        values += self.second * by_second[self.column]
        values[self.diagonal] += diagonal
        return self.pattern


def _places(matrix: csc_array) -> NDArray[np.intp]:
    """The index of each stored value in the matrix, written column by column."""
    matrix.sum_duplicates()
    column = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    return np.asarray(column * matrix.shape[0] + matrix.indices, np.intp)
