"""Import a file as a worksheet; runs in a separate process, within limits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from app.worksheets.imports.legacy import read_legacy
from app.worksheets.imports.outcome import Outcome, one_line
from app.worksheets.imports.package import is_package
from app.worksheets.imports.prime import read_prime
from app.worksheets.imports.record import SheetRecord, recorded
from app.worksheets.imports.regions import Original, OriginalSheet
from app.worksheets.imports.translation import translated
from app.worksheets.imports.verification import verified

LONGEST_TITLE = 100


@dataclass(frozen=True)
class ImportResult:
    """The text of the worksheet, and the record of the import."""

    text: str
    record: SheetRecord


def read_sheet(content: bytes) -> OriginalSheet:
    """Return the sheet in a file of either kind.

    Raises
    ------
    SheetNotRead
        If it is not a Mathcad sheet, or is refused; the error gives reason and remedy.
    """
    return read_prime(content) if is_package(content) else read_legacy(content)


def imported(content: bytes, title: str) -> ImportResult:
    """Return the worksheet for a file, with an outcome for each of its regions.

    Raises
    ------
    SheetNotRead
        If it is not a Mathcad sheet, or is refused.
    """
    sheet = read_sheet(content)
    outcomes = translated(sheet)
    outcomes += list(_left_out(sheet, outcomes))
    text = verified(_title(outcomes, title), outcomes)
    return ImportResult(text, recorded(sheet, outcomes, text))


def _left_out(sheet: OriginalSheet, outcomes: Iterable[Outcome]) -> Iterator[Outcome]:
    """Yield a refusal for each region of the file that was counted but has no outcome."""
    reported = Counter(outcome.original.number for outcome in outcomes)
    for number in (sheet.counted - reported).elements():
        outcome = Outcome(Original(number, "other", 0.0, 0.0))
        outcome.refuse(
            "region that the import left out, which is an error in the program",
            "report the error, and write the content of the region by hand",
        )
        yield outcome


def _title(outcomes: list[Outcome], other: str) -> str:
    """Return the first text of the sheet if it is short enough for a title, else a default title."""
    first = next((o for o in outcomes if o.original.kind == "text" and o.original.text), None)
    if first is not None and len(first.original.text) <= LONGEST_TITLE and "\n" not in first.original.text:
        if first is outcomes[0]:
            first.lines = []
            return one_line(first.original.text)
    return one_line(other) or "Imported worksheet"
