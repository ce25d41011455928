"""Read curves from a file: the columns of a table as quantities, an indicator diagram as one cycle.

Headings such as `crank angle [deg], pressure [bar]` or `crank_angle_deg,pressure_bar` are understood.
`tables` reads files and pasted tables alike; `indicator` averages several cycles into one. Nothing is
stored. The answer lists every assumption; an ambiguous cell is refused with its line number.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, replace

from app.calculations.indicator import as_cycle, is_cycle_number
from app.calculations.table_files import FileText, file_text
from app.calculations.tables import MOST_FAULTS, Table, TableColumn, table_of
from app.plain import JsonObject
from templates.core.errors import Fault, InvalidInputs, excerpt
from templates.core.language.meaning import api_name
from templates.core.units.units import unit

MOST_ROWS = 50_000
MOST_BYTES, MOST_UNPACKED = 4_000_000, 40_000_000
"""Largest size of a file as sent, and of XLSX unpacked [bytes]."""

SUFFIXES = ("deg", "rad", "bar", "Pa", "kPa", "MPa", "psi", "N", "kN", "lbf", "s", "ms", "mm", "m", "rpm")
"""Units that may end a name without brackets."""

_ROW = re.compile(r"row (?P<number>[0-9]+)(?:, column (?P<column>.*))?", re.DOTALL)


@dataclass(frozen=True)
class ReadCurves:
    """The columns of a table as quantities by name, and the assumptions made while reading it."""

    curves: dict[str, JsonObject]
    assumed: list[str]


def curves_of(body: bytes) -> ReadCurves:
    """Return the columns of a file as quantities, and the assumptions made.

    Raises
    ------
    InvalidInputs
        If lines are wrong; the error lists up to twenty of them.
    """
    try:
        table = as_cycle(_with_units(_table(file_of(body))))
    except InvalidInputs as error:
        raise InvalidInputs(map(_by_line, error.faults)) from None
    curves = {_named(c): {"value": list(c.values), "unit": c.unit} for c in table.columns}
    return ReadCurves(curves, table.assumed)


def file_of(body: bytes) -> FileText:
    """Return the text of a file that is within the size limits for curves.

    Raises
    ------
    InvalidInputs
        If it is too large, damaged, or of another kind.
    """
    return file_text(body, MOST_BYTES, MOST_UNPACKED, MOST_ROWS)


def _table(file: FileText) -> Table:
    seen = Counter[str]()

    def heading(name: str, given: str) -> Fault | None:
        words, own = _parted(name, given)
        name_here = api_name(words)
        seen[name_here] += 1
        if not name_here or not name_here[0].isalpha() or re.fullmatch(r"column [0-9]+", name):
            return Fault(name, "missing_name", "the column has no name; write one, such as `pressure [bar]`")
        if seen[name_here] == 2:
            return Fault(name, "named_twice", f"two columns are named {name_here}; give them different names")
        if not own and not is_cycle_number(name):
            detail = (
                f"column {excerpt(name)} has no unit; write it like `pressure [bar]`, or with `[1]` for none"
            )
            return Fault(name, "missing_unit", detail)
        return None

    table = table_of(
        file.text,
        most_rows=MOST_ROWS,
        most_characters=MOST_BYTES,
        most_faults=MOST_FAULTS,
        heading=heading,
        is_sheet=file.is_sheet,
    )
    return replace(table, assumed=[*file.assumed, *table.assumed])


def _parted(name: str, given: str) -> tuple[str, str]:
    """Return the words and the unit of a heading that may end with a unit, such as `pressure_bar`."""
    words, _, last = name.rpartition("_")
    return (words, last) if not given and last in SUFFIXES else (name, given)


def _with_units(table: Table) -> Table:
    return replace(table, columns=[_united(column) for column in table.columns])


def _united(column: TableColumn) -> TableColumn:
    words, own = _parted(column.name, column.unit)
    return replace(column, name=words, unit=unit(own or "1").text)


def _named(column: TableColumn) -> str:
    return api_name(column.name)[:80]


def _by_line(fault: Fault) -> Fault:
    """Return the fault with the line number that it is about."""
    if not (match := _ROW.fullmatch(fault.name)):
        return fault
    detail = f"{match['column']}: {fault.detail}" if match["column"] else fault.detail
    return Fault(f"line {match['number']}", fault.code, detail)
