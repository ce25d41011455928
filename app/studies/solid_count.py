"""Count the solids of a study before it begins, and refuse too many."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.designs.engine.needs import solids_in_the_way
from app.designs.network import Block
from app.studies.chunks import Levels, placed
from app.studies.task import TaskState
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs

NEEDS_SOLIDS = "needs_solids"
MOST_SOLIDS, MOST_ANALYSED = 500, 100
"""Largest number of solids that a study builds, and that it analyses by finite elements."""
AT_ONCE = 65_536  # number of rows that are compared at a time
MOST_COMPARED = 20_000  # distinct sets of values; if there are more, all rows count as different
MOST_TRIED = 4096  # largest number of distinct sets of values for an exact count of solids
AFFORDABLE = 1.0  # largest estimated time for the parameters of these solids [s]
SEARCHES = "a search finds its rows one after another; sample these places first"


@dataclass(frozen=True)
class SolidCount:
    """The largest number of solids that a study needs, and of those that it analyses."""

    solids: int = 0
    analysed: int = 0


def counted(ready: TaskState, count: int, given: Array | None, levels: Levels) -> SolidCount:
    """Return the number of solids that the rows of a study need.

    Raises
    ------
    InvalidInputs
        If there are too many, or if a search would need solids; the code is `needs_solids`.
    """
    solids, points = ready.solids, ready.asked.points
    if not solids.measures:
        return SolidCount()
    if points is None and given is None:
        raise InvalidInputs(_refused(ready, count, count, SEARCHES))
    several = {model.name: _of_model(ready, model, count, given, levels) for model in solids.models}
    needed = SolidCount(sum(several.values()), sum(several[name] for name in solids.analysed))
    if needed.solids > MOST_SOLIDS:
        why = f"a study builds at most {MOST_SOLIDS}"
        raise InvalidInputs(_refused(ready, count, needed.solids, why))
    if needed.analysed > MOST_ANALYSED:
        why = f"a study analyses at most {MOST_ANALYSED} by finite elements"
        raise InvalidInputs(_refused(ready, count, needed.analysed, why))
    return needed


def _refused(ready: TaskState, rows: int, solids: int, why: str) -> Iterator[Fault]:
    """Yield a fault for each measurement, with the chain of names from the varied places."""
    graph, measures = ready.engine.graph, ready.solids.measures
    for fault in solids_in_the_way(graph, measures, ready.engine.design.moving):
        yield replace(fault, detail=f"{fault.detail}: {rows} rows need up to {solids} solids; {why}")


def _of_model(ready: TaskState, model: Block, count: int, given: Array | None, levels: Levels) -> int:
    """Return the number of solids of a model; an upper limit if it depends on solids that are not built."""
    places = [ready.asked.places.index(place) for place in ready.solids.drivers(model)]
    chosen = _distinct(ready, places, count, given)
    if len(chosen) > MOST_COMPARED:
        return count
    if len(chosen) > MOST_TRIED or not _is_affordable(ready, model, len(chosen), levels):
        return len(chosen)
    wanting = ready.solids.resolved(placed(ready, chosen), len(chosen), levels, ()).wanting
    own = {solid.texts for solid in wanting if solid.model == model.name}
    return (
        len(own) if own or not wanting else len(chosen)
    )  # otherwise the parameters depend on solids that are not built


def _is_affordable(ready: TaskState, model: Block, count: int, levels: Levels) -> bool:
    references = [cell.reference for cell in model.cells.values()]
    return ready.engine.seconds(count, references, levels, by_tables=True) <= AFFORDABLE


def _distinct(ready: TaskState, places: Sequence[int], count: int, given: Array | None) -> Array:
    """Return the first row of each distinct set of values of some places.

    If there are more than `MOST_COMPARED`, the list is incomplete.
    """
    chosen: Array = np.empty((0, len(ready.asked.places)))
    for first in range(0, count, AT_ONCE):
        last = min(first + AT_ONCE, count)
        if given is not None:
            part = given[first:last]
        else:
            assert ready.asked.points is not None, "a search is refused before"
            part = ready.asked.points.rows(first, last)
        whole = np.concatenate([chosen, part])
        if not places:
            return whole[:1]
        chosen = whole[np.sort(np.unique(whole[:, places], axis=0, return_index=True)[1])]
        if len(chosen) > MOST_COMPARED:
            break
    return chosen
