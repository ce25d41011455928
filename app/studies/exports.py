"""The rows of a study as files: CSV row by row, XLSX for fewer rows, and an archive of all columns."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from typing import IO

import numpy as np

from app.presentation import numbers
from app.presentation.spreadsheets import Value, harmless
from app.presentation.units import System, shown_unit, shown_value
from app.studies.archive import AnyArray, write_each
from app.studies.schemas import StudyRow
from app.studies.views import RowList
from templates.core.criteria.comparison import MET_ERROR_UNKNOWN, VERDICTS
from templates.core.errors import Fault, InvalidInputs

MOST_XLSX = 20_000  # largest number of rows in a sheet; spreadsheet programs become slow far below a million
SOME, SOME_SORTED = (
    2000,
    20_000,
)  # rows that are read and written at once; more if sorted, because these come from all chunks


def heads(listing: RowList, system: System) -> list[list[str]]:
    """Return the two heading rows: words with units as on the page, then names for programs."""
    criteria, tail = listing.plan.criteria, ["verdict", "error unknown", "level", "reason"]
    words = [_heading(listing, name, shown_unit(unit, system)) for name, unit in listing.units.items()]
    judged = [_heading(listing, name, "") for name in criteria]
    return [
        ["Row", *words, *judged, *(text.capitalize() for text in tail)],
        ["row", *listing.names, *criteria, *tail],
    ]


def _heading(listing: RowList, name: str, shown: str) -> str:
    unit = numbers.unit(shown)
    words = listing.plan.words.get(name, name)
    head = words[:1].upper() + words[1:]
    return f"{head} [{unit}]" if unit else head


def lines(listing: RowList, system: System) -> Iterator[list[Value]]:
    """Yield one line of cells for each row, in the order of `heads`."""
    selected = listing.numbers()
    size = SOME if listing.wanted.sort is None else SOME_SORTED
    for start in range(0, len(selected), size):
        for row in listing.rows(selected[start : start + size]):
            yield _line(listing, row, system)


def _line(listing: RowList, row: StudyRow, system: System) -> list[Value]:
    units = listing.units
    values = [_cell(shown_value(value, units[name], system)) for name, value in row.values.items()]
    verdicts = [row.verdicts.get(name, "") for name in listing.plan.criteria]
    levels = " ".join(f"{step}:{level}" for step, level in row.level.items())
    unknown = " ".join(row.error_unknown)
    return [row.row, *values, *verdicts, row.verdict or "", unknown, levels, harmless(row.reason or "")]


def _cell(value: object) -> float | str:
    return value if isinstance(value, float) and math.isfinite(value) else ""


def csv_parts(listing: RowList, system: System) -> Iterator[bytes]:
    """Yield the rows as pieces of a CSV file."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerows(heads(listing, system))
    for number, line in enumerate(lines(listing, system), 1):
        writer.writerow(line)
        if number % SOME == 0:
            yield stream.getvalue().encode()
            stream.seek(0)
            stream.truncate()
    yield stream.getvalue().encode()


def xlsx(listing: RowList, system: System) -> bytes:
    """Return the rows as an XLSX file with one sheet.

    Raises
    ------
    InvalidInputs
        If there are too many rows for a sheet.
    """
    if listing.stored.count > MOST_XLSX and len(listing.numbers()) > MOST_XLSX:
        detail = (
            f"a sheet may have at most {MOST_XLSX} rows; download rows.csv or rows.npz, or filter by `where`"
        )
        raise InvalidInputs([Fault("rows", "too_many_rows", detail)])
    from openpyxl import Workbook  # type: ignore[import-untyped]

    book = Workbook(write_only=True)
    sheet = book.create_sheet("rows")
    for line in (*heads(listing, system), *lines(listing, system)):
        sheet.append(line)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def write_npz(listing: RowList, file: IO[bytes]) -> None:
    """Write all columns as named arrays in their units, verdicts as words; equal rows give equal bytes."""
    write_each(file, _arrays(listing), {"units": listing.units, "levels": dict(listing.plan.levels)})


def _arrays(listing: RowList) -> Iterator[tuple[str, AnyArray]]:
    selected = listing.numbers()
    yield "row", selected
    for name in listing.names:
        yield name, listing.column(name)[selected]
    words = np.array(VERDICTS)
    for criterion in listing.plan.criteria:
        codes = listing.stored.codes(criterion)[selected]
        yield f"verdict {criterion}", words[codes]
        yield f"error unknown {criterion}", codes == MET_ERROR_UNKNOWN
    yield "refused", listing.stored.is_refused[selected]
