"""Estimate the processor time of a study from a few rows, which are calculated before it is accepted.

The cost tables of levels include neither criteria nor a heat balance. The chunk size still comes from these
tables, because a measured size would differ between equal studies.
"""

from __future__ import annotations

import time
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from app.studies.chunks import Levels, called
from app.studies.front import MOST_CONFIRMED, MOST_FRONT
from app.studies.task import TaskState
from templates.core.arrays import Array

FEW, MANY = 8, 1024  # numbers of rows in the two timed calls
AFFORDABLE = 0.5  # largest time of the call with many rows [s]
SCANNED, CALLS = 4096, 100  # number of rows in the scan of a search, and of calls with few rows after it
GENERATIONS, POPULATION = (
    500,
    100,
)  # number of calls in all rounds of a search for several objectives; rows of each call
IN_CALL = 4096  # largest number of rows in a call


@dataclass(frozen=True)
class Pace:
    """The fixed processor time of a call, and the processor time of each row [s]."""

    call: float
    row: float

    def seconds(self, rows: int, calls: int = 0) -> float:
        """Return the time of some rows in a number of calls, by default as few calls as possible [s]."""
        return self.row * rows + self.call * (calls or -(-rows // IN_CALL))


def estimated(
    ready: TaskState,
    probe: Array,
    count: int,
    criteria: Collection[str],
    levels: Levels,
    confirm: Levels | None,
    chunk: int,
) -> float:
    """Return the processor time [s] of a study with this number of rows, in chunks of a given size."""
    body, names = ready.asked.body, tuple(criteria)
    pace = paced(ready, probe, names, levels)
    again = paced(ready, probe, names, confirm) if confirm is not None else pace
    several = len(ready.asked.objectives) > 1
    if body.method == "optimise":
        calls, each = (GENERATIONS, POPULATION) if several else (CALLS, FEW)
        rows = min(count, SCANNED + calls * each)
        return pace.seconds(rows, 1 + calls) + again.seconds(MOST_CONFIRMED)
    most = MOST_FRONT if several else MOST_CONFIRMED
    repeated = most if confirm is not None and ready.asked.objectives else 0
    return pace.seconds(count, -(-count // chunk)) + again.seconds(min(count, repeated))


def paced(ready: TaskState, probe: Array, criteria: tuple[str, ...], levels: Levels) -> Pace:
    """Return the pace at some levels, measured by two calls: a few rows, then as many as are affordable."""
    few, many = probe[:FEW], np.resize(probe, (MANY, probe.shape[1]))
    timed(ready, few[:1], criteria, levels)  # warm up, so that loading of modules is not timed
    first = timed(ready, few, criteria, levels)
    if first > AFFORDABLE:
        return Pace(0.0, first / len(few))
    size = max(2 * len(few), min(MANY, int(AFFORDABLE * len(few) / max(first, 1e-9))))
    row = max(0.0, timed(ready, many[:size], criteria, levels) - first) / (size - len(few))
    return Pace(max(0.0, first - row * len(few)), row)


def timed(ready: TaskState, rows: Array, criteria: tuple[str, ...], levels: Levels) -> float:
    """Return the processor time of a call [s]."""
    begun = time.thread_time()
    called(ready, rows, levels, criteria)
    return time.thread_time() - begun
