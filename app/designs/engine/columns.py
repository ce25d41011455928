"""Columns: values of a design for many rows, with their error bounds.

Rows run along the first axis, and the points of a curve along the last. A value that is equal in all rows has
no row axis. Each column therefore states whether its first axis counts rows, so that 360 rows are not
mistaken for a curve of 360 points.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.core.criteria.bands import Estimate
from templates.core.errors import FaultyText
from templates.core.units.units import Value

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Column:
    """A value [SI]: one for all rows, or one for each row.

    Attributes
    ----------
    value
        A number or an array. If `is_row`, its first axis is the row. Further axes belong to the value
        itself, such as the points of a curve.
    """

    value: Value
    is_row: bool = False

    @property
    def rank(self) -> int:
        """Return the number of axes of the value in one row."""
        return np.ndim(self.value) - self.is_row

    @property
    def places(self) -> tuple[int, ...]:
        """Return the shape of the value in one row."""
        return np.shape(self.value)[int(self.is_row) :]

    def of(self, rows: Indices | slice) -> Column:
        """Return the column restricted to some rows."""
        return Column(self.value[rows], is_row=True) if self.is_row else self  # type: ignore[index]

    def padded(self, rank: int) -> Value:
        """Return the value as an array that broadcasts with arrays of a larger rank."""
        if not self.is_row or rank <= self.rank:
            return self.value
        value = np.asarray(self.value)
        return value.reshape(len(value), *(1,) * (rank - self.rank), *value.shape[1:])

    def spread(self, count: int) -> Array:
        """Return the value for every row as an array; a view if all rows share one value."""
        value = np.asarray(self.value, dtype=float)
        if self.is_row:
            return value
        return value[None] if count == 1 else np.broadcast_to(value, (count, *value.shape))

    def finite_rows(self) -> Mask:
        """Return a mask of the rows in which the value is finite at all points."""
        finite: Mask = np.asarray(np.isfinite(self.value))
        whole: Mask = np.all(finite, axis=tuple(range(1, finite.ndim)))
        return whole

    def unknown_rows(self, count: int) -> Mask:
        """Return a mask of the rows in which the value is NaN at any point."""
        unknown = np.asarray(np.isnan(self.value))
        if not self.is_row:
            return np.full(count, unknown.any())
        return np.any(unknown, axis=tuple(range(1, unknown.ndim))) if unknown.ndim > 1 else unknown

    def without(self, refused: Mask) -> Column:
        """Return the column with NaN in the refused rows."""
        if not refused.any():
            return self
        where = refused.reshape(-1, *(1,) * self.rank)
        return Column(np.where(where, np.nan, self.spread(refused.size)), is_row=True)


def aligned(columns: Mapping[str, Column]) -> tuple[dict[str, Value], bool]:
    """Return values that broadcast row by row, and whether any of them has a row axis.

    All other axes broadcast from the last one, as they do without rows.
    """
    rank = max((column.rank for column in columns.values()), default=0)
    values = {name: column.padded(rank) for name, column in columns.items()}
    return values, any(column.is_row for column in columns.values())


def stacked(items: Sequence[Column]) -> Column:
    """Return single values as one column of lists; some of the values may differ between rows."""
    if not any(item.is_row for item in items):
        return Column(np.array([item.value for item in items], dtype=float))
    values = np.broadcast_arrays(*(item.value for item in items))
    return Column(np.stack(list(values), axis=-1), is_row=True)


UNEQUAL = (
    "the length of its curve differs between rows, but all rows of a table need curves of one length: "
    "omit this output, or vary something else"
)


def scattered(count: int, parts: Iterable[tuple[Indices | slice, Column]]) -> Column:
    """Return one column for `count` rows, assembled from parts; rows that belong to no part are NaN.

    Raises
    ------
    FaultyText
        If the parts have curves of different lengths; the code is `shape`.
    """
    pieces = list(parts)
    try:
        places: tuple[int, ...] = reduce(np.broadcast_shapes, (column.places for _, column in pieces), ())
    except ValueError:
        raise FaultyText("shape", UNEQUAL) from None
    whole = np.full((count, *places), np.nan)
    for rows, column in pieces:
        whole[rows] = column.padded(len(places))
    return Column(whole, is_row=True)


@dataclass(frozen=True, slots=True)
class RowEstimate:
    """The values [SI] of all rows and their errors.

    Attributes
    ----------
    one
        The value and its error; the row may be their first axis.
    is_row, is_row_error, is_row_scale
        Whether the value, its error, and the scale of a relative error have a row axis.
    """

    one: Estimate
    is_row: bool = False
    is_row_error: bool = False
    is_row_scale: bool = False

    @classmethod
    def exact(cls, column: Column, axes: int = 0) -> RowEstimate:
        """Return an estimate without error."""
        return cls(Estimate(column.value, axes=axes), column.is_row)

    @property
    def value(self) -> Column:
        """Return the value."""
        return Column(self.one.value, self.is_row)

    @property
    def error(self) -> Column:
        """Return the relative error; 0 for an exact value, NaN if unknown."""
        return Column(self.one.error, self.is_row_error)

    @property
    def has_rows(self) -> bool:
        """Return whether the value or its error differs from row to row."""
        return self.is_row or self.is_row_error

    @property
    def rank(self) -> int:
        """Return the number of axes of the value in one row, not counting the axis of a curve."""
        return max(self.value.rank - self.one.axes, 0)

    def padded(self, rank: int) -> Estimate:
        """Return an estimate whose arrays broadcast with arrays of a larger rank."""
        if not (self.is_row or self.is_row_error or self.is_row_scale):
            return self.one
        one, value = self.one, self.value
        scale = None if one.scale is None else Column(one.scale, self.is_row_scale).padded(rank)
        axes = one.axes if value.rank else 0
        error = self.error.padded(rank)
        return Estimate(value.padded(rank + one.axes), error, axes, scale)

    def bounds(self) -> tuple[Column, Column]:
        """Return the lower and upper end of the error band; both equal the value if its error is unknown."""
        one = self.one
        error = np.nan_to_num(one.error, nan=0.0)
        scale = None if one.scale is None else np.nan_to_num(one.scale, nan=0.0)
        finite = replace(self, one=replace(one, error=error, scale=scale))
        low, high = finite.padded(0).bounds()
        return Column(low, self.has_rows), Column(high, self.has_rows)

    def missing(self, count: int) -> Mask:
        """Return a mask of the rows whose value is missing at any point."""
        return self.value.unknown_rows(count)

    def unknown(self, count: int) -> Mask:
        """Return a mask of the rows whose error is unknown at any point."""
        return self.error.unknown_rows(count)
