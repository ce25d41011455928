"""Convert between the cells of the table of variants on a page, and the CSV file of the interface.

A control of the page is named after the address of its cell: `cell.B3`. The page shows relations in their
cells, after an equals sign. The file has them in separate columns, whose addresses map back to the page.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from app.designs.variant_sheets.csv_files import write_csv
from app.designs.variant_sheets.grid import LAST_ROW, MOST_COLUMNS, Grid, address, column_of
from app.designs.variant_sheets.headings import place_named
from app.designs.variant_sheets.reader import RELATION, RESULTS
from app.schemas.problems import Fault

CONTROL = "cell."
_ADDRESS = re.compile(r"([A-Z]{1,3})([1-9][0-9]{0,3})")
FIRST_VARIANT = 2
"""Index of the first variant's row, from 0: below headings and units."""


@dataclass(frozen=True)
class CsvFile:
    """A table as a CSV file, and the positions of its cells on the page."""

    content: bytes
    columns: Mapping[int, int]  # column of the page, by column of the file

    def on_page(self, fault: Fault) -> Fault:
        """Return a fault with the address that its cell has on the page."""
        match = _ADDRESS.fullmatch(fault.name)
        if match is None or (column := column_of(match[1])) not in self.columns:
            return fault
        return fault.model_copy(update={"name": address(int(match[2]) - 1, self.columns[column])})


def grid_of_form(typed: Mapping[str, str]) -> Grid:
    """Return the cells of a form; the row in its field `drop` is emptied."""
    cells: dict[tuple[int, int], str] = {}
    for name, text in typed.items():
        match = _ADDRESS.fullmatch(name.removeprefix(CONTROL)) if name.startswith(CONTROL) else None
        if match:
            row, column = int(match[2]) - 1, column_of(match[1])
            if row < LAST_ROW and column < MOST_COLUMNS:
                cells[row, column] = text.strip()
    height = 1 + max((row for row, _ in cells), default=-1)
    width = 1 + max((column for _, column in cells), default=-1)
    dropped = typed.get("drop", "")
    rows = [
        tuple("" if str(row + 1) == dropped else cells.get((row, at), "") for at in range(width))
        for row in range(height)
    ]
    return Grid(tuple(rows))


def with_units(grid: Grid, units: Mapping[str, str]) -> Grid:
    """Return the grid with the declared unit for each column that has none."""
    if len(grid.rows) < FIRST_VARIANT:
        return grid
    below = [grid.cell(1, at) or ("" if at == 0 else _declared(grid, at, units)) for at in range(grid.width)]
    return replace(grid, rows=(grid.rows[0], tuple(below), *grid.rows[FIRST_VARIANT:]))


def _declared(grid: Grid, at: int, units: Mapping[str, str]) -> str:
    """Return the declared unit of the value that a column contains."""
    return units.get(place_named(grid.cell(0, at), units), "")


def csv_of(grid: Grid) -> CsvFile:
    """Return the CSV file for a page's cells; relations are in separate columns, without equals sign."""
    related = [at for at in range(1, grid.width) if _has_relation(grid, at)]
    rows = [
        [_own(grid, row, at, related) for at in range(grid.width)]
        + [_relation(grid, row, at) for at in related]
        for row in range(len(grid.rows))
    ]
    return CsvFile(write_csv(rows), {grid.width + place: at for place, at in enumerate(related)})


def _has_relation(grid: Grid, at: int) -> bool:
    heading = grid.cell(0, at)
    is_plain = not heading.endswith(RELATION) and not heading.lower().startswith(RESULTS)
    return is_plain and any(_is_relation(grid, row, at) for row in range(len(grid.rows)))


def _is_relation(grid: Grid, row: int, at: int) -> bool:
    return row >= FIRST_VARIANT and grid.cell(row, at).startswith("=")


def _own(grid: Grid, row: int, at: int, related: Collection[int]) -> str:
    """Return the part of a cell that belongs in the page's column itself; empty for a relation."""
    return "" if at in related and _is_relation(grid, row, at) else grid.cell(row, at)


def _relation(grid: Grid, row: int, at: int) -> str:
    """Return the part of a cell that belongs in the column of relations for column `at` of the page."""
    if row == 0:
        return f"{grid.cell(0, at)} {RELATION}"
    return grid.cell(row, at).removeprefix("=").strip() if _is_relation(grid, row, at) else ""
