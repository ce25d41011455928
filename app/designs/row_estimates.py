"""Values of many rows with the errors of their own steps, as criteria take them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from app.designs.columns import Column, Indices, scattered
from app.designs.row_pass import RowPass
from app.designs.rows_needed import is_member
from app.designs.step_rows import Part, StepRows
from app.reference import Reference
from templates.core.arrays import Mask
from templates.core.judging.bands import Estimate
from templates.core.language.criteria import Evaluated, estimate_of
from templates.core.language.levels import accuracy
from templates.core.units.units import Value

EXACT = Column(0.0)


@dataclass(frozen=True)
class RowEstimate:
    """A value [SI] of every row and how far off it may be.

    Attributes
    ----------
    error
        Relative; 0 if exact, NaN where it is not known.
    is_stated
        Whether anybody measured the error of the model.
    axes
        How many of the last axes of the value are places along a curve.
    scale
        To what the error is relative, where that is not the value itself.
    """

    value: Column
    error: Column = EXACT
    is_stated: bool = True
    axes: int = 0
    scale: Column | None = None

    @property
    def rank(self) -> int:
        """Number of axes that the value has in a row beside those of a curve."""
        return max(self.value.rank - self.axes, 0)

    def padded(self, rank: int) -> Estimate:
        """As an estimate whose arrays broadcast with those of a larger rank."""
        scale = None if self.scale is None else self.scale.padded(rank)
        return Estimate(
            self.value.padded(rank + self.axes),
            self.error.padded(rank),
            self.is_stated,
            self.axes if self.value.rank else 0,
            scale,
        )

    def bounds(self) -> tuple[Column, Column]:
        """Both ends of the band; the value itself where its error is not known."""
        error = Column(np.nan_to_num(self.error.value, nan=0.0), self.error.is_row)
        estimate = RowEstimate(self.value, error, self.is_stated, self.axes, self._finite_scale()).padded(0)
        is_row = self.value.is_row or error.is_row
        low, high = estimate.bounds()
        return Column(low, is_row), Column(high, is_row)

    def _finite_scale(self) -> Column | None:
        if self.scale is None:
            return None
        return Column(np.nan_to_num(self.scale.value, nan=0.0), self.scale.is_row)

    def missing(self, count: int) -> Mask:
        """The rows that have no value at some place."""
        missing: Mask = np.any(np.isnan(self.value.spread(count).reshape(count, -1)), axis=1)
        return missing


def estimate_rows(rows: RowPass, reference: Reference, *, inside: bool = False) -> RowEstimate:
    """The value of a name with the error of its own step.

    What a cell holds is exact. `inside` takes the input of a step as the step was evaluated with it.
    """
    graph = rows.question.graph
    step = rows.steps.get(reference.block) if is_member(graph, reference) else None
    is_cell = graph.cell(reference) is not None or reference in rows.given
    if step is None or step.block.is_model or (is_cell and not inside) or reference in rows.changed:
        return RowEstimate(rows.value(reference))
    return _of_step(step, reference.member)


def _of_step(step: StepRows, member: str) -> RowEstimate:
    estimates = [(part, estimate_of(_evaluated(step, part), member)) for part in step.parts]
    present = [(part, one) for part, one in estimates if isinstance(one, Estimate)]
    if not present:
        return RowEstimate(Column(np.nan))
    axes = max(one.axes for _, one in present)
    scale = None
    if any(one.scale is not None for _, one in present):
        scale = _column(step, present, lambda one: np.nan if one.scale is None else one.scale, 0)
    return RowEstimate(
        _column(step, present, lambda one: one.value, axes),
        _column(step, present, lambda one: one.error, 0),
        all(one.is_stated or bool(np.isnan(one.error).any()) for _, one in present),
        axes,
        scale,
    )


def _column(
    step: StepRows, parts: Iterable[tuple[Part, Estimate]], of: Callable[[Estimate], Value], axes: int
) -> Column:
    """One column of all parts; NaN in rows that are refused."""
    columns: list[tuple[Indices, Column]] = []
    for part, estimate in parts:
        value = of(estimate)
        has_rows = step.has_rows and part.template.shape_of_points() == part.rows.shape
        columns.append((part.rows, Column(value, is_row=has_rows and np.ndim(value) > axes)))
    if len(columns) == 1 and columns[0][0].size == step.count:
        whole = columns[0][1]
    else:
        whole = scattered(step.count, columns)
    return whole.without(step.refused()) if step.refusals else whole


def _evaluated(step: StepRows, part: Part) -> Evaluated:
    """A part as the criteria of its template see it."""
    errors: Mapping[str, Value | None] = part.errors
    return Evaluated(
        part.template,
        part.answers,
        errors,
        accuracy(step.block.cls),
        step.block.limits,
        level=step.level,
    )
