"""`/library`: bearing materials, oils and surface finishes, each value with its source."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.catalogue.schemas.library import (
    CitedQuantity,
    LibraryColumn,
    LibraryRow,
    LibraryTable,
    LibraryTables,
    LibraryTableSummary,
)
from app.http.pages import Cursor, Limit, page_of
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals
from templates.library.csv_tables import CitedValue, Row
from templates.library.tables import Column, Table, table, tables

router = APIRouter(prefix="/api/v1/library", tags=["library"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64, examples=["bearing_material"])]


@router.get("")
def list_library_tables(limit: Limit = 100, cursor: Cursor = None) -> LibraryTables:
    """Return the tables of the library."""
    return page_of(LibraryTables, list(tables().values()), limit, cursor, _summary)


@router.get("/{table_id}", responses=refusals(404))
def show_library_table(table_id: Id) -> LibraryTable:
    """Return one table: its columns, and its rows with a source for each value."""
    one = table(table_id)
    return LibraryTable(
        id=one.id,
        title=one.title,
        words=one.words,
        limits=one.limits,
        columns=[_column(column) for column in one.columns],
        rows=[_row(row) for row in one.rows],
    )


def _summary(table: Table) -> LibraryTableSummary:
    return LibraryTableSummary(
        id=table.id, title=table.title, words=table.words, limits=table.limits, rows=len(table.rows)
    )


def _column(column: Column) -> LibraryColumn:
    return LibraryColumn(name=column.name, unit=column.unit, words=column.words, fills=list(column.fills))


def _row(row: Row) -> LibraryRow:
    values = {name: _cited(cited) for name, cited in row.values.items()}
    return LibraryRow(id=row.id, words=row.words, values=values, source=row.source, note=row.note or None)


def _cited(cited: CitedValue) -> CitedQuantity:
    return CitedQuantity(value=cited.value, unit=cited.unit, source=cited.source)
