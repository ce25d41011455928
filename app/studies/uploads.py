"""Read the rows of a study from a CSV file or the first sheet of an XLSX file, in a calculation process.

A cell that is not a number, or contains a formula, is refused with its row and column.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from app.calculations.table_files import sheet_text
from app.calculations.tables import read_table
from app.designs.variant_sheets.grid import MOST_FAULTS
from app.plain import Raw
from app.studies.bodies import MOST_ROWS
from app.workers.pieces import Pieces
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, unknown_name
from templates.core.units.units import require_same_kind

FileKind = Literal["csv", "xlsx"]
Places = Mapping[str, str | None]
"""Every place of a design that rows may set, with its declared unit, or None."""

MOST_CHARACTERS = 16_000_000
MOST_UNPACKED = 200_000_000
"""Largest size of an XLSX file [bytes]."""


def read_rows(content: Pieces, kind: FileKind, places: Places) -> Mapping[str, Raw]:
    """Return the columns of a file by name, each with its numbers and its unit.

    Raises
    ------
    InvalidInputs
        If cells or headings are faulty; the error lists up to `MOST_FAULTS` of them.
    """
    body = content.joined()
    is_sheet = kind == "xlsx"
    text = sheet_text(body, MOST_UNPACKED, MOST_ROWS["table"]) if is_sheet else _of_csv(body)
    columns = read_table(
        text,
        most_rows=MOST_ROWS["table"],
        most_characters=MOST_CHARACTERS,
        most_faults=MOST_FAULTS,
        heading=_Headings(places).fault,
    )
    return {
        column.name: {"value": list(column.values), **({"unit": column.unit} if column.unit else {})}
        for column in columns
    }


class _Headings:
    """The headings of a file, checked one after the other against the places of a design."""

    def __init__(self, places: Places) -> None:
        self._places, self._seen = places, set[str]()

    def fault(self, name: str, given: str) -> Fault | None:
        """Return the fault in the name or the unit of a column, if any; the unit is empty if it has none."""
        if name in self._seen:
            return Fault(name, "twice", f"{excerpt(name)} names two columns; keep one of them")
        self._seen.add(name)
        if name not in self._places:
            return unknown_name(name, list(self._places), "parameter or input")
        if (declared := self._places[name]) is None:
            return None  # a parameter that a relation sets, or a choice; both are checked later
        if not given and declared != "1":
            detail = f"the column has no unit; write one of the kind of {declared} below the heading"
            return Fault(name, "missing_unit", detail)
        try:
            require_same_kind(given or "1", declared)
        except FaultyText as error:
            return error.fault(name)
        return None


def _of_csv(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise _wrong("not_utf8", "save the file as CSV in UTF-8") from None


def _wrong(code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault("file", code, detail)])
