"""Inputs, parameters and outputs of a template or model, read from its JSON Schemas."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache

from pydantic import BaseModel, Field, JsonValue, TypeAdapter

from app.catalogue.schemas.templates import Schema


class DeclaredValue(BaseModel):
    """One input, parameter or output; only the parts of its schema that pages use."""

    title: str
    symbol: str | None = None
    unit: str | None = None
    along: str | None = None  # for a curve: the name of its axis
    enum: tuple[str, ...] = ()
    library: str | None = None  # for a limit: the library table whose rows may be named
    filled_by: str | None = Field(None, alias="from")  # for a limit: the table whose rows have a value for it
    default: JsonValue = None
    default_formula: str | None = None
    examples: list[JsonValue] = []
    anyOf: list[dict[str, JsonValue]] = []  # the accepted forms of the value

    @property
    def has_default(self) -> bool:
        """Return whether the schema has a default, which an empty field stands for."""
        return "default" in self.model_fields_set

    @cached_property
    def is_list(self) -> bool:
        """Return whether the value is a list or a curve, judged by its accepted forms or its example."""
        has_list = any(_holds_list(example) for example in self.examples)
        return has_list or (bool(self.anyOf) and all(_is_list(form) for form in self.anyOf))


def _holds_list(example: JsonValue) -> bool:
    return isinstance(example.get("value") if isinstance(example, dict) else example, list)


def _is_list(form: dict[str, JsonValue]) -> bool:
    """Return whether one accepted form of a value is a list, or a quantity with a list."""
    match form:
        case {"type": "array"} | {"properties": {"value": {"type": "array"}}}:
            return True
    return False


_PROPERTIES = TypeAdapter(dict[str, DeclaredValue])
_NAMES = TypeAdapter(frozenset[str])


class _Same:
    """A schema that compares by identity, because hashing its content would cost as much as reading it."""

    __slots__ = ("schema",)

    def __init__(self, schema: Schema) -> None:
        self.schema = schema

    def __hash__(self) -> int:
        return id(self.schema)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.schema is other.schema


def properties(schema: Schema) -> Mapping[str, DeclaredValue]:
    """Return the declarations in a schema by name, in order; the result is cached for each schema object."""
    return _read(_Same(schema))


@lru_cache(maxsize=64)
def _read(same: _Same) -> Mapping[str, DeclaredValue]:
    return _PROPERTIES.validate_python(same.schema.get("properties", {}))


def required(schema: Schema) -> frozenset[str]:
    """Return the names of the required values in a schema."""
    return _NAMES.validate_python(schema["required"])
