"""Building blocks of the answers of the interface.

An answer is a Pydantic model that its route, the client, the pages and the reports share. A field that an
answer leaves out is not written; a field that may be null says so.
"""

from __future__ import annotations

from typing import Annotated, Generic, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema
from pydantic.config import JsonDict

from app.plain import JsonObject
from app.presentation.units import System, shown_unit, shown_value

Item = TypeVar("Item")


class Answer(BaseModel):
    """An answer of the interface; a name that the model lacks is a fault of the program."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    def plain(self) -> JsonObject:
        """Return the answer as plain JSON values, without the fields that it leaves out."""
        return self.model_dump(mode="json", by_alias=True, exclude_unset=True)

    def in_units(self, system: System) -> Self:
        """Return the answer with every quantity in a system of units.

        A value without a unit stays unchanged.
        """
        if system == "si":
            return self
        return self.model_copy(
            update={name: _in_units(getattr(self, name), system) for name in self.model_fields_set}
        )


def _in_units(value: object, system: System) -> object:
    """Return a field of an answer, or an item of one, in a system of units."""
    if isinstance(value, Answer):
        return value.in_units(system)
    if isinstance(value, dict):
        return {name: _in_units(item, system) for name, item in value.items()}
    if isinstance(value, list) and value and not isinstance(value[0], float):
        return [_in_units(item, system) for item in value]
    return value


VALUE: JsonDict = {
    "description": "a number, an array of numbers of any shape, or the text of a choice; null for none",
    "anyOf": [
        {"type": "number"},
        {"type": "string"},
        {"type": "boolean"},
        {"type": "array", "items": {}},
        {"type": "null"},
    ],
}
Value = Annotated[object, WithJsonSchema(VALUE)]  # Pydantic would look at each of a million numbers
"""A magnitude of any shape, or a choice. JSON Schema has no finite form for arrays of any depth."""


class Measured(Answer):
    """A magnitude `value` with its `unit`, which another system of units replaces."""

    def in_units(self, system: System) -> Self:
        """Return the magnitude in a system of units."""
        unit: str | None = getattr(self, "unit", None)
        if unit is None or shown_unit(unit, system) == unit:
            return self
        value = shown_value(getattr(self, "value", None), unit, system)
        return self.model_copy(update={"value": value, "unit": shown_unit(unit, system)})


class Quantity(Measured):
    """One number with its unit."""

    value: float
    unit: str


class Triple(Measured):
    """A vector, or the coordinates of a point, with their unit."""

    value: tuple[float, float, float]
    unit: str


class Values(Measured):
    """Numbers with one unit."""

    value: list[float]
    unit: str


class Shown(Measured):
    """A value as it is shown: a quantity of any shape, or a choice, which has no unit."""

    value: Value
    unit: str | None = Field(None, description="absent for a choice")
    upper: float | None = Field(None, description="limit deviations of a toleranced dimension, in that unit")
    lower: float | None = None
    zone: str | None = Field(None, description="of ISO 286, from which the limits come")

    def in_units(self, system: System) -> Self:
        """Return the magnitude and its limit deviations, which are differences, in a system of units."""
        shown = super().in_units(system)
        if self.unit is None or self.upper is None or self.lower is None or shown.unit == self.unit:
            return shown
        upper, lower = (shown_value(end, self.unit, system) for end in (self.upper, self.lower))
        return shown.model_copy(update={"upper": upper, "lower": lower})


class Warning(Answer):
    """Something that the user of a result should know."""

    code: str
    name: str = Field(description="the input or output it is about")
    detail: str


class Page(Answer, Generic[Item]):
    """Items of a list, and where the next ones begin."""

    items: list[Item]
    next: str | None = Field(description="`cursor` of the next page; null on the last one")


class Accepted(Answer):
    """The work goes on as a job."""

    job: str = Field(description="path of the job")


class Version(Answer):
    """One version of a template or model."""

    id: str
    version: int
