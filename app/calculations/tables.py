"""Tables as people paste them from a spreadsheet or a measuring program.

Columns are separated by tabs, semicolons or commas. A decimal comma is read where the separator is a tab or
a semicolon. The first row may hold names, the second one units; a unit may also stand in brackets behind a
name, `load_x [kN]`. Blank lines are skipped. A fault names the row, counted as in the text, and the column.
`curves.py` reads the stricter files of the REST interface.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice

from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt
from templates.core.units.units import unit

MOST_CHARACTERS, MOST_ROWS, MOST_COLUMNS, MOST_FAULTS = 1_000_000, 10_000, 32, 20
LONGEST_LINE, LONGEST_NAME = 4000, 80

_HEADING = re.compile(r"(?P<name>[^\[(]*)[\[(](?P<unit>[^\])]*)[\])]")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]{1,3})?")


@dataclass(frozen=True)
class TableColumn:
    """A column: its name, its unit (empty where the table says none), and its numbers."""

    name: str
    unit: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class _Line:
    """The cells of a line, and its number in the text, from 1."""

    row: int
    cells: list[str]

    def fault(self, code: str, detail: str, column: str = "") -> Fault:
        place = f"row {self.row}, column {column}" if column else f"row {self.row}"
        return Fault(place, code, detail)


class _Faults:
    """The faults of a table as they are met: the first `most` are kept, the others counted."""

    def __init__(self, most: int) -> None:
        self._most, self._kept, self._more = most, list[Fault](), 0

    def add(self, fault: Fault) -> None:
        """Keep a fault, or count it."""
        if len(self._kept) < self._most:
            self._kept.append(fault)
        else:
            self._more += 1

    def refuse(self) -> None:
        """Raise InvalidInputs if there are any; the last says how many are not listed."""
        if self._more:
            detail = f"{self._more} further faults of this table are not listed; put these right first"
            self._kept.append(Fault("table", "more_faults", detail))
        if self._kept:
            raise InvalidInputs(self._kept)


_Unit = str | None  # as it stands in a heading; None where it is wrong
Heading = Callable[[str, str], Fault | None]
"""What is wrong with the name and the unit of a column, if anything is."""


def read_table(
    text: str,
    *,
    most_rows: int = MOST_ROWS,
    most_characters: int = MOST_CHARACTERS,
    most_faults: int = MOST_FAULTS,
    heading: Heading | None = None,
) -> list[TableColumn]:
    """Return the columns of a table. Linear in the length of the text, which is at most `most_characters`.

    Parameters
    ----------
    heading
        Judges the name and the unit of each column; what it finds is named by the row of the headings.

    Raises
    ------
    InvalidInputs
        Naming every cell that is wrong by its row and column, up to `most_faults`; the last fault says how
        many more there are.
    """
    lines, is_comma = _lines(text, most_rows, most_characters)
    width = len(lines[0].cells)
    if width > MOST_COLUMNS:
        raise _wrong("table", "too_many_columns", f"a table has at most {MOST_COLUMNS} columns")
    faults = _Faults(most_faults)
    names, units, rest = _headings(lines, faults)
    for name, one in zip(names, units, strict=True):
        if heading is not None and one is not None and (fault := heading(name, one)):
            faults.add(lines[0].fault(fault.code, fault.detail, name))
    if not rest:
        faults.add(Fault("table", "empty", "the table has no row of numbers"))
    rows = [_numbers(line, names, is_comma, faults) for line in rest]
    faults.refuse()
    columns = zip(*rows, strict=True)
    return [
        TableColumn(name, one or "", values) for name, one, values in zip(names, units, columns, strict=True)
    ]


def _lines(text: str, most_rows: int, most_characters: int) -> tuple[list[_Line], bool]:
    """Return the lines that are not blank, and whether a comma separates their columns."""
    if len(text) > most_characters:
        message = f"a table has at most {most_characters} characters, this one {len(text)}; take fewer rows"
        raise _wrong("table", "too_long", message)
    rows = re.split(r"\r\n|\r|\n", text.removeprefix("\ufeff"))
    numbered = ((row, line) for row, line in enumerate(rows, start=1) if line.strip(" \t;,"))
    filled = list(islice(numbered, most_rows + 3))
    if not filled:
        raise _wrong("table", "empty", "the table is empty; paste rows of numbers, with their names above")
    if len(filled) > most_rows + 2:
        raise _wrong("table", "too_many_rows", f"a table has at most {most_rows} rows; take fewer")
    separator = next((sign for sign in "\t;" if sign in filled[0][1]), ",")
    cells = [_cells(row, line, separator) for row, line in filled]
    width = len(_trimmed(cells[0], 1))
    lines = [_Line(row, _trimmed(each, width)) for (row, _), each in zip(filled, cells, strict=True)]
    return lines, separator == ","


def _trimmed(cells: list[str], least: int) -> list[str]:
    """Return the cells without the empty ones that a spreadsheet leaves at the end of a row."""
    empty = next((n for n, cell in enumerate(reversed(cells)) if cell), 0)
    return cells[: max(len(cells) - empty, least)]


def _cells(row: int, line: str, separator: str) -> list[str]:
    if len(line) > LONGEST_LINE:
        raise _wrong(f"row {row}", "too_long", f"a row has at most {LONGEST_LINE} characters")
    try:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=separator != "\t")
    except (csv.Error, ValueError):
        raise _wrong(
            f"row {row}", "not_a_row", "the quotes in this row cannot be read; remove them"
        ) from None
    return [cell.strip() for cell in cells]


def _headings(lines: Sequence[_Line], faults: _Faults) -> tuple[list[str], list[_Unit], Sequence[_Line]]:
    """Return names and units of the columns (None where a unit is wrong), and the lines below them."""
    first = lines[0]
    if not _is_words(first):
        return [f"column {n}" for n in range(1, len(first.cells) + 1)], [""] * len(first.cells), lines
    split = [_heading(cell, place) for place, cell in enumerate(first.cells, start=1)]
    names = [name for name, _ in split]
    units = _read_units(first, names, [text for _, text in split], faults)
    if len(lines) < 2 or not _is_words(lines[1]) or len(lines[1].cells) != len(names):
        return names, units, lines[1:]
    below = _read_units(lines[1], names, [cell.strip("[]()") for cell in lines[1].cells], faults)
    return names, _agreed(lines[1], names, units, below, faults), lines[2:]


def _is_words(line: _Line) -> bool:
    """Return whether a line holds words and no number; `1` may be the unit of a pure number."""
    rest = [cell for cell in line.cells if cell not in ("", "1", "-")]
    return bool(rest) and not any(cell.startswith("=") or _is_number(cell) for cell in rest)


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell) or _DECIMAL_COMMA.fullmatch(cell))


def _heading(cell: str, place: int) -> tuple[str, str]:
    """Name and unit of a heading such as `load_x [kN]`."""
    match = _HEADING.fullmatch(cell)
    name, text = (match["name"], match["unit"]) if match else (cell, "")
    return name.strip()[:LONGEST_NAME] or f"column {place}", text.strip()


def _read_units(line: _Line, names: Sequence[str], texts: Sequence[str], faults: _Faults) -> list[_Unit]:
    """Return the units of a row, each checked; empty where there is none, None where it is wrong."""
    units: list[_Unit] = []
    for name, text in zip(names, texts, strict=True):
        try:
            units.append(unit("1" if text == "-" else text.strip()).text if text.strip() else "")
        except FaultyText as error:
            faults.add(line.fault("unknown_unit", str(error.fault(name).detail), name))
            units.append(None)
    return units


def _agreed(
    line: _Line,
    names: Sequence[str],
    above: Sequence[str | None],
    below: Sequence[str | None],
    faults: _Faults,
) -> list[_Unit]:
    """Return the units of the two rows of headings, which may not contradict each other."""
    for name, one, other in zip(names, above, below, strict=True):
        if one and other and one != other:
            detail = f"the header says {one}, this row {other}; keep one of them"
            faults.add(line.fault("two_units", detail, name))
    return [
        None if one is None or other is None else one or other
        for one, other in zip(above, below, strict=True)
    ]


def _numbers(line: _Line, names: Sequence[str], is_comma: bool, faults: _Faults) -> list[float]:
    """Return the numbers of a line; what is none, and a line of another length, is added to the faults."""
    if len(line.cells) != len(names):
        detail = f"it has {len(line.cells)} cells, the first row has {len(names)}"
        hint = "; with decimal commas, separate the columns by semicolons or tabs" if is_comma else ""
        faults.add(line.fault("ragged", detail + hint))
    numbers = []
    for name, cell in zip(names, line.cells, strict=False):
        try:
            numbers.append(_number(cell, is_comma))
        except FaultyText as error:
            fault = error.fault(name)
            faults.add(line.fault(fault.code, fault.detail, name))
    return numbers


def _number(cell: str, is_comma: bool) -> float:
    """Return the number in a cell.

    Raises
    ------
    FaultyText
        If there is none.
    """
    if cell.startswith("="):
        raise FaultyText("formula", f"{excerpt(cell)} is a formula; paste its value instead")
    plain = cell.replace(",", ".") if not is_comma and _DECIMAL_COMMA.fullmatch(cell) else cell
    if not _NUMBER.fullmatch(plain):
        what = f"{excerpt(cell)} is not a number" if cell else "there is no number"
        raise FaultyText("not_a_number", f"{what}; write one such as 0.05")
    if not math.isfinite(number := float(plain)):
        raise FaultyText("not_finite", f"{excerpt(cell)} is too large")
    return number


def _wrong(name: str, code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault(name, code, detail)])
