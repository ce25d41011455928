"""Calculate rows in a calculation process: a chunk depends only on the study and the chunk's number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.designs.engine.design_engine import Refusal, Table
from app.reference import Reference
from app.studies.archive import AnyArray, packed
from app.studies.row_solids import SolidRequest, Solids
from app.studies.task import Task, TaskState, prepared
from app.workers.pieces import Pieces
from templates.core.arrays import Array

Levels = Mapping[str, str | None]


@dataclass(frozen=True)
class PendingSolids:
    """The solids that must be built before the rows can be calculated."""

    solids: tuple[SolidRequest, ...]


@dataclass(frozen=True)
class Chunk:
    """Calculated rows: their values as bytes, their number, and the number of refused rows by reason."""

    content: Pieces
    rows: int
    refused: dict[str, int]


def explored(
    task: Task, first: int, last: int, levels: Levels, criteria: tuple[str, ...], solids: Solids = ()
) -> Chunk | PendingSolids:
    """Return the chunk of rows `first` to `last`, excluding `last`, in the order of the method."""
    points = prepared(task).asked.points
    assert points is not None, "a table or an optimisation gives its rows itself"
    return calculated(task, points.rows(first, last), levels, criteria, solids)


def calculated(
    task: Task, rows: Array, levels: Levels, criteria: tuple[str, ...], solids: Solids = ()
) -> Chunk | PendingSolids:
    """Return the chunk of rows given by their values [SI], shape (N, d), or the solids that they need."""
    ready = prepared(task)
    resolved = ready.solids.resolved(placed(ready, rows), len(rows), levels, solids)
    if resolved.wanting:
        return PendingSolids(tuple(resolved.wanting))
    table = called(ready, rows, levels, criteria, measures=resolved.columns)
    table.refusals |= resolved.refusals
    wanted = ready.asked.wanted
    arrays = {**columns_of(task.varied, rows), **results_of(table, wanted)}
    reasons, which = reasons_of(table)
    arrays["reason"], arrays["level"] = which, np.zeros(table.count, dtype=np.int16)
    about = {"reasons": reasons, "levels": [dict(table.levels)]}
    return Chunk(packed(arrays, about), table.count, refused_by_reason(table))


def placed(ready: TaskState, rows: Array) -> dict[Reference, Array]:
    """Return the columns of an array of rows, shape (N, d), each by the place in the design that it sets."""
    return {place: rows[:, column] for column, place in enumerate(ready.asked.places)}


def called(
    ready: TaskState,
    rows: Array,
    levels: Levels | None,
    criteria: tuple[str, ...] | None,
    *,
    measures: Mapping[Reference, Array] | None = None,
    judge: bool = False,
) -> Table:
    """Return the engine's table for some rows, shape (N, d).

    Without `measures`, the solids of all rows have the measurements of the design itself.
    """
    values = {**placed(ready, rows), **(tried(ready, len(rows)) if measures is None else measures)}
    return ready.engine(values, ready.asked.wanted, levels=levels, criteria=criteria, judge=judge)


def tried(ready: TaskState, count: int) -> dict[Reference, Array]:
    """Return the measurements of the design itself for each row of a trial; NaN where unknown."""
    return {r: np.full(count, ready.nominal.get(r, np.nan)) for r in ready.solids.measures}


def columns_of(names: tuple[str, ...], rows: Array) -> dict[str, AnyArray]:
    """Return the values of the varied places as named arrays of a chunk."""
    return {f"place/{name}": rows[:, column] for column, name in enumerate(names)}


def results_of(table: Table, wanted: tuple[Reference, ...]) -> dict[str, AnyArray]:
    """Return outputs, errors and verdicts as named arrays of a chunk."""
    results: dict[str, AnyArray] = {}
    for output in wanted:
        results[f"output/{output}"] = table.columns[output]
        error = table.errors.get(output)
        if error is not None and np.isfinite(error).any():
            results[f"error/{output}"] = error
    for name, codes in table.verdicts.items():
        results[f"verdict/{name}"] = np.broadcast_to(np.asarray(codes, dtype=np.int8), (table.count,))
    return results


def reasons_of(table: Table) -> tuple[list[list[str]], AnyArray]:
    """Return the distinct reasons of refused rows, and for each row the index of its reason.

    The index is -1 for a row with values.
    """
    places: dict[Refusal, int] = {}
    which = np.full(table.count, -1, dtype=np.int32)
    for row, refusal in sorted(table.refusals.items()):
        which[row] = places.setdefault(refusal, len(places))
    return [[refusal.place, refusal.code, refusal.detail] for refusal in places], which


def refused_by_reason(table: Table) -> dict[str, int]:
    """Count the refused rows, by place and code."""
    return dict(Counter(f"{refusal.place}: {refusal.code}" for refusal in table.refusals.values()))
