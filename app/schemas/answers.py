"""Building blocks for responses of the interface.

A response is a Pydantic model that its route, the client, the pages and the reports share. A field that is
not set is not written; a field that may be null is declared so.
"""

from __future__ import annotations

from typing import Annotated, Generic, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema
from pydantic.config import JsonDict

from app.plain import JsonObject
from app.presentation.units import System, shown_unit, shown_value

Item = TypeVar("Item")


class Answer(BaseModel):
    """Base class of responses; a field that the model lacks is an error of the program."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    def plain(self) -> JsonObject:
        """Return the response as plain JSON values, without fields that are not set."""
        return self.model_dump(mode="json", by_alias=True, exclude_unset=True)

    def in_units(self, system: System) -> Self:
        """Return the response with every quantity in a system of units.

        A value without a unit stays unchanged.
        """
        if system == "si":
            return self
        return self.model_copy(
            update={name: _in_units(getattr(self, name), system) for name in self.model_fields_set}
        )


def _in_units(value: object, system: System) -> object:
    """Return a field of a response, or an item of it, in a system of units."""
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
Value = Annotated[object, WithJsonSchema(VALUE)]  # Pydantic would validate each of a million numbers
"""A magnitude of any shape, or a choice. JSON Schema has no finite form for arrays of any depth."""


class Measured(Answer):
    """A magnitude `value` with its `unit`; both change with the system of units."""

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
    """A displayed value: a quantity of any shape, or a choice, which has no unit."""

    value: Value
    unit: str | None = Field(None, description="unit; absent for a choice")
    upper: float | None = Field(None, description="limit deviations of a toleranced dimension, in `unit`")
    lower: float | None = None
    zone: str | None = Field(None, description="ISO 286 tolerance zone that defines the limits")
    state_in_table: bool | None = Field(
        None, description="whether the table of a drawing states the tolerance if no face carries it"
    )

    def in_units(self, system: System) -> Self:
        """Return the magnitude and its limit deviations, which are differences, in a system of units."""
        shown = super().in_units(system)
        if self.unit is None or self.upper is None or self.lower is None or shown.unit == self.unit:
            return shown
        upper, lower = (shown_value(end, self.unit, system) for end in (self.upper, self.lower))
        return shown.model_copy(update={"upper": upper, "lower": lower})


class Warning(Answer):
    """A warning for the user of a result."""

    code: str
    name: str = Field(description="the input or output that the warning is about")
    detail: str


class Page(Answer, Generic[Item]):
    """A page of a list, and the cursor of the next page."""

    items: list[Item]
    next: str | None = Field(description="`cursor` of the next page; null on the last page")


class Accepted(Answer):
    """The work continues as a job."""

    job: str = Field(description="path of the job")


class FileAccepted(Accepted):
    """The file is stored, and its import continues as a job."""

    storage_mb: float = Field(description="content stored by the principal so far, with this file [MiB]")
    storage_limit_mb: float | None = Field(description="limit of this amount; null if there is none [MiB]")


class Version(Answer):
    """One version of a template or model."""

    id: str
    version: int
