"""The rows of a table that a user gave: columns by name, or a list of rows, in any unit that fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.designs.net import Net
from app.designs.reference import Reference
from app.plain import Raw
from app.studies.asking import single, too_long
from app.studies.schemas import MOST_ROWS, MOST_VARIED
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.units.quantity import read

Rows = Mapping[str, Raw] | Sequence[Mapping[str, Raw]]


def columns_named(rows: Rows | None) -> list[str]:
    """The places that the rows set, in their order.

    Raises
    ------
    InvalidInputs
        If the rows do not all set the same places, or set too many.
    """
    if not rows:
        return []
    first = rows if isinstance(rows, Mapping) else rows[0]
    for number, row in enumerate(() if isinstance(rows, Mapping) else rows):
        if row.keys() != first.keys():
            differing = ", ".join(sorted(first.keys() ^ row.keys())[:MOST_VARIED])
            detail = f"row {number} has other columns than row 0: {differing}"
            raise InvalidInputs([Fault(f"rows.{number}", "uneven", detail)])
    if len(first) > MOST_VARIED:
        raise InvalidInputs([Fault("rows", "too_many_columns", f"at most {MOST_VARIED} places vary")])
    return list(first)


def given_rows(rows: Rows, net: Net) -> Array:
    """The values [SI] of the rows, shape (N, d).

    Raises
    ------
    InvalidInputs
        Naming the column, and the row where it has one.
    """
    units = {name: net.unit(Reference.parse(name)) for name in columns_named(rows)}
    if isinstance(rows, Mapping):
        columns = [_column(name, rows[name], unit) for name, unit in units.items()]
    else:
        columns = [_cells(name, rows, unit) for name, unit in units.items()]
    lengths = {len(column) for column in columns}
    if len(lengths) > 1:
        raise InvalidInputs([Fault("rows", "uneven", "the columns of a table are of equal length")])
    if max(lengths) > MOST_ROWS["table"]:
        raise InvalidInputs([too_long("table", max(lengths))])
    return np.stack(columns, axis=-1)


def _column(name: str, raw: Raw, unit: str) -> Array:
    try:
        value = read(raw, unit).si
    except FaultyText as error:
        raise InvalidInputs([error.fault(f"rows.{name}")]) from None
    column = np.atleast_1d(np.asarray(value, dtype=np.float64))
    if column.ndim > 1:
        raise InvalidInputs([Fault(f"rows.{name}", "shape", "a column has one number for each row")])
    return column


def _cells(name: str, rows: Sequence[Mapping[str, Raw]], unit: str) -> Array:
    return np.array([single(row[name], unit, f"rows.{number}.{name}") for number, row in enumerate(rows)])
