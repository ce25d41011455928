"""The cells of a sheet as texts, with their addresses: `D4` is column 4 of row 4."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from templates.core.errors import Fault, InvalidInputs

LAST_ROW, MOST_COLUMNS, LONGEST_CELL = 1000, 400, 32_000
MOST_FAULTS = 500
"""Largest number of faults reported for one table."""

_ADDRESS = re.compile(r"(?P<column>[A-Z]{1,4})(?P<row>[0-9]{1,7})")


@dataclass(frozen=True)
class Grid:
    """The cells of a sheet by row, without empty cells at the ends; `faults` are the faults of its cells."""

    rows: tuple[tuple[str, ...], ...]
    faults: tuple[Fault, ...] = ()

    def cell(self, row: int, column: int) -> str:
        """Return the text of a cell, counted from 0; empty if the sheet does not have the cell."""
        inside = 0 <= row < len(self.rows) and 0 <= column < len(self.rows[row])
        return self.rows[row][column] if inside else ""

    @property
    def width(self) -> int:
        """Return the length of the longest row."""
        return max(map(len, self.rows), default=0)


def grid_of(rows: Sequence[Sequence[str]], faults: Sequence[Fault] = ()) -> Grid:
    """Return a grid of trimmed texts.

    Raises
    ------
    InvalidInputs
        If a cell lies beyond `LAST_ROW` or `MOST_COLUMNS` or is too long, or all cells are empty.
    """
    trimmed = [_trimmed([cell.strip() for cell in row]) for row in rows]
    while trimmed and not trimmed[-1]:
        trimmed.pop()
    if not trimmed:
        message = "the table is empty; begin with the headings: variant, film.bearing_width, …"
        raise InvalidInputs([Fault("A1", "empty", message)])
    _refuse_large(trimmed)
    return Grid(tuple(map(tuple, trimmed)), tuple(faults))


def _trimmed(cells: list[str]) -> list[str]:
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _refuse_large(rows: Sequence[Sequence[str]]) -> None:
    faults = []
    if len(rows) > LAST_ROW:
        place, message = address(len(rows) - 1, 0), f"a table of variants must end by row {LAST_ROW}"
        faults.append(Fault(place, "too_many_rows", f"{message}; remove the rows below"))
    for number, row in enumerate(rows):
        if len(row) > MOST_COLUMNS:
            place, message = address(number, len(row) - 1), f"a table may have at most {MOST_COLUMNS} columns"
            faults.append(Fault(place, "too_many_columns", message))
        faults += [
            Fault(address(number, column), "too_long", f"a cell may have at most {LONGEST_CELL} characters")
            for column, cell in enumerate(row)
            if len(cell) > LONGEST_CELL
        ]
    refuse(faults)


def refuse(faults: Sequence[Fault]) -> None:
    """Raise InvalidInputs if there are faults.

    Raises
    ------
    InvalidInputs
        If there are faults; the error lists at most `MOST_FAULTS` of them.
    """
    if faults:
        raise InvalidInputs(faults[:MOST_FAULTS])


def address(row: int, column: int) -> str:
    """Return the address of a cell whose row and column are counted from 0: `address(3, 3)` is `D4`."""
    letters, rest = "", column + 1
    while rest:
        rest, place = divmod(rest - 1, 26)
        letters = chr(ord("A") + place) + letters
    return f"{letters}{row + 1}"


def column_of(letters: str) -> int:
    """Return the number of a column, counted from 0: 0 for `A`, 26 for `AA`."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1


def cell_of(address: str) -> tuple[int, int] | None:
    """Return the row and column of an address, counted from 0: (3, 3) for `D4`; None if it is not one."""
    match = _ADDRESS.fullmatch(address)
    return (int(match["row"]) - 1, column_of(match["column"])) if match else None
