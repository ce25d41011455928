"""The rows of a table that a user gives: columns by name, or a list of rows, in any suitable unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice

import numpy as np

from app.designs.engine.design_engine import DesignEngine
from app.designs.variant_sheets.grid import MOST_FAULTS, refuse
from app.plain import Raw
from app.reference import Reference
from app.studies.bodies import MOST_ROWS, MOST_VARIED
from app.studies.question import single, too_long
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.units.quantity import read

Rows = Mapping[str, Raw] | Sequence[Mapping[str, Raw]]


def columns_named(rows: Rows | None) -> list[str]:
    """Return the places that the rows set, in order.

    Raises
    ------
    InvalidInputs
        If the rows do not all set the same places, or set too many.
    """
    if not rows:
        return []
    first = rows if isinstance(rows, Mapping) else rows[0]
    uneven = (
        (number, row)
        for number, row in enumerate(() if isinstance(rows, Mapping) else rows)
        if row.keys() != first.keys()
    )
    faults = [_uneven(number, row, first) for number, row in islice(uneven, MOST_FAULTS)]
    if len(first) > MOST_VARIED:
        faults.append(Fault("rows", "too_many_columns", f"at most {MOST_VARIED} parameters can vary"))
    refuse(faults)
    return list(first)


def _uneven(number: int, row: Mapping[str, Raw], first: Mapping[str, Raw]) -> Fault:
    differing = ", ".join(sorted(first.keys() ^ row.keys())[:MOST_VARIED])
    detail = f"row {number} sets other places than row 0: {differing}; give every row the same places"
    return Fault(f"rows.{number}", "uneven", detail)


def given_rows(rows: Rows, engine: DesignEngine) -> Array:
    """Return the values [SI] of the rows, shape (N, d).

    Raises
    ------
    InvalidInputs
        If cells are faulty. The error lists up to `MOST_FAULTS` of them, each by its column and, if it has
        one, its row.
    """
    units = {name: engine.unit(Reference.parse(name)) for name in columns_named(rows)}
    faults: list[Fault] = []
    if isinstance(rows, Mapping):
        columns = [_column(name, rows[name], unit, faults) for name, unit in units.items()]
    else:
        columns = [_cells(name, rows, unit, faults) for name, unit in units.items()]
    refuse(faults)
    lengths = {len(column) for column in columns}
    if len(lengths) > 1:
        raise InvalidInputs([Fault("rows", "uneven", "the columns of a table must have equal lengths")])
    if max(lengths) > MOST_ROWS["table"]:
        raise InvalidInputs([too_long("table", max(lengths))])
    return np.stack(columns, axis=-1)


def _column(name: str, raw: Raw, unit: str, faults: list[Fault]) -> Array:
    """Return a column [SI]; if it has faults, add them to the list and return an empty column."""
    try:
        value = read(raw, unit).si
    except FaultyText as error:
        faults.append(error.fault(f"rows.{name}"))
        return np.empty(0)
    column = np.atleast_1d(np.asarray(value, dtype=np.float64))
    if column.ndim > 1:
        faults.append(Fault(f"rows.{name}", "shape", "a column needs one number for each row"))
        return np.empty(0)
    return column


def _cells(name: str, rows: Sequence[Mapping[str, Raw]], unit: str, faults: list[Fault]) -> Array:
    """Return the cells of a column [SI], and add their faults to the list."""
    column = np.full(len(rows), np.nan)
    for number, row in enumerate(rows):
        try:
            column[number] = single(row[name], unit, f"rows.{number}.{name}")
        except InvalidInputs as error:
            faults += error.faults if len(faults) < MOST_FAULTS else ()
    return column
