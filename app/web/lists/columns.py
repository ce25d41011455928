"""Map columns of a pasted table to form fields: matched by name, shifted by an angle, cut to one cycle.

The dialog of a page sends a pasted table to `/tables` and shows the result; nothing is stored.
"""

from __future__ import annotations

import base64
import binascii
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import isfinite

from fastapi import APIRouter
from starlette.concurrency import run_in_threadpool

from app.calculations.curves import MOST_BYTES, MOST_ROWS, file_of
from app.calculations.indicator import as_cycle
from app.calculations.table_files import FileText
from app.calculations.tables import TableColumn, table_of
from app.http.access import needs
from app.http.strict_requests import StrictRoute
from app.reference import Reference
from app.schemas.tables import ChosenColumn, PastedTable, ReadColumn, ReadTable, TableField
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt
from templates.core.language.meaning import api_name
from templates.core.units.quantity import read
from templates.core.units.units import compatible, require_same_kind, unit

router = APIRouter(include_in_schema=False, route_class=StrictRoute)

SHOWN = 5  # rows
CYCLES = (360.0, 720.0)  # deg
SAME_ANGLE, SAME_VALUE = 1e-6, 0.01
"""Largest difference of the last angle from a whole cycle [deg], and of the last value from the first [-]."""
DIGITS = 12  # digits of a shifted angle, so that 0.1 + 0.2 is 0.3


def paste(pasted: PastedTable) -> ReadTable:
    """Return the texts for the fields of a form, read from a table.

    Columns that the user has not assigned are matched by their names.

    Raises
    ------
    InvalidInputs
        If the text is not a table.
    """
    file = _sent(pasted)
    table = as_cycle(
        table_of(file.text, most_rows=MOST_ROWS, most_characters=MOST_BYTES, is_sheet=file.is_sheet)
    )
    columns, assumed = table.columns, [*file.assumed, *table.assumed]
    chosen = _chosen(columns, pasted)
    shown = [
        ReadColumn(name=c.name, unit=o.unit, field=o.field) for c, o in zip(columns, chosen, strict=True)
    ]
    typed = [replace(c, unit=o.unit.strip()) for c, o in zip(columns, chosen, strict=True)]
    faults = [*_faults(typed, chosen, pasted.fields)]
    notes: list[str] = []
    if not faults:
        try:
            typed, notes = _adjusted(typed, chosen, pasted)
        except FaultyText as error:
            faults.append(str(error))
    return ReadTable(
        columns=shown,
        first=[list(row) for row in zip(*(c.values[:SHOWN] for c in typed), strict=True)],
        rows=len(typed[0].values),
        notes=notes,
        assumed=assumed,
        faults=faults,
        texts={} if faults else {o.field: text_of(c) for c, o in zip(typed, chosen, strict=True) if o.field},
    )


def _sent(pasted: PastedTable) -> FileText:
    """Return the text of the chosen file, or else the pasted text.

    Raises
    ------
    InvalidInputs
        If the file is too large, damaged, or of another kind.
    """
    if not pasted.file:
        return FileText(pasted.text)
    try:
        return file_of(base64.b64decode(pasted.file, validate=True))
    except (binascii.Error, ValueError):
        raise InvalidInputs([Fault("file", "not_base64", "send the bytes of the file in base64")]) from None


def text_of(column: TableColumn) -> str:
    """Return a column as the text of a field: `[0, 15, 30] deg`."""
    numbers = json.dumps([int(v) if v.is_integer() and abs(v) < 1e15 else v for v in column.values])
    return numbers if column.unit == "1" else f"{numbers} {column.unit}"


def _chosen(columns: Sequence[TableColumn], pasted: PastedTable) -> list[ChosenColumn]:
    """Return the user's choice of columns.

    If there is no choice, or it belongs to another table, return the proposal by names.
    """
    if pasted.columns is not None and len(pasted.columns) == len(columns):
        return pasted.columns
    fields = _proposed(columns, pasted.fields)
    pure = {field.name for field in pasted.fields if field.unit == "1"}
    return [
        ChosenColumn(field=field, unit=column.unit or ("1" if field in pure else ""))
        for column, field in zip(columns, fields, strict=True)
    ]


def _proposed(columns: Sequence[TableColumn], fields: Sequence[TableField]) -> list[str]:
    """Return the best matching field for each column, each field only once; none if no name fits."""
    scores = [
        (_likeness(column, field), -place, field.name)
        for place, column in enumerate(columns)
        for field in fields
    ]
    taken: dict[int, str] = {}
    for score, place, name in sorted(scores, reverse=True):
        if score > 0 and -place not in taken and name not in taken.values():
            taken[-place] = name
    taken |= _alone(columns, fields, taken)
    return [taken.get(place, "") for place in range(len(columns))]


def _alone(
    columns: Sequence[TableColumn], fields: Sequence[TableField], taken: Mapping[int, str]
) -> dict[int, str]:
    """Return the assignments that are unique by kind: the only column of a kind gets the only free field."""
    free = [field for field in fields if field.name not in taken.values()]
    left = [n for n, column in enumerate(columns) if n not in taken and column.unit not in ("", "1")]
    fits = {n: [f.name for f in free if compatible(unit(columns[n].unit), unit(f.unit))] for n in left}
    single = {n: names[0] for n, names in fits.items() if len(names) == 1}
    return {n: name for n, name in single.items() if list(single.values()).count(name) == 1}


def _likeness(column: TableColumn, field: TableField) -> float:
    """Return the similarity from 0 (nothing in common, or another kind of quantity) to 1 (the same name)."""
    if column.unit and not compatible(unit(column.unit), unit(field.unit)):
        return 0.0
    own, name = _words(column.name), Reference.parse(field.name).own_name
    if api_name(column.name) == name or _plain(column.name) == _plain(re.sub(r"\\[a-z]+", "", field.symbol)):
        return 1.0
    others = _words(name) | _words(field.words)
    return len(own & others) / len(own | others) if own else 0.0


def _words(text: str) -> set[str]:
    return set(api_name(text.rpartition(".")[2]).split("_")) - {""}


def _plain(text: str) -> str:
    """Return only the letters and digits of a name: `F_{x}` and `Fx` become equal.

    A text without letters and digits matches nothing.
    """
    return re.sub(r"[^a-z0-9]", "", text.lower()) or text


def _faults(
    columns: Sequence[TableColumn], chosen: Sequence[ChosenColumn], fields: Sequence[TableField]
) -> Iterator[str]:
    """Yield the faults of the choice: a unit that does not fit, or a field assigned to two columns."""
    by_name = {field.name: field for field in fields}
    taken = [choice.field for choice in chosen if choice.field]
    if not taken:
        yield "choose a field for at least one column"
    for name in sorted({name for name in taken if taken.count(name) > 1}):
        yield f"two columns are assigned to {_said(name)}; choose one of them"
    for column, choice in zip(columns, chosen, strict=True):
        if choice.field and choice.field not in by_name:
            yield f"column {column.name}: this form has no field {_said(choice.field)}"
        elif choice.field:
            yield from _unit_fault(column, by_name[choice.field])


def _unit_fault(column: TableColumn, field: TableField) -> Iterator[str]:
    if not column.unit:
        yield f"column {column.name} has no unit; give one, such as {field.unit}"
        return
    try:
        require_same_kind(column.unit, field.unit)
    except FaultyText as error:
        yield f"column {column.name}: {error}"


def _said(name: str) -> str:
    return excerpt(Reference.parse(name).own_name.replace("_", " "))


def _adjusted(
    columns: list[TableColumn], chosen: Sequence[ChosenColumn], pasted: PastedTable
) -> tuple[list[TableColumn], list[str]]:
    """Return the columns with the offset added to angles, without a last point that repeats the first."""
    fields: Mapping[str, TableField] = {field.name: field for field in pasted.fields}
    taken = [c for o, c in zip(chosen, columns, strict=True) if o.field]
    place = next((n for n, o in enumerate(chosen) if o.field and _is_angle(fields[o.field])), None)
    if place is None:
        if pasted.offset.strip():
            raise FaultyText("no_angle", "no column holds crank angles for the angle offset")
        return columns, []
    note, is_repeated = _cycle(columns[place], taken)
    if is_repeated:
        columns = [replace(c, values=c.values[:-1]) for c in columns]
    columns[place] = _shifted(columns[place], pasted.offset.strip())
    return columns, note


def _is_angle(field: TableField) -> bool:
    """Return whether a field is an angle, such as the crank angle."""
    return unit(field.unit).base == unit("deg").base and "angle" in _words(field.name)


def _cycle(axis: TableColumn, taken: Sequence[TableColumn]) -> tuple[list[str], bool]:
    """Return a remark about the last point, and whether it repeats the first one."""
    degrees = unit(axis.unit).factor / unit("deg").factor
    span = abs(axis.values[-1] - axis.values[0]) * degrees
    cycle = next((c for c in CYCLES if abs(span - c) <= SAME_ANGLE), None)
    if cycle is None or len(axis.values) < 3:
        return [], False
    apart = [c.name for c in taken if c is not axis and _jump(c.values) > SAME_VALUE]
    ends = f"The first and the last point lie {cycle:g}° apart"
    if apart:
        return [f"{ends}, but differ in {', '.join(apart)}; both were kept."], False
    return [f"{ends}, one full cycle: the last point repeats the first and was left out."], True


def _jump(values: Sequence[float]) -> float:
    """Return the difference between the last value and the first, relative to the largest."""
    largest = max(map(abs, values))
    return abs(values[-1] - values[0]) / largest if largest else 0.0


def _shifted(axis: TableColumn, offset: str) -> TableColumn:
    """Return the angles with an offset such as `10 deg` added.

    Raises
    ------
    FaultyText
        If it is not an angle with its unit.
    """
    if not offset:
        return axis
    try:
        added = float(read(offset, axis.unit).si) / unit(axis.unit).factor
    except FaultyText as error:
        raise FaultyText(error.code, f"angle offset: {error}") from None
    values = tuple(float(f"{value + added:.{DIGITS}g}") for value in axis.values)
    if not all(map(isfinite, values)):
        raise FaultyText("not_finite", "angle offset: the angles become too large")
    return replace(axis, values=values)


def refused(error: InvalidInputs) -> ReadTable:
    """Return the faults of a text that is not a table, as a page shows them."""
    faults = [f"{fault.name}: {fault.detail}" for fault in error.faults]
    return ReadTable(columns=[], first=[], rows=0, faults=faults)


@router.post("/tables", dependencies=[needs("viewer")])
async def read_pasted_table(pasted: PastedTable) -> ReadTable:
    """Return the columns of a pasted table, and the texts for the fields.

    A text that is not a table raises no error, because the page shows its faults while the user types.
    """
    return await run_in_threadpool(_read, pasted)


def _read(pasted: PastedTable) -> ReadTable:
    try:
        return paste(pasted)
    except InvalidInputs as error:
        return refused(error)
