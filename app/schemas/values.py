"""Input values in the OpenAPI description.

This describes only their form; the schema of each template and model states valid units and options.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, JsonValue, WithJsonSchema
from pydantic.config import JsonDict

from app.schemas.bounds import at_most

FORMS: list[JsonValue] = [
    {"type": "string", "minLength": 1},
    {"type": "number"},
    {"type": "array", "minItems": 1, "items": {}},
    {"type": "object", "properties": {"value": {}, "unit": {"type": "string"}}, "required": ["value"]},
]
GIVEN: JsonDict = {
    "description": 'a quantity, `"25 kN"`, `"25 ± 1 kN"` or `{"value": 25, "unit": "kN"}`; a number of '
    "unit 1; a choice. A tolerance of a model that no face can carry ends with `, in table`, or has "
    "`state_in_table` in an object",
    "anyOf": FORMS,
}
Given = Annotated[object, WithJsonSchema(GIVEN)]
"""A value as typed; the domain reads it and reports faults."""

Between = Annotated[
    list[Given],
    Field(min_length=2, max_length=2, description="an interval: the lowest and the highest value to try"),
]
"""An interval of an input, as every search takes it."""

Limits = Annotated[
    dict[str, Given],
    Field(
        max_length=200,
        description="limits of criteria that are not inputs of the calculation, by name, or library rows: "
        '`{"permissible_pressure": "35 MPa"}`, `{"bearing_material": "…"}`',
    ),
    at_most(200),
]
"""Limits that a user gives for criteria."""

Parameters = Annotated[dict[str, Given], Field(max_length=500), at_most(500)]
"""Parameters of a model by name."""
