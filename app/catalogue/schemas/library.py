"""The library as the interface describes it: tables of materials, oils and finishes, each value cited."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Measured, Page


class CitedQuantity(Measured):
    """One number with its unit, and where it comes from."""

    value: float
    unit: str
    source: str = Field(description="the citation of this value")


class LibraryColumn(Answer):
    """A quantity that the rows of a table give."""

    name: str
    unit: str
    words: str
    fills: list[str] = Field(description="inputs of templates that may take the value")


class LibraryRow(Answer):
    """One material, oil or finish."""

    id: str = Field(description='what a request names: `"limits": {"bearing_material": "tin_bronze"}`')
    words: str
    values: dict[str, CitedQuantity] = Field(description="by the name of the column; absent where no source")
    source: str
    note: str | None = None


class LibraryTableSummary(Answer):
    """One table in the list."""

    id: str
    title: str
    words: str
    limits: bool = Field(description="whether a row may be named among the `limits` of a calculation")
    rows: int


class LibraryTables(Page[LibraryTableSummary]):
    """The tables of the library."""


class LibraryTable(Answer):
    """One table with all its rows."""

    id: str
    title: str
    words: str
    limits: bool = Field(description="whether a row may be named among the `limits` of a calculation")
    columns: list[LibraryColumn]
    rows: list[LibraryRow]
