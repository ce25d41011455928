"""Response schemas for the library: tables of materials, oils and finishes, with cited values."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Measured, Page


class CitedQuantity(Measured):
    """One number with its unit and its source."""

    value: float
    unit: str
    source: str = Field(description="the citation of this value")


class LibraryColumn(Answer):
    """A quantity that the rows of a table contain."""

    name: str
    unit: str
    words: str
    fills: list[str] = Field(description="inputs of templates that accept this value")


class LibraryRow(Answer):
    """One material, oil or finish."""

    id: str = Field(description='id to use in a request: `"limits": {"bearing_material": "tin_bronze"}`')
    words: str
    values: dict[str, CitedQuantity] = Field(description="values by column; absent without a source")
    source: str
    note: str | None = None


class LibraryTableSummary(Answer):
    """A table of the library as a list item."""

    id: str
    title: str
    words: str
    limits: bool = Field(description="whether `limits` of a calculation may name a row")
    rows: int


class LibraryTables(Page[LibraryTableSummary]):
    """The tables of the library."""


class LibraryTable(Answer):
    """One table with all its rows."""

    id: str
    title: str
    words: str
    limits: bool = Field(description="whether `limits` of a calculation may name a row")
    columns: list[LibraryColumn]
    rows: list[LibraryRow]
