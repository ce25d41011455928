"""Response models of the table of results: one row for a design or variant, one column for a value."""

from __future__ import annotations

from typing import Self

from pydantic import Field

from app.presentation.units import System, shown_unit, shown_value
from app.schemas.answers import Answer
from app.schemas.criteria import Word

Number = float | str | bool | None
"""A number in the unit of its column, the word of a choice, or null without a value."""


class ResultColumn(Answer):
    """A value of a design that the table shows."""

    name: str = Field(description="its name in relations: `film.minimum_film_thickness`, `shell.mass`")
    words: str = Field(description="the heading; with the step or model if several have this value")
    unit: str | None = Field(None, description="unit of all rows; absent for a choice")


class ResultRow(Answer):
    """The results of a design or of one of its variants."""

    name: str = Field(description="name of the variant; `base`: the design itself")
    values: list[Number] = Field(description="in the order of the columns")
    reasons: dict[str, str] = Field({}, description="why a value is missing, by column; absent if none is")
    changes: list[float | None] = Field(
        [], description="relative change of each number from the first row; absent if not requested"
    )
    verdict: Word | None = Field(None, description="verdict over all criteria; null without criteria")
    error_unknown: bool = Field(False, description="whether the verdict depends on an unknown error")
    criterion: str | None = Field(None, description="the governing criterion; null if none was checked")
    criterion_words: str = Field("", description="the governing criterion in words")
    utilisation: float | None = Field(None, description="used share of its limit; null for a temperature")
    governs: bool = Field(False, description="whether the row is the worst; several rows may be equally bad")
    problem: str | None = Field(None, description="why the row has no results; else absent")


class ResultTable(Answer):
    """The results of a design and its variants, as pages, reports and files show them."""

    columns: list[ResultColumn]
    rows: list[ResultRow]
    governing: str = Field("", description="sentence on the rows that govern; empty without criteria")

    def in_units(self, system: System) -> Self:
        """Return the table with every column in a system of units."""
        if system == "si":
            return self
        columns = [
            one.model_copy(update={"unit": shown_unit(one.unit, system)}) if one.unit else one
            for one in self.columns
        ]
        rows = [
            row.model_copy(
                update={
                    "values": [
                        shown_value(value, one.unit, system) if one.unit else value
                        for value, one in zip(row.values, self.columns, strict=True)
                    ]
                }
            )
            for row in self.rows
        ]
        return self.model_copy(update={"columns": columns, "rows": rows})
