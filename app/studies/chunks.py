"""Rows calculated in a calculation process: a chunk is a pure function of the study and its number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.designs.net import Net, Refusal, Table
from app.designs.reference import Reference
from app.studies.archive import AnyArray, packed
from app.studies.task import Task, prepared
from app.workers.pieces import Pieces
from templates.core.arrays import Array

Levels = Mapping[str, str | None]


@dataclass(frozen=True)
class Chunk:
    """Rows that were calculated: their values as bytes, their number, and how many refused, by reason."""

    content: Pieces
    rows: int
    refused: dict[str, int]


def explored(task: Task, first: int, last: int, levels: Levels, criteria: tuple[str, ...]) -> Chunk:
    """Rows number `first` to `last`, the last one excluded, as the method has them."""
    points = prepared(task).asked.points
    assert points is not None, "a table or an optimisation gives its rows itself"
    return calculated(task, points.rows(first, last), levels, criteria)


def calculated(task: Task, rows: Array, levels: Levels, criteria: tuple[str, ...]) -> Chunk:
    """Rows given by their values [SI], shape (N, d)."""
    ready = prepared(task)
    table = called(ready.net, ready.asked.places, rows, ready.asked.wanted, levels, criteria)
    arrays = {**columns_of(task.varied, rows), **results_of(table, ready.asked.wanted)}
    reasons, which = reasons_of(table)
    arrays["reason"], arrays["level"] = which, np.zeros(table.count, dtype=np.int16)
    about = {"reasons": reasons, "levels": [dict(table.levels)]}
    return Chunk(packed(arrays, about), table.count, refused_by_reason(table))


def called(
    net: Net,
    places: tuple[Reference, ...],
    rows: Array,
    wanted: tuple[Reference, ...],
    levels: Levels | None,
    criteria: tuple[str, ...] | None,
    *,
    judge: bool = False,
) -> Table:
    """The table of some rows, shape (N, d)."""
    values = {place: rows[:, column] for column, place in enumerate(places)}
    return net(values, wanted, levels=levels, criteria=criteria, judge=judge)


def columns_of(names: tuple[str, ...], rows: Array) -> dict[str, AnyArray]:
    """The values of the places, as a chunk keeps them."""
    return {f"place/{name}": rows[:, column] for column, name in enumerate(names)}


def results_of(table: Table, wanted: tuple[Reference, ...]) -> dict[str, AnyArray]:
    """The values of the outputs, their errors and the verdicts, as a chunk keeps them."""
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
    """Distinct reasons of refused rows, and the place of each row's in that list; -1 where it has values."""
    places: dict[Refusal, int] = {}
    which = np.full(table.count, -1, dtype=np.int32)
    for row, refusal in sorted(table.refusals.items()):
        which[row] = places.setdefault(refusal, len(places))
    return [[refusal.place, refusal.code, refusal.detail] for refusal in places], which


def refused_by_reason(table: Table) -> dict[str, int]:
    """How many rows were refused, by place and code."""
    return dict(Counter(f"{refusal.place}: {refusal.code}" for refusal in table.refusals.values()))
