"""XLSX files: the sheet named `variants`, else the first visible sheet.

The file is an untrusted zip archive of XML, so the sizes of its parts are checked before any part is read. A
cell that contains a formula, a date or an error is refused, and the message gives its address.
"""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from datetime import date, time, timedelta
from typing import TYPE_CHECKING, Protocol

from app.designs.variant_sheets.grid import LAST_ROW, Grid, address, grid_of
from app.designs.variant_sheets.values import FORMULA
from app.presentation.spreadsheets import Value, put, without_illegal
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt

if TYPE_CHECKING:
    from openpyxl import Workbook  # type: ignore[import-untyped]
    from openpyxl.worksheet.worksheet import Worksheet  # type: ignore[import-untyped]

SHEET = "variants"
MOST_BYTES, MOST_UNPACKED, MOST_PARTS = 2_000_000, 4_000_000, 500
"""Limits of a file: its size as sent and unpacked [bytes], and the number of files in it."""
LAST_ROW_OF_ALL = 1_048_576
NARROWEST, WIDEST = 9, 40  # widths of columns [characters]
RESULT_FILL, HEAD_ROWS = "E9EDF1", 2
DAMAGED = "this file cannot be read as XLSX; open it in a spreadsheet and save it again, or send CSV"


class _Cell(Protocol):
    """A cell as openpyxl reads it."""

    @property
    def value(self) -> object:
        """Return a number, a text or a date; None if the cell is empty."""

    @property
    def data_type(self) -> str:
        """Return the type of the cell: `f` for a formula, `e` for an error."""


def read_xlsx(content: bytes) -> Grid:
    """Return the cells of an XLSX file.

    Raises
    ------
    InvalidInputs
        If the file is too large, damaged, or has no visible sheet.
    """
    from openpyxl import load_workbook

    _check_size(content)
    try:
        book = load_workbook(io.BytesIO(content), read_only=True, keep_links=False)
        rows, faults = _cells(_sheet(book))
    except InvalidInputs:
        raise
    except Exception:  # a damaged file can make openpyxl raise any exception
        raise _wrong("damaged", DAMAGED) from None
    return grid_of(rows, faults)


def _check_size(content: bytes) -> None:
    """Raise InvalidInputs if the unpacked size exceeds that of any table of variants.

    `zipfile` never unpacks more of a part than the archive states, so the stated sizes can be added up.
    """
    if len(content) > MOST_BYTES:
        raise _wrong("too_long", f"an XLSX file may be at most {MOST_BYTES // 10**6} MB in size")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = archive.infolist()
    except (zipfile.BadZipFile, ValueError, NotImplementedError, EOFError):
        raise _wrong("damaged", DAMAGED) from None
    if len(parts) > MOST_PARTS or sum(part.file_size for part in parts) > MOST_UNPACKED:
        message = f"the file unpacks to more than {MOST_UNPACKED // 10**6} MB or {MOST_PARTS} parts"
        raise _wrong("too_large", f"{message}; keep only one sheet")


def _sheet(book: Workbook) -> Worksheet:
    """Return the sheet to read; hidden sheets are skipped."""
    visible = [sheet for sheet in book.worksheets if sheet.sheet_state == "visible"]
    if not visible:
        raise _wrong("no_sheet", "the file has no visible sheet with cells")
    named = (sheet for sheet in visible if sheet.title.strip().lower() == SHEET)
    return next(named, visible[0])


def _cells(sheet: Worksheet) -> tuple[list[list[str]], list[Fault]]:
    """Return the texts of all cells, and the faults of those without a value."""
    sheet.reset_dimensions()  # the dimensions stated in the file may be wrong
    rows: list[list[str]] = []
    faults: list[Fault] = []
    for number, row in enumerate(_first(sheet.iter_rows(max_row=LAST_ROW_OF_ALL))):
        texts = []
        for column, cell in enumerate(row):
            try:
                texts.append(_text(cell.value, cell.data_type) if cell.value is not None else "")
            except FaultyText as error:
                faults.append(error.fault(address(number, column)))
                texts.append(str(cell.value)[:60])
        rows.append(texts)
    return rows, faults


def _first(rows: Iterable[Sequence[_Cell]]) -> Iterator[Sequence[_Cell]]:
    """Yield the allowed rows, then the first row below them with a value, which is refused later."""
    for number, row in enumerate(rows):
        if number < LAST_ROW:
            yield row
        elif any(cell.value is not None for cell in row):
            yield row
            return


def _text(value: object, kind: str) -> str:
    """Return the value of a cell as text.

    Raises
    ------
    FaultyText
        If it is a formula, an error, a date or a truth value.
    """
    if kind == "f":
        raise FaultyText("formula", FORMULA)
    if kind == "e":
        raise FaultyText("error_value", f"{excerpt(str(value))} is an error of the spreadsheet")
    if isinstance(value, (date, time, timedelta)):
        message = (
            "the spreadsheet has converted this cell to a date; format it as a number, and type it again"
        )
        raise FaultyText("date", message)
    if isinstance(value, bool):
        raise FaultyText("not_a_number", f"{str(value).upper()} is not a quantity; write a number")
    return number_text(value) if isinstance(value, (int, float)) else str(value)


def number_text(number: float) -> str:
    """Return a number with all its digits in the shortest form: `60`, `0.05`."""
    if isinstance(number, float) and not math.isfinite(number):
        raise FaultyText("not_finite", "the value must be finite")
    whole = isinstance(number, int) or (number.is_integer() and abs(number) < 1e15)
    return str(int(number)) if whole else repr(number)


def write_xlsx(rows: Sequence[Sequence[Value]], results: Sequence[bool], title: str) -> bytes:
    """Return rows as an XLSX file with frozen headings; `results` marks the columns of results."""
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

    book = Workbook()
    book.properties.title, book.properties.creator = without_illegal(title), "Crankwright"
    sheet = book.active
    assert isinstance(sheet, Worksheet), "a new workbook has a sheet"
    sheet.title = SHEET
    for number, row in enumerate(rows, 1):
        for place, value in enumerate(row, 1):
            if value is not None and value != "":
                put(sheet.cell(number, place), value)
    for place, is_result in enumerate(results, 1):
        _style(sheet, place, [row[place - 1] for row in rows], is_result=is_result)
    sheet.freeze_panes = "B3"
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _style(sheet: Worksheet, place: int, cells: Sequence[Value], *, is_result: bool) -> None:
    """Set the width, heading and background of a column."""
    from openpyxl.styles import Alignment, Font, PatternFill  # type: ignore[import-untyped]
    from openpyxl.utils import get_column_letter  # type: ignore[import-untyped]

    longest = max((len(str(cell)) for cell in cells if cell is not None), default=0)
    sheet.column_dimensions[get_column_letter(place)].width = min(max(longest + 2, NARROWEST), WIDEST)
    for row in range(1, len(cells) + 1):
        cell = sheet.cell(row, place)
        if row <= HEAD_ROWS:
            cell.font = Font(bold=row == 1, italic=row > 1)
            cell.alignment = Alignment(horizontal="left")
        if is_result:
            cell.fill = PatternFill("solid", fgColor=RESULT_FILL)


def _wrong(code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault("file", code, detail)])
