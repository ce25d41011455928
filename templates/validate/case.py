"""A published case: which file, which template or model, and how its numbers follow from ours."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from templates.validate.reference import Column, Reference, Row, reference

Kind = Literal["measurement", "printed example", "printed table", "other program"]
Numbers = Mapping[str, Sequence[float]]
"""Values by column of the file, one for each row."""


@dataclass(frozen=True)
class Case:
    """One published bearing, crank or engine, at one condition or one table of conditions.

    `ours` returns a value for each compared column and row. A case that differs states the reason in
    `because`, or that it is unknown. `abscissa` names the column over which the plot shows the `ordinate`.
    """

    key: str
    title: str
    file: str
    subject: str
    kind: Kind
    ours: Callable[[Sequence[Row]], Numbers]
    rows: Mapping[str, str] = field(default_factory=dict)
    columns: tuple[str, ...] = ()
    abscissa: str = ""
    ordinate: str = ""
    because: str = ""
    is_slow: bool = False

    @property
    def reference(self) -> Reference:
        """Return the published numbers."""
        return reference(self.file)

    @property
    def selected(self) -> list[Row]:
        """Return the rows of the file that belong to this case."""
        return [row for row in self.reference.rows if self.rows.items() <= row.items()]

    @property
    def compared(self) -> list[Column]:
        """Return the columns that this case compares: those with a published number in its rows."""
        wanted = [c for c in self.reference.compared if not self.columns or c.name in self.columns]
        return [column for column in wanted if any(row[column.name] for row in self.selected)]

    def calculate(self) -> Numbers:
        """Return our values of the compared columns, each with nine digits."""
        found = self.ours(self.selected)
        return {column.name: [float(f"{x:.9g}") for x in found[column.name]] for column in self.compared}


def by_row(ours: Callable[[dict[str, float]], Mapping[str, float]]) -> Callable[[Sequence[Row]], Numbers]:
    """Return a function over rows from one that calculates a single row of numbers."""

    def over_rows(rows: Sequence[Row]) -> Numbers:
        found = [ours(numbers(row)) for row in rows]
        return {name: [values[name] for values in found] for name in found[0]}

    return over_rows


def numbers(row: Row) -> dict[str, float]:
    """Return the cells of a row that are numbers."""
    return {name: float(cell) for name, cell in row.items() if _is_number(cell)}


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
