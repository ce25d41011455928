"""CSV files: UTF-8 with or without a byte-order mark, columns separated by tabs, semicolons or commas.

The first line that is not blank determines the separator. A decimal comma is accepted unless the separator is
a comma.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence

from app.designs.variant_sheets.grid import LAST_ROW, Grid, grid_of
from app.presentation.spreadsheets import DANGEROUS, Value, harmless
from templates.core.errors import Fault, InvalidInputs

MOST_BYTES = 2_000_000
SEPARATORS = "\t;,"
_DECIMAL_COMMA = re.compile(r"([+-]?[0-9]*),([0-9]+(?:[eE][+-]?[0-9]{1,3})?(?:\s.*)?)")
"""A number, alone or followed by a space and its unit."""
_LINE = re.compile(r"\r\n|\r|\n")


def read_csv(content: bytes) -> Grid:
    """Return the cells of a CSV file. The time is linear in its length, which is at most `MOST_BYTES`.

    Raises
    ------
    InvalidInputs
        If it is too long, not UTF-8, or its quotes cannot be parsed.
    """
    if len(content) > MOST_BYTES:
        raise _wrong("A1", "too_long", f"a CSV file may be at most {MOST_BYTES // 10**6} MB in size")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = content[: error.start].count(b"\n") + 1
        raise _wrong(f"A{row}", "not_utf_8", "this is not UTF-8; save the file as CSV in UTF-8") from None
    separator = _separator(text)
    return grid_of([[_meant(cell, separator) for cell in row] for row in _rows(text, separator)])


def write_csv(rows: Sequence[Sequence[Value]]) -> bytes:
    """Return rows as a CSV file; a text that a spreadsheet would evaluate as a formula gets an apostrophe."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerows([_escaped(cell) for cell in row] for row in rows)
    return stream.getvalue().encode()


def _separator(text: str) -> str:
    start = text[: len(text) - len(text.lstrip("\r\n \ufeff"))]
    first = _LINE.split(text[len(start) : len(start) + 100_000], maxsplit=1)[0]
    return next((sign for sign in SEPARATORS if sign in first), ",")


def _rows(text: str, separator: str) -> list[list[str]]:
    rows: list[list[str]] = []
    try:
        for row in csv.reader(io.StringIO(text, newline=""), delimiter=separator):
            if len(rows) > LAST_ROW and not any(row):
                continue  # blank rows at the end are not variants
            rows.append(row)
            if len(rows) > 2 * LAST_ROW:
                break  # enough rows to refuse the file
    except csv.Error:
        message = "this row cannot be read; close its quotes, and shorten its cells"
        raise _wrong(f"A{len(rows) + 1}", "not_a_row", message) from None
    return rows


def _meant(cell: str, separator: str) -> str:
    """Return a cell with a decimal point, and without the apostrophe that guards against formulas."""
    plain = cell.strip()
    if plain.startswith("'") and plain.lstrip("'").startswith(DANGEROUS):
        return plain[1:]
    if separator != "," and (number := _DECIMAL_COMMA.fullmatch(plain)):
        return f"{number[1]}.{number[2]}"
    return plain


def _escaped(cell: Value) -> Value:
    """Return a text that no spreadsheet evaluates, and that `_meant` converts back."""
    if isinstance(cell, str) and cell.startswith("'") and cell.lstrip("'").startswith(DANGEROUS):
        return f"'{cell}"
    return harmless(cell)


def _wrong(place: str, code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault(place, code, detail)])
