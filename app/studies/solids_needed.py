"""What a study would take that needs a solid for each row: how many solids, and how many hours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import prod

from app.studies.given import Rows
from app.studies.schemas import MOST_ROWS, StudyIn
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.units.quantity import read_any

NEEDS_SOLIDS = "needs_solids"
HOUR = 3600.0  # s


def counted(error: InvalidInputs, body: StudyIn, rows: Rows | None, seconds: float) -> InvalidInputs:
    """The faults of a study, those about solids with their number; building one takes so long [s]."""
    count = count_of(body, rows)
    if not 0 < count <= MOST_ROWS[body.method]:
        return error
    return InvalidInputs([_counted(fault, count, seconds) for fault in error.faults])


def _counted(fault: Fault, count: int, seconds: float) -> Fault:
    if fault.code != NEEDS_SOLIDS:
        return fault
    hours = f"about {count * seconds / HOUR:.2g} h at {seconds:.2g} s each, as jobs have taken lately"
    words = f"{fault.detail}: {count} rows are up to {count} solids, {hours}"
    return replace(fault, detail=words)


def count_of(body: StudyIn, rows: Rows | None) -> int:
    """How many rows a body asks for, as far as it says so; 0 if it does not."""
    places = len(body.vary)
    match body.method:
        case "grid":
            return prod(_values(body, name) for name in body.vary)
        case "table":
            return _length(rows)
        case "sample":
            return body.points or 0
        case "sensitivity" if body.kind == "morris":
            return (body.points or 20) * (places + 1)
        case "sensitivity" if body.kind == "sobol":
            return (body.points or 1024) * (places + 2)
        case "sensitivity":
            return 2 * places + 1
    return body.points or MOST_ROWS["optimise"]


def _values(body: StudyIn, name: str) -> int:
    """How many values a place takes in a grid."""
    if (values := body.vary[name].values) is not None:
        return len(values)
    steps = body.steps.get(name) if isinstance(body.steps, Mapping) else body.steps
    return max(0, steps or 0)


def _length(rows: Rows | None) -> int:
    if not rows:
        return 0
    if isinstance(rows, Sequence):
        return len(rows)
    try:
        value = read_any(next(iter(rows.values()))).si
    except FaultyText:  # it will be refused when the rest is right
        return 0
    return 1 if isinstance(value, float) else len(value)
