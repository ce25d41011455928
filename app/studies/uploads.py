"""Read the rows of a study from a CSV file or the first sheet of an XLSX file, in a calculation process.

A cell that is not a number, or that holds a formula, is refused with its row and column.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Literal

from app.calculations.tables import read_table
from app.designs.variant_sheets.grid import MOST_FAULTS
from app.plain import Raw
from app.studies.bodies import MOST_ROWS
from app.workers.pieces import Pieces
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, unknown_name
from templates.core.units.units import require_same_kind

FileKind = Literal["csv", "xlsx"]
Places = Mapping[str, str | None]
"""Every place of a design that rows may set, with its declared unit; None where it has none of its own."""

MOST_CHARACTERS = 16_000_000
MOST_UNPACKED, MOST_PARTS = 200_000_000, 500
"""Of an XLSX file: bytes, and files within it."""
MOST_COLUMNS = 40
DAMAGED = "this file cannot be read as XLSX; save it again in a spreadsheet, or send CSV"


def read_rows(content: Pieces, kind: FileKind, places: Places) -> Mapping[str, Raw]:
    """Return the columns of a file by name, each with its numbers and its unit.

    Raises
    ------
    InvalidInputs
        Naming every cell that is wrong, headings included, up to `MOST_FAULTS`.
    """
    text = _of_xlsx(content.joined()) if kind == "xlsx" else _of_csv(content.joined())
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
    """The headings of a file, judged one after the other against the places of a design."""

    def __init__(self, places: Places) -> None:
        self._places, self._seen = places, set[str]()

    def fault(self, name: str, given: str) -> Fault | None:
        """Return the fault of a column: of its name, or of its unit, which is empty where it has none."""
        if name in self._seen:
            return Fault(name, "twice", f"{excerpt(name)} names two columns; keep one of them")
        self._seen.add(name)
        if name not in self._places:
            return unknown_name(name, list(self._places), "parameter or input")
        if (declared := self._places[name]) is None:
            return None  # a parameter that a relation sets, or a choice: the study says what it takes
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


def _of_xlsx(content: bytes) -> str:
    """Return the first visible sheet as text, a row a line, its cells separated by tabs."""
    from openpyxl import load_workbook  # type: ignore[import-untyped]

    _check_size(content)
    try:
        book = load_workbook(io.BytesIO(content), read_only=True, keep_links=False)
        sheet = next((s for s in book.worksheets if s.sheet_state == "visible"), None)
        if sheet is None:
            raise _wrong("no_sheet", "the file has no visible sheet")
        sheet.reset_dimensions()  # what the file says of its own size may be wrong
        rows = sheet.iter_rows(values_only=True, max_col=MOST_COLUMNS)
        return "\n".join(_lines(islice(rows, MOST_ROWS["table"] + 4)))
    except InvalidInputs:
        raise
    except Exception:  # openpyxl raises whatever a damaged file makes of it
        raise _wrong("damaged", DAMAGED) from None


def _lines(rows: Iterator[tuple[object, ...]]) -> Iterator[str]:
    for row in rows:
        yield "\t".join("" if value is None else " ".join(str(value).split()) for value in row)


def _check_size(content: bytes) -> None:
    """Refuse what would unpack to more than any table; `zipfile` unpacks no more than the archive says."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = archive.infolist()
    except (zipfile.BadZipFile, ValueError, NotImplementedError, EOFError):
        raise _wrong("damaged", DAMAGED) from None
    if len(parts) > MOST_PARTS or sum(part.file_size for part in parts) > MOST_UNPACKED:
        raise _wrong("too_large", "the unpacked file is too large; keep only the sheet with the rows")


def _wrong(code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault("file", code, detail)])
