"""Fields for what the library gives: limits of criteria, by hand or by a row, and rows that fill an input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from pydantic import JsonValue

from app.presentation.typed import text_of, value_of
from app.schemas.library import LibraryRow, LibraryTable, LibraryTables
from app.schemas.templates import DeclaredLimit, Template
from app.web.api import Api
from app.web.sheet import Field

PREFIX = "limits."
"""Of the controls; the interface calls a fault of a limit by the same name."""


def limits_of(filled: Mapping[str, str]) -> dict[str, JsonValue]:
    """The limits among the fields of a form that hold a text."""
    return {
        name.removeprefix(PREFIX): value_of(text) for name, text in filled.items() if name.startswith(PREFIX)
    }


async def library(api: Api) -> list[LibraryTable]:
    """Every table of the library."""
    listed = await api.get("/library", LibraryTables)
    return [await api.get(f"/library/{table.id}", LibraryTable) for table in listed.items]


def limit_fields(
    template: Template,
    tables: Sequence[LibraryTable],
    chosen: Mapping[str, JsonValue],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
) -> list[Field]:
    """A choice for each table that gives limits of this template, then a field for each limit."""
    limits = {limit.name: limit for criterion in template.criteria for limit in criterion.limits}
    taken = {limit.library for limit in limits.values()}
    rows = {table.id: list(_rows(table, limits)) for table in tables if table.id in taken}
    choices = [_choice(table, rows[table.id]) for table in tables if table.id in rows]
    fields = [*choices, *(_field(limit) for limit in limits.values())]
    return [
        replace(
            field,
            text=typed.get(field.control, text_of(chosen.get(field.control.removeprefix(PREFIX)))),
            error=faults.get(field.name),
        )
        for field in fields
    ]


def _rows(table: LibraryTable, limits: Mapping[str, DeclaredLimit]) -> Iterator[LibraryRow]:
    """The rows that have a value for a limit which is taken from this table."""
    taken = {name for name, limit in limits.items() if limit.library == table.id}
    yield from (row for row in table.rows if not taken.isdisjoint(row.values))


def _choice(table: LibraryTable, rows: Sequence[LibraryRow]) -> Field:
    return Field(
        name=PREFIX + table.id,
        control=PREFIX + table.id,
        words=table.id.replace("_", " "),
        text="",
        error=None,
        options=tuple(row.id for row in rows),
        labels={row.id: row.words for row in rows},
    )


def _field(limit: DeclaredLimit) -> Field:
    return Field(
        name=PREFIX + limit.name,
        control=PREFIX + limit.name,
        words=limit.words,
        text="",
        error=None,
        unit=limit.unit,
        hint="by the row above" if limit.library else limit.default or "not given",
    )


def with_rows(fields: Sequence[Field], tables: Sequence[LibraryTable]) -> list[Field]:
    """The fields of inputs, with the rows of the library that may fill them as suggestions."""
    return [replace(field, suggestions=dict(_filling(field.name, tables))) for field in fields]


def _filling(name: str, tables: Sequence[LibraryTable]) -> Iterator[tuple[str, str]]:
    for table in tables:
        columns = [column.name for column in table.columns if name in column.fills]
        for row in table.rows:
            for column in columns:
                if column in row.values:
                    cited = row.values[column]
                    yield f"{cited.value:g} {cited.unit}", row.words
