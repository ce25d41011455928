"""Read tables that people paste from a spreadsheet or a measuring program.

Columns are separated by tabs, semicolons, commas, or blanks that align them. A decimal comma is accepted if
the separator is not a comma; the answer states which mark was used. The first row may contain names, the
second row units; a unit may also be part of a heading, `load_x [kN]`. Blank lines, lines that begin with #,
and lines of words above the headings are skipped. A fault names the row, as numbered in the text, and the
column.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice

from app.calculations.headings import HeadingUnit, heading_unit, is_unit, parted, quantity_of
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt

MOST_CHARACTERS, MOST_ROWS, MOST_COLUMNS, MOST_FAULTS = 1_000_000, 10_000, 32, 20
LONGEST_LINE, LONGEST_NAME = 4000, 80

_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]{1,3})?")
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")
_ALIGNED = re.compile(r" {2,}|[ \u00a0]*\t[ \u00a0]*")
_HEAD = 60
"""Number of lines in which the first row of numbers must occur."""


@dataclass(frozen=True)
class TableColumn:
    """A column: its name, its unit (empty if the table states none), and its numbers.

    `is_crank` is true if its unit is a crank angle such as °CA.
    """

    name: str
    unit: str
    values: tuple[float, ...]
    is_crank: bool = False


@dataclass(frozen=True)
class Table:
    """The columns of a table, and the assumptions made while reading it, such as the decimal mark."""

    columns: list[TableColumn]
    assumed: list[str]


@dataclass(frozen=True)
class _Line:
    """The cells of a line, and its number in the text, counted from 1."""

    row: int
    cells: list[str]

    def fault(self, code: str, detail: str, column: str = "") -> Fault:
        place = f"row {self.row}, column {column}" if column else f"row {self.row}"
        return Fault(place, code, detail)


class _Faults:
    """The faults of a table, collected while reading: the first `most` are listed, the others counted."""

    def __init__(self, most: int) -> None:
        self._most, self._kept, self._more = most, list[Fault](), 0

    def add(self, fault: Fault) -> None:
        """Record a fault; count it only if the list is full."""
        if len(self._kept) < self._most:
            self._kept.append(fault)
        else:
            self._more += 1

    def refuse(self) -> None:
        """Raise InvalidInputs if there are faults; the last one states how many more there are."""
        if self._more:
            detail = f"{self._more} further faults of this table are not listed; put these right first"
            self._kept.append(Fault("table", "more_faults", detail))
        if self._kept:
            raise InvalidInputs(self._kept)


@dataclass
class _Marks:
    """The decimal marks that a table contains, and the first number that they make ambiguous."""

    is_comma: bool  # whether a comma separates the columns
    comma: bool = False
    point: bool = False
    grouped: tuple[_Line, str, str] | None = None

    def number(self, line: _Line, name: str, cell: str) -> float:
        """Return the number in a cell, and remember its decimal mark.

        Raises
        ------
        FaultyText
            If the cell is not a number.
        """
        value = _number(cell, self.is_comma)
        if not self.comma and "," in cell:
            self.comma = True
        elif not self.point and "." in cell:
            self.point = True
        if self.grouped is None and not self.is_comma and _GROUPED.fullmatch(cell):
            self.grouped = line, name, cell
        return value

    def fault(self) -> Fault | None:
        """Return a fault if both decimal marks occur, because a number could be wrong by a factor of 1000."""
        if not (self.comma and self.point and self.grouped):
            return None
        line, name, cell = self.grouped
        digits = re.sub(r"[.,]", "", cell)
        detail = (
            f"the table has decimal commas and points, so that {cell} may mean {digits}; use one mark alone"
        )
        return line.fault("ambiguous_mark", detail, name)

    @property
    def assumed(self) -> list[str]:
        """Return one sentence for each assumption about a decimal or thousands mark."""
        taken = [
            f"decimal {name}" for name, is_met in (("comma", self.comma), ("point", self.point)) if is_met
        ]
        return [" and ".join(taken)] if taken else []


_Unit = HeadingUnit | None  # of a heading, with an empty text where it has none; None where it is wrong
_NO_UNIT = HeadingUnit("")
Heading = Callable[[str, str], Fault | None]
"""Function that returns the fault of a column's name and unit; None if there is none."""


def read_table(
    text: str,
    *,
    most_rows: int = MOST_ROWS,
    most_characters: int = MOST_CHARACTERS,
    most_faults: int = MOST_FAULTS,
    heading: Heading | None = None,
) -> list[TableColumn]:
    """Return the columns of a table, as `table_of` does.

    Raises
    ------
    InvalidInputs
        If cells are wrong; the error lists them.
    """
    return table_of(
        text,
        most_rows=most_rows,
        most_characters=most_characters,
        most_faults=most_faults,
        heading=heading,
    ).columns


def table_of(
    text: str,
    *,
    most_rows: int = MOST_ROWS,
    most_characters: int = MOST_CHARACTERS,
    most_faults: int = MOST_FAULTS,
    heading: Heading | None = None,
    is_sheet: bool = False,
) -> Table:
    """Return a table, in time linear in the length of the text, which is at most `most_characters`.

    Parameters
    ----------
    heading
        Function that checks the name and the unit of each column; its faults are located at the row of the
        headings.
    is_sheet
        Whether a spreadsheet file stored the numbers, so that nobody typed their decimal mark.

    Raises
    ------
    InvalidInputs
        If cells are wrong. The error names up to `most_faults` of them by row and column; its last fault
        states how many more there are.
    """
    lines, is_comma, assumed = _lines(text, most_rows, most_characters)
    width = len(lines[0].cells)
    if width > MOST_COLUMNS:
        raise _wrong("table", "too_many_columns", f"a table may have at most {MOST_COLUMNS} columns")
    faults = _Faults(most_faults)
    names, units, rest = _headings(lines, faults)
    for name, one in zip(names, units, strict=True):
        if heading is not None and one is not None and (fault := heading(name, one.text)):
            faults.add(lines[0].fault(fault.code, fault.detail, name))
    if not rest:
        faults.add(Fault("table", "empty", "the table has no row of numbers"))
    marks = _Marks(is_comma)
    rows = [_numbers(line, names, marks, faults) for line in rest]
    if not is_sheet and (ambiguous := marks.fault()):
        faults.add(ambiguous)
    faults.refuse()
    sound = [one or _NO_UNIT for one in units]
    columns = [
        _column(name, one, values)
        for name, one, values in zip(names, sound, zip(*rows, strict=True), strict=True)
    ]
    if marks.comma or not is_sheet:
        assumed = marks.assumed + assumed
    return Table(columns, [*assumed, *dict.fromkeys(one.assumed for one in sound if one.assumed)])


def _column(name: str, scale: HeadingUnit, values: tuple[float, ...]) -> TableColumn:
    if scale.factor != 1.0:
        values = tuple(value * scale.factor for value in values)
    return TableColumn(name, scale.text, values, scale.is_crank)


def _lines(text: str, most_rows: int, most_characters: int) -> tuple[list[_Line], bool, list[str]]:
    """Return the lines of the table, whether a comma separates columns, and the assumptions made."""
    if len(text) > most_characters:
        message = f"the table has {len(text)} characters; send fewer rows, with at most {most_characters}"
        raise _wrong("table", "too_long", message)
    rows = re.split(r"\r\n|\r|\n", text.removeprefix("\ufeff"))
    numbered = (
        (row, line)
        for row, line in enumerate(rows, start=1)
        if line.strip(" \t;,") and not line.lstrip().startswith("#")
    )
    filled = list(islice(numbered, most_rows + 3))
    if not filled:
        raise _wrong("table", "empty", "the table is empty; paste rows of numbers below their column names")
    if len(filled) > most_rows + 2:
        raise _wrong("table", "too_many_rows", f"a table may have at most {most_rows} rows; send fewer")
    separator, first = _layout(filled)
    assumed = [f"{first} line{'s' if first > 1 else ''} above the headings left out"] if first else []
    if separator == " ":
        assumed.append("columns separated by blanks")
    filled = filled[first:]
    cells = [_cells(row, line, separator) for row, line in filled]
    width = len(_trimmed(cells[0], 1))
    if separator == " " and len(cells) > 1 and len(cells[0]) != (last := len(cells[-1])):
        words = filled[0][1].split()
        cells[0], width = (words, last) if len(words) == last else (cells[0], width)
    lines = [_Line(row, _trimmed(each, width)) for (row, _), each in zip(filled, cells, strict=True)]
    return lines, separator == ",", assumed


def _layout(filled: Sequence[tuple[int, str]]) -> tuple[str, int]:
    """Return the separator of the columns, and the number of lines of text above the headings."""
    head = filled[:_HEAD]
    for separator in "\t;, ":
        rows = [_trimmed(_cells(row, line, separator), 1) for row, line in head]
        first = next((n for n, row in enumerate(rows) if len(row) > 1 and all(map(_is_number, row))), None)
        if first is None:
            continue
        width = len(rows[first])
        if separator == " ":
            heading = len(_ALIGNED.split(head[first - 1][1].strip())) if first else width
            if first == 0 or heading == width or len(head[first - 1][1].split()) == width:
                return separator, 0
            continue
        start = first
        while start and len(rows[start - 1]) == width and not any(map(_is_number, rows[start - 1])):
            start -= 1
        if start < first:
            return separator, start
        if first == 0:
            return separator, 0
    sign = next((sign for sign in "\t;" if sign in head[0][1]), ",")
    if (
        len(head) > 1
        and "," not in head[0][1]
        and sign == ","
        and _DECIMAL_COMMA.fullmatch(head[1][1].strip())
    ):
        return ";", 0
    return sign, 0


def _trimmed(cells: list[str], least: int) -> list[str]:
    """Return the cells without trailing empty cells, which spreadsheets add to rows."""
    empty = next((n for n, cell in enumerate(reversed(cells)) if cell), 0)
    return cells[: max(len(cells) - empty, least)]


def _cells(row: int, line: str, separator: str) -> list[str]:
    if len(line) > LONGEST_LINE:
        raise _wrong(f"row {row}", "too_long", f"a row may have at most {LONGEST_LINE} characters")
    if separator == " ":
        words = line.split()
        return words if all(map(_is_number, words)) else _ALIGNED.split(line.strip())
    try:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=separator != "\t")
    except (csv.Error, ValueError):
        raise _wrong(
            f"row {row}", "not_a_row", "the quotes in this row cannot be read; remove them"
        ) from None
    return [cell.strip() for cell in cells]


def _headings(lines: Sequence[_Line], faults: _Faults) -> tuple[list[str], list[_Unit], Sequence[_Line]]:
    """Return the names and units of the columns (None where a unit is wrong), and the lines below them."""
    first = lines[0]
    if not _is_words(first):
        return [f"column {n}" for n in range(1, len(first.cells) + 1)], [_NO_UNIT] * len(first.cells), lines
    split = _units_alone(first) or [_heading(cell, place) for place, cell in enumerate(first.cells, start=1)]
    names = [name for name, _ in split]
    units = _read_units(first, names, [text for _, text in split], faults)
    if len(lines) < 2 or not _is_words(lines[1]) or len(lines[1].cells) != len(names):
        return names, units, lines[1:]
    texts = [_bare(cell) for cell in lines[1].cells]
    if all(one is not None and one.text for one in units) and not all(is_unit(text) for text in texts):
        return names, units, lines[1:]  # the headings have their units: these words are not numbers
    below = _read_units(lines[1], names, texts, faults)
    return names, _agreed(lines[1], names, units, below, faults), lines[2:]


def _units_alone(line: _Line) -> list[tuple[str, str]]:
    """Return names and units if the headings are only units of crank angle and pressure; otherwise empty."""
    texts = [_bare(cell) for cell in line.cells]
    names = [quantity_of(text) for text in texts]
    if not all(names) or len(set(names)) < 2:
        return []
    numbered = [f"{name} {names[: n + 1].count(name)}" if names.count(name) > 1 else name
                for n, name in enumerate(names)]  # fmt: skip
    return list(zip(numbered, texts, strict=True))


def _is_words(line: _Line) -> bool:
    """Return whether a line contains words but no number; a `1` may be the unit of a pure number."""
    rest = [cell for cell in line.cells if cell not in ("", "1", "-")]
    return bool(rest) and not any(cell.startswith("=") or _is_number(cell) for cell in rest)


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell) or _DECIMAL_COMMA.fullmatch(cell))


def _heading(cell: str, place: int) -> tuple[str, str]:
    """Return the name and the unit of a heading such as `load_x [kN]`."""
    name, text = parted(cell)
    return name[:LONGEST_NAME] or f"column {place}", text


def _bare(cell: str) -> str:
    """Return a unit without its surrounding brackets."""
    name, text = parted(cell)
    return text if text and not name else cell


def _read_units(line: _Line, names: Sequence[str], texts: Sequence[str], faults: _Faults) -> list[_Unit]:
    """Return the checked units of a row; empty if the row has no units, None if a unit is wrong."""
    units: list[_Unit] = []
    for name, text in zip(names, texts, strict=True):
        try:
            units.append(heading_unit(text) if text.strip() else _NO_UNIT)
        except FaultyText as error:
            faults.add(line.fault("unknown_unit", str(error.fault(name).detail), name))
            units.append(None)
    return units


def _agreed(
    line: _Line,
    names: Sequence[str],
    above: Sequence[_Unit],
    below: Sequence[_Unit],
    faults: _Faults,
) -> list[_Unit]:
    """Return the units that the two rows of headings state; the rows must agree."""
    for name, one, other in zip(names, above, below, strict=True):
        if one and other and one.text and other.text and one.text != other.text:
            detail = f"the header says {one.text}, this row {other.text}; keep one of them"
            faults.add(line.fault("two_units", detail, name))
    return [
        None if one is None or other is None else one if one.text else other
        for one, other in zip(above, below, strict=True)
    ]


def _numbers(line: _Line, names: Sequence[str], marks: _Marks, faults: _Faults) -> list[float]:
    """Return the numbers of a line; record a fault for each cell without a number or a wrong length."""
    if len(line.cells) != len(names):
        detail = f"it has {len(line.cells)} cells, the first row has {len(names)}"
        hint = "; with decimal commas, separate the columns by semicolons or tabs" if marks.is_comma else ""
        faults.add(line.fault("ragged", detail + hint))
    numbers = []
    for name, cell in zip(names, line.cells, strict=False):
        try:
            numbers.append(marks.number(line, name, cell))
        except FaultyText as error:
            fault = error.fault(name)
            faults.add(line.fault(fault.code, fault.detail, name))
    return numbers


def _number(cell: str, is_comma: bool) -> float:
    """Return the number in a cell.

    Raises
    ------
    FaultyText
        If the cell is not a number.
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
