"""Two pages: the criteria of every template, and the tables of the library, each with its sources."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from handbook.rendering import render
from templates.core.language.template import Template
from templates.core.paper.demands import described_criteria
from templates.door import built_in
from templates.library.csv_tables import read_sources
from templates.library.tables import SOURCES, Table, tables


def pages() -> Iterator[tuple[str, str]]:
    """The page of the criteria, then that of the library."""
    judged = [cls for cls in built_in() if cls.declared_criteria]
    yield "reference/criteria.md", render("criteria.md.j2", templates=[_template(cls) for cls in judged])
    yield (
        "reference/library.md",
        render(
            "library.md.j2",
            tables=[_table(table) for table in tables().values()],
            sources=read_sources(SOURCES).values(),
        ),
    )


def _template(cls: type[Template]) -> dict[str, Any]:
    return {"id": cls.id, "version": cls.version, "criteria": [*map(described_row, described_criteria(cls))]}


def described_row(criterion: dict[str, Any]) -> dict[str, Any]:
    """A row of a table: who gives the limit, and whether it is verified."""
    return {**criterion, "given": [_given(limit) for limit in criterion["limits"]]}


def _given(limit: dict[str, Any]) -> str:
    """Where a limit that the calculation does not take comes from."""
    unit = "" if limit["unit"] == "1" else f" [{limit['unit']}]"
    row = f", or by a row of `{limit['library']}`" if limit["library"] else ""
    default = f"; else `{limit['default']}`" if limit["default"] else ""
    return f"`{limit['name']}`{unit}, given by its user{row}{default}"


def _table(table: Table) -> dict[str, Any]:
    """A table with a cell for each column: a number, or nothing."""
    rows = [
        {
            "id": row.id,
            "words": row.words,
            "cells": [row.values[column.name].value if column.name in row.values else None
                      for column in table.columns],
            "sources": list(dict.fromkeys(cited.source for cited in row.values.values())),
            "note": row.note,
        }
        for row in table.rows
    ]  # fmt: skip
    return {
        "id": table.id,
        "title": table.title,
        "words": table.words,
        "columns": table.columns,
        "rows": rows,
    }
