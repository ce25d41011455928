"""Escape texts for spreadsheets, so that none is read as a formula.

openpyxl has 180 modules, so it is imported only where an XLSX file is read or written.
"""

from __future__ import annotations

import re

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
"""The media type of a sheet."""
DANGEROUS = ("=", "+", "-", "@", "\t", "\r")
LONGEST_CELL = 32_000
_ILLEGAL = re.compile(r"[\000-\010]|[\013-\014]|[\016-\037]")  # openpyxl's ILLEGAL_CHARACTERS_RE

Value = float | int | str | None


def harmless(value: Value) -> Value:
    """Return a value for a cell of a CSV file; a text that looks like a formula gets a leading apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(DANGEROUS) else value


def put(cell: object, value: Value) -> None:
    """Write a value into a cell of an XLSX file, numbers as numbers and texts as texts."""
    from openpyxl.cell.cell import Cell  # type: ignore[import-untyped]

    assert isinstance(cell, Cell), "no cells are merged"
    if not isinstance(value, str):
        cell.value = value
        return
    cell.value = without_illegal(value)
    cell.data_type = "s"  # stored as text, even if it begins with =
    if value.startswith(DANGEROUS):
        cell.quotePrefix = True


def without_illegal(text: str) -> str:
    """Return a text without the control characters that XLSX cannot hold, at most `LONGEST_CELL` long."""
    return str(_ILLEGAL.sub("", text))[:LONGEST_CELL]
