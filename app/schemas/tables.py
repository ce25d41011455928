"""A pasted table, and the assignment of its columns to the fields of a form."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer
from app.schemas.bounds import Bounded

_STRICT = ConfigDict(strict=True, extra="forbid")


class TableField(Bounded):
    """A field that can take a column."""

    model_config = _STRICT

    name: str = Field(max_length=200)
    words: str = Field("", max_length=200)
    symbol: str = Field("", max_length=200)
    unit: str = Field("1", max_length=60)


class ChosenColumn(Bounded):
    """The choice of the user for a column: the field that takes it (empty for none), and its unit."""

    model_config = _STRICT

    field: str = Field(max_length=200)
    unit: str = Field(max_length=60)


class PastedTable(Bounded):
    """A table as pasted, the fields of the form, and what was chosen so far."""

    model_config = _STRICT

    text: str
    file: str = Field("", description="a file in base64, which is read in place of the text")
    fields: list[TableField] = Field(max_length=200)
    columns: list[ChosenColumn] | None = Field(None, max_length=32, description="null for a proposal")
    offset: str = Field("", max_length=100, description="added to the angles, such as `10 deg`")


class ReadColumn(Answer):
    """A column as it was read, and the field that takes it."""

    name: str
    unit: str
    field: str


class ReadTable(Answer):
    """The columns, the first rows, what to know, what is wrong, and the texts of the fields."""

    columns: list[ReadColumn]
    first: list[list[float]] = Field(description="the first rows, as they are taken")
    rows: int
    notes: list[str] = []
    assumed: list[str] = Field(
        [], description="what was assumed: the decimal mark, cycles that were averaged"
    )
    faults: list[str] = []
    texts: dict[str, str] = Field({}, description="by field; none while something is wrong")
