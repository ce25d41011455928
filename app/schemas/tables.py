"""A pasted table, and the assignment of its columns to the fields of a form."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer
from app.schemas.bounds import Bounded

_STRICT = ConfigDict(strict=True, extra="forbid")


class TableField(Bounded):
    """A field of a form that accepts a column."""

    model_config = _STRICT

    name: str = Field(max_length=200)
    words: str = Field("", max_length=200)
    symbol: str = Field("", max_length=200)
    unit: str = Field("1", max_length=60)


class ChosenColumn(Bounded):
    """The user's choice for a column: its field (empty for none), and its unit."""

    model_config = _STRICT

    field: str = Field(max_length=200)
    unit: str = Field(max_length=60)


class PastedTable(Bounded):
    """A pasted table, the fields of the form, and the user's choices so far."""

    model_config = _STRICT

    text: str
    file: str = Field("", description="a file in base64, which is read instead of the text")
    fields: list[TableField] = Field(max_length=200)
    columns: list[ChosenColumn] | None = Field(
        None, max_length=32, description="the user's choices; null to request a proposal"
    )
    offset: str = Field(
        "", max_length=100, description="offset that is added to the angles, such as `10 deg`"
    )


class ReadColumn(Answer):
    """A column as it was read, and the field assigned to it."""

    name: str
    unit: str
    field: str


class ReadTable(Answer):
    """The columns and first rows of a table, assumptions and faults, and the texts for the fields."""

    columns: list[ReadColumn]
    first: list[list[float]] = Field(description="the first rows, as they will be inserted")
    rows: int
    notes: list[str] = []
    assumed: list[str] = Field(
        [], description="assumptions made, such as the decimal mark and the averaging of cycles"
    )
    faults: list[str] = []
    texts: dict[str, str] = Field({}, description="texts by field; empty while there are faults")
