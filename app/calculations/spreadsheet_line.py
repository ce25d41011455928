"""Write an evaluation as lines of CSV (names, units, numbers) for a spreadsheet that requests it by a URL."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from itertools import zip_longest

from app.calculations.json_values import evaluation
from app.plain import Raw
from app.pool.sources import Source, loaded
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.evaluate import evaluate

MOST_INPUTS, MOST_POINTS = 200, 1000
_DANGEROUS = ("=", "+", "-", "@", "\t", "\r")


def csv_of(
    source: Source,
    inputs: Mapping[str, Raw],
    outputs: Sequence[str] | None,
    level: str | None,
    tolerance: float | None,
) -> bytes:
    """Return the outputs of a template as CSV: a row of names, one of units, and one for each point.

    Raises
    ------
    InvalidInputs
        If inputs are wrong, or an output is a curve (code `shape`); the error lists all faults.
    """
    result = evaluation(
        evaluate(loaded(source), inputs, outputs=outputs, level=level, tolerance=tolerance, judge=False)
    )
    shown = result["outputs"]
    curves = [name for name, output in shown.items() if _depth(output["value"]) > 1]
    if curves:
        detail = "is a curve, which has no cell of its own; name other outputs in `outputs`"
        raise InvalidInputs(Fault(name, "shape", f"{name} {detail}") for name in curves)
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(shown)
    writer.writerow(output.get("unit") or "" for output in shown.values())
    columns = [_column(output["value"]) for output in shown.values()]
    count = max(map(len, columns), default=0)
    spread = [column * count if len(column) == 1 else column for column in columns]
    for row in zip_longest(*spread):
        writer.writerow(map(_cell, row))
    return stream.getvalue().encode()


def _depth(value: object) -> int:
    return 1 + _depth(value[0]) if isinstance(value, list) and value else 0


def _column(value: object) -> list[object]:
    return value if isinstance(value, list) else [value]


def _cell(value: object) -> object:
    """Return a value as a cell that no spreadsheet reads as a formula; empty if the value is missing."""
    if isinstance(value, str) and value.startswith(_DANGEROUS):
        return f"'{value}"
    return "" if value is None else value
