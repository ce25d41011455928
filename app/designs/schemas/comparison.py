"""The differences between two revisions, of one design or of two."""

from __future__ import annotations

from typing import Self

from pydantic import Field

from app.designs.schemas.designs import State
from app.designs.schemas.result_table import ResultTable
from app.presentation.units import System, shown_value
from app.schemas.answers import Answer, Measured, Quantity, Value


class Side(Answer):
    """One of the two revisions."""

    design: str
    name: str
    revision: int
    state: State
    created: str
    note: str | None


class ComparedValue(Measured):
    """A value of one revision; an array of more than 20 numbers is shown by its range."""

    value: Value = Field(None, description="absent for a long array")
    unit: str | None = Field(None, description="absent for a text")
    reason: str | None = Field(None, description="why there is no value")
    count: int | None = Field(None, description="number of values in a long array")
    least: float | None = Field(None, description="limit of the values in a long array, in `unit`")
    largest: float | None = Field(None, description="limit of the values in a long array, in `unit`")

    def in_units(self, system: System) -> Self:
        """Return the value, or the range, in a system of units."""
        shown = super().in_units(system)
        if self.unit is None or shown.unit == self.unit or "least" not in self.model_fields_set:
            return shown
        ends = {name: shown_value(getattr(self, name), self.unit, system) for name in ("least", "largest")}
        rest = {name: getattr(shown, name) for name in shown.model_fields_set if name != "value"}
        return type(self)(**{**rest, **ends})


class ValueDifference(Answer):
    """A value that differs between the revisions; null on a side that lacks it."""

    name: str = Field(description="as in relations: `film.minimum_film_thickness`")
    old: ComparedValue | None
    new: ComparedValue | None
    change: float | None = Field(
        None,
        description="(new − old) / |old|; for an array, the largest change divided by the largest value; "
        "absent for "
        "temperatures, texts and a value of 0",
    )
    difference: Quantity | None = Field(None, description="new − old, for two single numbers of one kind")


class TextChange(Answer):
    """A text that differs, such as a relation or a version; null on a side that lacks it."""

    name: str
    old: str | None
    new: str | None


class VerdictOf(Answer):
    """The verdict on a criterion, and its utilisation."""

    verdict: str
    utilisation: float | None = Field(None, description="absent if it is not defined")


class VerdictChange(Answer):
    """A criterion whose verdicts differ; null on a side that lacks the criterion."""

    name: str
    old: VerdictOf | None
    new: VerdictOf | None


class Comparison(Answer):
    """All differences between two revisions; equal values are left out."""

    old: Side
    new: Side
    table: ResultTable = Field(
        description="the main results of both revisions and their variants, the older one first, in which "
        "a row of the newer one states its change; without blocks whose results are equal"
    )
    parameters: list[TextChange] = Field(description="parameters of the design, as typed")
    versions: list[TextChange] = Field(description="templates and models by step: version, code, level")
    relations: list[TextChange] = Field(description="relations of inputs and model parameters")
    inputs: list[ValueDifference]
    outputs: list[ValueDifference]
    criteria: list[VerdictChange]
    model_parameters: list[ValueDifference]
    measurements: list[ValueDifference] = Field(description="measured on the solids of the two revisions")
