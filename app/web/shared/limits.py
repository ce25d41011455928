"""Fields that rows of the library can fill: limits of criteria, and inputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from pydantic import JsonValue

from app.catalogue.routes.library import list_library_tables, show_library_table
from app.catalogue.schemas.declarations import DeclaredValue, properties
from app.catalogue.schemas.library import LibraryRow, LibraryTable
from app.catalogue.schemas.templates import Template
from app.presentation.input_text import text_of, value_of
from app.reference import Reference
from app.schemas.values import Given
from app.web.engine_bearings.layouts import usual_orders
from app.web.shared.forms import LIMITS
from app.web.shared.services import PageServices
from app.web.shared.sheet import Field

FIRING_ORDER, OF_EACH_CYLINDER = "firing_order", ("cylinder_positions", "bank_angles")
"""The input that takes the usual orders of the known layouts, and lists with an item for each cylinder."""


def limits_of(filled: Mapping[str, str]) -> dict[str, JsonValue]:
    """Return the non-empty limits in a template's form."""
    return {name.removeprefix(LIMITS): value_of(text) for name, text in filled.items() if is_limit(name)}


def is_limit(control: str) -> bool:
    """Return whether a control of a template's form belongs to a limit."""
    return control.startswith(LIMITS)


async def library(services: PageServices) -> list[LibraryTable]:
    """Return every table of the library."""
    listed = await services.run(list_library_tables)
    return [await services.run(show_library_table, table.id) for table in listed.items]


def limit_fields(
    template: Template,
    block: str,
    given: Mapping[str, Given],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
    tables: Sequence[LibraryTable],
) -> list[Field]:
    """Return a choice for each table that supplies limits of this template, then a field for each limit.

    `block` is the name of the step; it is empty on the page of the template, which has no step.
    """
    limits = properties(template.given_limits)
    fields = []
    for tail, declared in limits.items():
        control = f"{block}@{LIMITS}{tail}" if block else f"{LIMITS}{tail}"
        name = control.replace("@", ".")
        text = typed.get(control, text_of(given.get(tail)))
        empty = _field(name, control, declared)
        rows = {row.id: row.words for row in _rows(declared.library, limits, tables)}
        fields.append(replace(empty, text=text, error=faults.get(name), options=tuple(rows), labels=rows))
    return fields


def _field(name: str, control: str, declared: DeclaredValue) -> Field:
    """Return an empty field, whose hint shows the value that applies if the field stays empty."""
    default = declared.default_formula or "not given"
    return Field(
        name=name,
        control=control,
        words=declared.title,
        text="",
        error=None,
        unit=declared.unit,
        hint="from the material" if declared.filled_by else default,
        needed=False,
    )


def _rows(
    id: str | None, limits: Mapping[str, DeclaredValue], tables: Sequence[LibraryTable]
) -> Iterator[LibraryRow]:
    """Yield the rows of a table that have a value for one of these limits."""
    taken = {name for name, limit in limits.items() if id and limit.filled_by == id}
    rows = (row for table in tables if table.id == id for row in table.rows)
    yield from (row for row in rows if not taken.isdisjoint(row.values))


def with_rows(fields: Sequence[Field], tables: Sequence[LibraryTable]) -> list[Field]:
    """Return the fields of inputs with their suggestions: rows of the library, usual firing orders."""
    return [
        _with_orders(one) if _tail(one.name) == FIRING_ORDER else _with_rows(one, tables) for one in fields
    ]


def _with_orders(one: Field) -> Field:
    head = one.control.removesuffix(FIRING_ORDER)
    return replace(one, suggestions=usual_orders(), beside=tuple(head + name for name in OF_EACH_CYLINDER))


def _with_rows(one: Field, tables: Sequence[LibraryTable]) -> Field:
    rows = dict(_filling(_tail(one.name), tables))
    return replace(one, suggestions=rows) if rows else one


def _tail(name: str) -> str:
    """Return the name of an input without the name of its step."""
    return Reference.parse(name).own_name


def _filling(name: str, tables: Sequence[LibraryTable]) -> Iterator[tuple[str, str]]:
    for table in tables:
        columns = [column.name for column in table.columns if name in column.fills]
        for row in table.rows:
            for column in columns:
                if column in row.values:
                    cited = row.values[column]
                    yield f"{cited.value:g} {cited.unit}", row.words
