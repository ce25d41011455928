"""Values of rows with the errors of their own steps, as criteria take them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.designs.engine.columns import Column, Indices, scattered
from app.designs.engine.steps import Part, StepRows
from templates.core.arrays import Mask
from templates.core.judging.bands import Estimate
from templates.core.judging.judging import Absent
from templates.core.language.criteria import Evaluated, estimate_of
from templates.core.units.units import Value


@dataclass(frozen=True, slots=True)
class RowEstimate:
    """A value [SI] of every row and how far off it may be.

    Attributes
    ----------
    one
        The value and its error, which may have the row as their first axis.
    is_row, is_row_error, is_row_scale
        Whether its value, its error, and that to which this is relative have this axis.
    """

    one: Estimate
    is_row: bool = False
    is_row_error: bool = False
    is_row_scale: bool = False

    @classmethod
    def exact(cls, column: Column, axes: int = 0) -> RowEstimate:
        """A value that is what it is."""
        return cls(Estimate(column.value, axes=axes), column.is_row)

    @property
    def value(self) -> Column:
        """The value."""
        return Column(self.one.value, self.is_row)

    @property
    def error(self) -> Column:
        """The relative error; 0 if exact, NaN where it is not known."""
        return Column(self.one.error, self.is_row_error)

    @property
    def has_rows(self) -> bool:
        """Whether anything of it differs from row to row."""
        return self.is_row or self.is_row_error

    @property
    def is_stated(self) -> bool:
        """Whether anybody measured the error of the model, known or not."""
        return self.one.is_stated or (not self.has_rows and bool(np.isnan(self.one.error).any()))

    @property
    def rank(self) -> int:
        """Number of axes that the value has in a row beside those of a curve."""
        return max(self.value.rank - self.one.axes, 0)

    def padded(self, rank: int) -> Estimate:
        """As an estimate whose arrays broadcast with those of a larger rank."""
        if not (self.is_row or self.is_row_error or self.is_row_scale):
            return self.one
        one, value = self.one, self.value
        scale = None if one.scale is None else Column(one.scale, self.is_row_scale).padded(rank)
        axes = one.axes if value.rank else 0
        error = self.error.padded(rank)
        return Estimate(value.padded(rank + one.axes), error, one.is_stated, axes, scale)

    def bounds(self) -> tuple[Column, Column]:
        """Both ends of the band; the value itself where its error is not known."""
        one = self.one
        error = one.error if isinstance(one.error, float) else np.nan_to_num(one.error, nan=0.0)
        scale = None if one.scale is None else np.nan_to_num(one.scale, nan=0.0)
        finite = replace(self, one=replace(one, error=error, scale=scale))
        low, high = finite.padded(0).bounds()
        return Column(low, self.has_rows), Column(high, self.has_rows)

    def missing(self, count: int) -> Mask:
        """The rows that have no value at some place."""
        missing: Mask = np.any(np.isnan(self.value.spread(count).reshape(count, -1)), axis=1)
        return missing

    def unknown(self, count: int) -> Mask:
        """The rows whose error is not known at some point."""
        unknown: Mask = np.any(np.isnan(self.error.spread(count).reshape(count, -1)), axis=1)
        return unknown

    def unstated(self) -> RowEstimate:
        """The same, its error not stated."""
        return replace(self, one=replace(self.one, is_stated=False))

    def without_error(self, unknown: Mask) -> RowEstimate:
        """The same, its error not known in some rows, and not stated."""
        if not self.has_rows and unknown.all():
            return replace(self, one=replace(self.one, error=float("nan"), is_stated=False))
        error = np.where(unknown, np.nan, self.error.padded(0) if self.is_row_error else self.one.error)
        return replace(self, one=replace(self.one, error=error, is_stated=False), is_row_error=True)


Evaluations = Sequence[tuple[Part, Evaluated]]
"""The parts of a step as the criteria of its template see them."""


def estimate_rows(step: StepRows, evaluations: Evaluations, member: str) -> RowEstimate | Absent:
    """The value of an input or output of a step with its error; why there is none, if no row has one."""
    found = [(part, estimate_of(evaluated, member)) for part, evaluated in evaluations]
    present = [(part, one) for part, one in found if isinstance(one, Estimate)]
    if not present:
        return next((one for _, one in found if isinstance(one, Absent)), Absent())
    if not step.has_rows:
        return RowEstimate(present[0][1])
    axes = max(one.axes for _, one in present)
    value = _column(step, present, lambda one: one.value, axes)
    error = _column(step, present, lambda one: one.error, 0)
    is_stated = all(one.is_stated or bool(np.isnan(one.error).any()) for _, one in present)
    if all(one.scale is None for _, one in present):
        return RowEstimate(Estimate(value.value, error.value, is_stated, axes), value.is_row, error.is_row)
    scale = _column(step, present, lambda one: np.nan if one.scale is None else one.scale, 0)
    whole = Estimate(value.value, error.value, is_stated, axes, scale.value)
    return RowEstimate(whole, value.is_row, error.is_row, scale.is_row)


def _column(
    step: StepRows, parts: Sequence[tuple[Part, Estimate]], of: Callable[[Estimate], Value], axes: int
) -> Column:
    """One column of all parts; NaN in rows that are refused."""
    columns: list[tuple[Indices, Column]] = []
    for part, estimate in parts:
        value = of(estimate)
        columns.append((part.rows, Column(value, is_row=step.has_row_axis(part) and np.ndim(value) > axes)))
    if len(columns) == 1 and columns[0][0].size == step.count:
        whole = columns[0][1]
    else:
        whole = scattered(step.count, columns)
    return whole.without(step.refused()) if step.refusals else whole
