"""The differences between two revisions, of one design or of two."""

from __future__ import annotations

from typing import Self

from pydantic import Field

from app.designs.schemas.designs import State
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
    """A value of one side; an array of more than 20 numbers by its range."""

    value: Value = Field(None, description="absent for a long array")
    unit: str | None = Field(None, description="absent for a text")
    reason: str | None = Field(None, description="why there is no value")
    count: int | None = Field(None, description="numbers in a long array")
    least: float | None = Field(None, description="of a long array, in `unit`")
    largest: float | None = Field(None, description="of a long array, in `unit`")

    def in_units(self, system: System) -> Self:
        """Return the value, or the range, in a system of units."""
        shown = super().in_units(system)
        if self.unit is None or shown.unit == self.unit or "least" not in self.model_fields_set:
            return shown
        ends = {name: shown_value(getattr(self, name), self.unit, system) for name in ("least", "largest")}
        rest = {name: getattr(shown, name) for name in shown.model_fields_set if name != "value"}
        return type(self)(**{**rest, **ends})


class ValueDifference(Answer):
    """A value that is not the same on both sides; null where a side has none."""

    name: str = Field(description="as in relations: `film.minimum_film_thickness`")
    old: ComparedValue | None
    new: ComparedValue | None
    change: float | None = Field(
        None,
        description="(new − old) / |old|; of an array the largest change by the largest value; absent for "
        "temperatures, texts and a value of 0",
    )
    difference: Quantity | None = Field(None, description="new − old, of single numbers of one kind")


class TextChange(Answer):
    """A text that is not the same: a relation, a version; null where a side has none."""

    name: str
    old: str | None
    new: str | None


class VerdictOf(Answer):
    """Verdict on a criterion, and the values that it compares."""

    verdict: str
    utilisation: float | None = Field(None, description="absent where there is none")


class VerdictChange(Answer):
    """A criterion that is not judged alike; null where a side has no such criterion."""

    name: str
    old: VerdictOf | None
    new: VerdictOf | None


class Comparison(Answer):
    """All that differs between two revisions; what is equal is left out."""

    old: Side
    new: Side
    parameters: list[TextChange] = Field(description="parameters of the design, as typed")
    versions: list[TextChange] = Field(description="templates and models by step: version, code, level")
    relations: list[TextChange] = Field(description="relations of inputs and model parameters")
    inputs: list[ValueDifference]
    outputs: list[ValueDifference]
    criteria: list[VerdictChange]
    model_parameters: list[ValueDifference]
    measurements: list[ValueDifference] = Field(description="measured on the solids of the two revisions")
