"""Write inputs and outputs of a revision as a table: CSV with a row for each value, or XLSX.

XLSX has a sheet of single values and one for the curves of each block. Numbers are stored as numbers, and
units have their own column. A text that a spreadsheet would read as a formula is stored as a text: in XLSX
by its type, in CSV by a leading apostrophe.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import chain, count, zip_longest
from typing import TYPE_CHECKING, cast

from app.calculations.schemas.evaluations import Output, UsedInput
from app.designs.schemas.designs import RevisionModel, RevisionStep, RevisionWorksheet
from app.plain import Raw
from app.presentation.input_text import text_of
from app.presentation.numbers import rounded
from app.presentation.spreadsheets import Value, harmless, put, without_illegal
from app.schemas.answers import Shown
from app.solids.schemas.analyses import AnalysisOutput
from templates.core.errors import FaultyText
from templates.core.units.quantity import read_any
from templates.core.units.relation import is_relation

if TYPE_CHECKING:
    from openpyxl.worksheet.worksheet import Worksheet  # type: ignore[import-untyped]

HEAD = ("block", "kind", "name", "index", "value", "unit", "origin", "remark")
WIDTHS = (16, 12, 34, 8, 18, 14, 34, 40)
_NO_SHEET_NAME = re.compile(r"[\[\]:*?/\\']")
_LONGEST_SHEET_NAME = 31

Column = tuple[str, str, list[Value]]  # name, unit, values


@dataclass(frozen=True)
class Row:
    """One quantity: a single value, a text, or an array with its indices."""

    block: str
    kind: str  # parameter, input, output, dimension, analysis
    name: str
    value: object
    unit: str
    origin: str
    remark: object  # a reason, or reasons alongside an array


@dataclass(frozen=True)
class Table:
    """All quantities of a revision."""

    title: str
    revision: int
    created: str
    rows: Sequence[Row]


def of(worksheet: RevisionWorksheet) -> Table:
    """Return all quantities of a revision."""
    return Table(worksheet.name, worksheet.number, worksheet.created, [*_rows(worksheet)])


def _rows(worksheet: RevisionWorksheet) -> Iterator[Row]:
    remarks = {value.name: rounded(value) for value in worksheet.rounded}
    for row in _quantities(worksheet):
        name = row.name if row.block == "design" else f"{row.block}.{row.name}"
        is_set = row.kind in ("parameter", "input", "dimension")
        yield replace(row, remark=remarks[name]) if is_set and name in remarks else row


def _quantities(worksheet: RevisionWorksheet) -> Iterator[Row]:
    for name, raw in worksheet.parameters.items():
        yield Row("design", "parameter", name, *_read(raw), "given", "")
    for block, step in worksheet.steps.items():
        yield from _of_step(block, step)
    for line in worksheet.worksheet.lines if worksheet.worksheet else ():
        if line.value is not None:
            yield _quantity("worksheet", "output", line.name.partition(".")[2], line.value, "")
    for block, model in worksheet.models.items():
        yield from _of_model(block, model)


def _of_step(block: str, step: RevisionStep) -> Iterator[Row]:
    for name, used in step.inputs.items():
        if isinstance(used, UsedInput):
            origin = text_of(step.relations[name]) if name in step.relations else used.source
            yield _quantity(block, "input", name, used, origin)
        else:  # as typed, for a step that waits for a solid
            yield Row(block, "input", name, *_read(used), "given", "")
    for name, output in step.outputs.items():
        yield _quantity(block, "output", name, output, "")


def _of_model(block: str, model: RevisionModel) -> Iterator[Row]:
    for name, parameter in model.parameters.items():
        yield _quantity(block, "dimension", name, parameter, text_of(model.relations.get(name)))
    for kind, analysis in model.analyses.items():
        for name, output in analysis.outputs.items():
            yield _quantity(block, "analysis", f"{kind}.{name}", output, "finite elements")


def _read(raw: Raw) -> tuple[object, str]:
    """Return a parameter as its user typed it.

    The result is its number and unit, or its text if it is a relation or a list with a relation.
    """
    try:
        typed = read_any(raw) if not is_relation(raw) else None
    except FaultyText:
        typed = None
    return (typed.value, typed.unit) if typed else (text_of(raw), "")


def _quantity(
    block: str, kind: str, name: str, quantity: UsedInput | Output | Shown | AnalysisOutput, origin: str
) -> Row:
    reasons = getattr(quantity, "reasons", None) or getattr(quantity, "reason", None) or ""
    return Row(block, kind, name, quantity.value, quantity.unit or "", origin, reasons)


def write_csv(table: Table) -> bytes:
    """Return CSV with a row for each single value; each value of an array has its own row with its index."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(HEAD)
    for row in table.rows:
        for index, value, remark in _each(row.value, row.remark):
            cells = (row.block, row.kind, row.name, index, value, row.unit, row.origin, remark)
            writer.writerow([harmless(cell) for cell in cells])
    return stream.getvalue().encode()


def _each(value: object, remark: object, index: str = "") -> Iterator[tuple[str, Value, str]]:
    """Yield every value of an array with its index, counted from 1: `3` or `3 1`."""
    if not isinstance(value, list):
        yield index, cast(Value, value), "" if remark is None else str(remark)
        return
    remarks = remark if isinstance(remark, list) else [remark] * len(value)
    for i, (item, why) in enumerate(zip_longest(value, remarks), 1):
        yield from _each(item, why, f"{index} {i}".strip())


def write_xlsx(table: Table) -> bytes:
    """Return XLSX: a sheet of all single values, and a sheet for each block with arrays."""
    from openpyxl import Workbook  # type: ignore[import-untyped]
    from openpyxl.worksheet.worksheet import Worksheet

    book = Workbook()
    created = datetime.fromisoformat(table.created).replace(tzinfo=None)
    book.properties.title, book.properties.creator = without_illegal(table.title), "Crankwright"
    book.properties.created = book.properties.modified = created
    values = book.active
    assert isinstance(values, Worksheet), "a new workbook has a sheet"
    values.title = "Values"
    _fill(values, [HEAD, *(_single(row) for row in table.rows)])
    for letter, width in zip("ABCDEFGH", WIDTHS, strict=True):
        values.column_dimensions[letter].width = width
    values.freeze_panes = "A2"
    for block in dict.fromkeys(row.block for row in table.rows if isinstance(row.value, list)):
        arrays = [row for row in table.rows if row.block == block and isinstance(row.value, list)]
        _curves(book.create_sheet(_sheet_name(block, book.sheetnames)), arrays)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _single(row: Row) -> tuple[Value, ...]:
    """Return a row of the sheet of single values.

    For an array it has only the number of values, which are in the sheet of its block.
    """
    if isinstance(row.value, list):
        remark = f"{len(row.value)} values, in the sheet of {row.block}"
        return row.block, row.kind, row.name, None, None, row.unit, row.origin, remark
    return (
        row.block,
        row.kind,
        row.name,
        None,
        cast(Value, row.value),
        row.unit,
        row.origin,
        str(row.remark or ""),
    )


def _curves(sheet: Worksheet, arrays: Sequence[Row]) -> None:
    """Write arrays side by side: name, unit, values; several axes give a column for each index."""
    columns: list[Column] = []
    for row in arrays:
        assert isinstance(row.value, list), "an array"
        columns += _columns(row.name, row.unit, row.value)
    lines = list(zip_longest(*(values for _, _, values in columns)))
    head = [["name", *(name for name, _, _ in columns)], ["unit", *(unit for _, unit, _ in columns)]]
    _fill(sheet, [*head, *([i, *line] for i, line in enumerate(lines, 1))])
    sheet.freeze_panes = "B3"


def _columns(name: str, unit: str, value: list[object]) -> Iterator[Column]:
    if not any(isinstance(item, list) for item in value):
        yield name, unit, cast(list[Value], value)
        return
    width = max(len(item) for item in value if isinstance(item, list))
    for place in range(width):
        column = [item[place] if isinstance(item, list) and place < len(item) else None for item in value]
        yield from _columns(f"{name} {place + 1}", unit, column)


def _fill(sheet: Worksheet, lines: Sequence[Sequence[Value]]) -> None:
    from openpyxl.styles import Font  # type: ignore[import-untyped]

    for number, line in enumerate(lines, 1):
        for place, value in enumerate(line, 1):
            if value is not None and value != "":
                put(sheet.cell(number, place), value)
    for cell in sheet[1]:
        cell.font = Font(bold=True)


def _sheet_name(block: str, taken: Sequence[str]) -> str:
    """Return a valid sheet name that differs from all others, regardless of case."""
    there = {name.lower() for name in taken}
    plain = _NO_SHEET_NAME.sub("", block)[: _LONGEST_SHEET_NAME - 4]
    numbered = chain([plain], (f"{plain} {i}" for i in count(2)))
    return next(name for name in numbered if name.lower() not in there)
