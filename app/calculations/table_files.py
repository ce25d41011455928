"""Read the text of a table file: CSV in any common encoding, or one sheet of XLSX.

The assumptions made about a file are returned with its text. An XLSX file is an untrusted zip archive of XML,
so the sizes of its parts are checked before any part is read.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from templates.core.errors import Fault, InvalidInputs

ZIP, OLD_EXCEL = b"PK\x03\x04", b"\xd0\xcf\x11\xe0"
MOST_PARTS, MOST_COLUMNS = 500, 40
DAMAGED = "this file cannot be read as XLSX; save it again in a spreadsheet, or send CSV"
_SAMPLE = 4096
"""Number of bytes examined to recognise UTF-16 without a byte order mark."""


@dataclass(frozen=True)
class FileText:
    """The text of a table file, and the assumed encoding; `is_sheet` is true if XLSX stored the numbers."""

    text: str
    assumed: tuple[str, ...] = ()
    is_sheet: bool = False


def file_text(content: bytes, most_bytes: int, most_unpacked: int, most_rows: int) -> FileText:
    """Return the text of a CSV file, or of the first visible sheet of an XLSX file.

    Raises
    ------
    InvalidInputs
        If it is too large, damaged, or of another kind.
    """
    if len(content) > most_bytes:
        raise _wrong("too_long", f"a table may be at most {most_bytes / 1e6:g} MB in size; send fewer rows")
    if content.startswith(ZIP):
        return FileText(sheet_text(content, most_unpacked, most_rows), is_sheet=True)
    if content.startswith(OLD_EXCEL):
        raise _wrong("old_excel", "this is an old Excel file (.xls); save it as .xlsx or as CSV")
    return _decoded(content)


def _decoded(content: bytes) -> FileText:
    """Return the text, decoded as UTF-8, as UTF-16, or otherwise as Windows-1252."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return FileText(content.decode("utf-16", errors="replace"), ("UTF-16",))
    sample = content[:_SAMPLE]
    for encoding, zeros in (("utf-16-le", sample[1::2]), ("utf-16-be", sample[::2])):
        if len(sample) > 3 and zeros.count(0) > 0.7 * len(zeros):
            return FileText(content.decode(encoding, errors="replace"), ("UTF-16",))
    try:
        return FileText(content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        pass
    try:
        return FileText(content.decode("cp1252"), ("Latin-1",))
    except UnicodeDecodeError:
        return FileText(content.decode("latin-1"), ("Latin-1",))


def sheet_text(content: bytes, most_unpacked: int, most_rows: int) -> str:
    """Return the first visible sheet of an XLSX file, one line per row, cells separated by tabs.

    Raises
    ------
    InvalidInputs
        If it is too large or damaged, or has no visible sheet.
    """
    from openpyxl import load_workbook  # type: ignore[import-untyped]

    _check_size(content, most_unpacked)
    try:
        book = load_workbook(io.BytesIO(content), read_only=True, keep_links=False)
        sheet = next((s for s in book.worksheets if s.sheet_state == "visible"), None)
        if sheet is None:
            raise _wrong("no_sheet", "the file has no visible sheet")
        sheet.reset_dimensions()  # the size that the file states may be wrong
        rows = sheet.iter_rows(values_only=True, max_col=MOST_COLUMNS)
        return "\n".join(_lines(islice(rows, most_rows + 4)))
    except InvalidInputs:
        raise
    except Exception:  # openpyxl raises errors of any type for a damaged file
        raise _wrong("damaged", DAMAGED) from None


def _lines(rows: Iterator[tuple[object, ...]]) -> Iterator[str]:
    for row in rows:
        yield "\t".join("" if value is None else " ".join(str(value).split()) for value in row)


def _check_size(content: bytes, most_unpacked: int) -> None:
    """Refuse an archive that would unpack to more than any table needs; `zipfile` trusts the stated sizes."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = archive.infolist()
    except (zipfile.BadZipFile, ValueError, NotImplementedError, EOFError):
        raise _wrong("damaged", DAMAGED) from None
    if len(parts) > MOST_PARTS or sum(part.file_size for part in parts) > most_unpacked:
        raise _wrong("too_large", "the unpacked file is too large; keep only the sheet with the rows")


def _wrong(code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault("file", code, detail)])
