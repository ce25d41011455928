"""Count the solids of a study before it begins; refuse too many solids."""

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
"""Solids that are built for a study; solids that are analysed by finite elements for it."""
AT_ONCE = 65_536  # rows that are compared with those before
MOST_COMPARED = 20_000  # distinct sets of values; if there are more, all rows are said to differ
MOST_TRIED = 4096  # distinct sets of values from which solids are counted exactly
AFFORDABLE = 1.0  # estimated, for the parameters of these solids [s]
SEARCHES = "a search asks for its rows one after another; sample these places first"


@dataclass(frozen=True)
class SolidCount:
    """Number of solids that a study needs at most, and of those that finite elements analyse."""

    solids: int = 0
    analysed: int = 0


def counted(ready: TaskState, count: int, given: Array | None, levels: Levels) -> SolidCount:
    """Return the solids that the rows of a study need.

    Raises
    ------
    InvalidInputs
        With code `needs_solids`, if there are too many, or if a search would ask for them.
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
    """Yield a fault for each measure, which names the chain from what varies."""
    graph, measures = ready.engine.graph, ready.solids.measures
    for fault in solids_in_the_way(graph, measures, ready.engine.design.moving):
        yield replace(fault, detail=f"{fault.detail}: {rows} rows are up to {solids} solids; {why}")


def _of_model(ready: TaskState, model: Block, count: int, given: Array | None, levels: Levels) -> int:
    """Number of solids of a model; at most, if it is not known before other solids are built."""
    places = [ready.asked.places.index(place) for place in ready.solids.drivers(model)]
    chosen = _distinct(ready, places, count, given)
    if len(chosen) > MOST_COMPARED:
        return count
    if len(chosen) > MOST_TRIED or not _is_affordable(ready, model, len(chosen), levels):
        return len(chosen)
    wanting = ready.solids.resolved(placed(ready, chosen), len(chosen), levels, ()).wanting
    own = {solid.texts for solid in wanting if solid.model == model.name}
    return len(own) if own or not wanting else len(chosen)  # else it follows from solids that are not built


def _is_affordable(ready: TaskState, model: Block, count: int, levels: Levels) -> bool:
    references = [cell.reference for cell in model.cells.values()]
    return ready.engine.seconds(count, references, levels, by_tables=True) <= AFFORDABLE


def _distinct(ready: TaskState, places: Sequence[int], count: int, given: Array | None) -> Array:
    """Return the first row of each distinct set of values of some places; not all, if there are too many."""
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
