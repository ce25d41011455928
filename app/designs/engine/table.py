"""The results of many rows of a design: columns, errors, levels, and the reasons for missing values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from app.designs.engine.calculation import Calculation
from app.designs.engine.columns import Column
from app.designs.engine.refusals import Refusal
from app.designs.engine.verdicts import JudgedColumn, RowCodes, Verdicts
from app.designs.network import Subject
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs


@dataclass
class Table:
    """The results of `count` rows.

    Attributes
    ----------
    columns
        Values in SI by name, of shape (N,), or (N, K) for a curve. NaN where a row is refused, an output does
        not exist, or a value is pending. A value that is equal in all rows is a read-only view.
    errors
        The relative error that a step states for its output, of shape (N,); NaN where it states none.
    refusals
        For each refused row, the first reason why values are missing.
    absent
        Outputs without a value in some rows that are not refused, each with the first reason.
    levels
        The level of each step, which is the same for all rows.
    verdicts
        The verdict of each row by criterion, as an index into `criteria.comparison.VERDICTS`.
    judged
        The compared numbers of each row by criterion, if they were requested.
    """

    count: int
    columns: dict[Reference, Array] = field(default_factory=dict)
    errors: dict[Reference, Array] = field(default_factory=dict)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    absent: dict[Reference, str] = field(default_factory=dict)
    levels: dict[str, str | None] = field(default_factory=dict)
    verdicts: dict[str, RowCodes] = field(default_factory=dict)
    judged: dict[str, JudgedColumn] = field(default_factory=dict)

    @classmethod
    def of(cls, count: int, wanted: Iterable[Reference]) -> Table:
        """Return an empty table for `count` rows; if `count` is 0, its columns are complete."""
        return cls(count) if count else cls(0, {reference: np.empty(0) for reference in wanted})

    def add(self, start: int, rows: Calculation, wanted: Iterable[Reference]) -> None:
        """Add the results of a chunk that begins at row `start`."""
        chunk = slice(start, start + rows.count)
        for reference in wanted:
            column = rows.column(reference)
            self.columns[reference] = self._filled(self.columns.get(reference), chunk, column, reference)
            if rows.is_output(reference):
                step, output = rows.step(reference.block), reference.member
                error = step.error(output) if step else Column(np.nan)
                self.errors[reference] = self._filled(self.errors.get(reference), chunk, error, reference)
                if step and (absence := step.absence(output)):
                    self.absent.setdefault(reference, absence)
        needed = rows.needs.members if rows.needs else ()
        steps = (name for name in needed if not rows.graph.blocks[name].is_model)
        self.levels |= dict.fromkeys(steps) | rows.levels_used()
        self.refusals |= _refusals(rows, start)

    def judge(
        self, start: int, rows: Calculation, subjects: Mapping[str, Subject], *, with_columns: bool
    ) -> None:
        """Judge the rows of a chunk that begins at row `start`, and add their verdicts."""
        verdicts, chunk = Verdicts(rows), slice(start, start + rows.count)
        for name, subject in subjects.items():
            codes, column = verdicts.rows(subject)
            if name not in self.verdicts:
                self.verdicts[name] = np.empty(self.count, dtype=np.int8)
            self.verdicts[name][chunk] = codes
            if with_columns:
                whole = self.judged.get(name)
                self.judged[name] = column.within(whole, chunk, self.count)

    def _filled(self, whole: Array | None, chunk: slice, column: Column, reference: Reference) -> Array:
        """Return a column with the values of a chunk filled in; allocate it at the first chunk.

        If one value serves all rows, the column is a view of it.
        """
        if not column.is_row and chunk == slice(0, self.count):
            return column.spread(self.count)
        if whole is None or (whole.ndim == 1 and column.rank):
            whole = np.full((self.count, *column.places), np.nan)
        if column.rank and column.places != whole.shape[1:]:
            detail = f"curves of different lengths in one column: {whole.shape[1:]} and {column.places}"
            raise InvalidInputs([Fault(str(reference), "shape", detail)])
        whole[chunk] = column.padded(whole.ndim - 1)
        return whole


def _refusals(rows: Calculation, start: int) -> Mapping[int, Refusal]:
    if rows.for_all is not None:
        return dict.fromkeys(range(start, start + rows.count), rows.for_all)
    return {start + row: refusal for row, refusal in rows.refusals.items()}
