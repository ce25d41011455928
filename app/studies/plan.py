"""Plan a study before it begins, in a calculation process: levels, chunk size, units, estimate."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass, field
from typing import Self

import numpy as np

from app.designs.document import Document
from app.designs.engine.design_engine import Table
from app.designs.result_table import headings
from app.plain import JsonObject
from app.presentation.criteria import subject_of
from app.reference import Reference
from app.studies.bodies import MOST_BUILT, MOST_ROWS
from app.studies.chunks import Levels, called, placed
from app.studies.criteria import criterion_of
from app.studies.estimate import estimated
from app.studies.question import StudyQuestion
from app.studies.relations import relations_at
from app.studies.row_table import Rows, given_rows
from app.studies.solid_count import counted
from app.studies.task import Task, TaskState, prepared
from templates.core.arrays import Array
from templates.core.criteria.comparison import NOT_CHECKED
from templates.core.errors import Fault, InvalidInputs, unknown_names

CHUNK_SECONDS = 0.5  # estimated time of a chunk: a cancellation or a crash loses less than a second
MOST_IN_CHUNK, STEP_OF_CHUNK = 8192, 4096
MOST_CHUNKS = 10**6
MOST_COMPARED = 3  # number of levels cheaper than that of the exploration; each is searched once
TRIED = 8  # number of rows that are calculated before the study is accepted
PROBED = 64  # number of rows from which levels are chosen
SHARE = 0.95  # share of the rows in which a level must be within the tolerance


@dataclass(frozen=True)
class Plan:
    """The fixed part of a study, stored in its row."""

    places: list[str]
    outputs: list[str]
    criteria: list[str]  # criteria that are judged
    required: list[str]  # criteria that a row must meet
    units: dict[str, str]
    levels: dict[str, str | None]
    confirm: dict[str, str | None] | None
    rows: int
    chunk: int
    confirm_chunk: int
    searched: list[
        dict[str, str | None]
    ]  # levels of an optimisation: explore, confirm, then those to compare
    seconds: float
    measured: dict[str, float]  # known measurements of solids [SI]
    solids: int = 0  # largest number of solids that the rows need
    solid_seconds: float = 0.0  # time to build a solid [s]; 0 in plans of older studies
    set_aside: dict[str, str] = field(default_factory=dict)  # replaced relations, by place
    words: dict[str, str] = field(default_factory=dict)  # headings of names and criteria; empty if older

    def share(self, rows: int, solids: int) -> float:
        """Return the progress, from 0 to 1, after some rows and solids, weighted by their estimated times."""
        building = min(1.0, self.solids * self.solid_seconds / self.seconds) if self.solids else 0.0
        done = building * min(1.0, solids / self.solids) if self.solids else 0.0
        return min(1.0, done + (1.0 - building) * rows / max(1, self.rows))

    @property
    def estimate(self) -> float | None:
        """Return the estimated time of all rows [s]; None for a search, and if solids have to be built."""
        return None if self.searched or self.solids else self.seconds

    @property
    def chunks(self) -> int:
        """Return the number of chunks of the exploration; chunks of the confirmation follow them.

        An optimisation has no such number.
        """
        return MOST_CHUNKS if self.searched else -(-self.rows // self.chunk)

    def plain(self) -> JsonObject:
        """Return the plan as JSON."""
        return asdict(self)

    @classmethod
    def of(cls, plain: JsonObject) -> Self:
        """Return the plan from its JSON form."""
        return cls(**plain)


def planned(task: Task, rows: Rows | None, solid_seconds: float) -> tuple[Plan, Array | None]:
    """Return the plan of a study, and the values [SI] of the given rows if the method is `table`.

    `solid_seconds` is the time to build one solid [s], for rows that need solids.

    Raises
    ------
    InvalidInputs
        If there are faults, such as unknown places, wrong units or bounds, too many rows or too many solids.
        The error lists all of them.
    """
    ready = prepared(task)
    body, given = ready.asked.body, None
    if body.method == "table":
        given = given_rows(rows or {}, ready.engine)
    count = _count(ready.asked, given)
    _check_built(ready.asked, count)
    probe = _probe(ready.asked, count, given)
    criteria = _judged(body.hold, ready.engine.criteria())
    few = probe[:TRIED]
    first = called(ready, few, None, tuple(criteria))
    behind = ready.solids.resolved(placed(ready, few), len(few), None, ()).levels
    _refuse_curves(first.columns, ready.asked.wanted)
    required = criteria if body.hold is not None else _checked(criteria, first, task)
    levels: dict[str, str | None] = {**behind, **first.levels}
    needed = counted(ready, count, given, levels)
    if body.explore is not None:
        levels |= _levels(ready, probe, criteria, body.explore.tolerance, SHARE)
    confirm = None
    if body.confirm is not None:
        confirm = {**levels, **_levels(ready, probe, criteria, body.confirm.tolerance, 1.0)}
    names = [*task.varied, *map(str, ready.asked.wanted)]
    limits = {name: criterion_of(ready.engine, name).unit for name in criteria}
    chunk = min(count, _chunk(ready, criteria, levels))
    plan = Plan(
        places=list(task.varied),
        outputs=[str(output) for output in ready.asked.wanted],
        criteria=criteria,
        required=required,
        units={name: ready.engine.unit(Reference.parse(name)) for name in names} | limits,
        levels=levels,
        confirm=confirm,
        rows=count,
        chunk=chunk,
        confirm_chunk=_chunk(ready, criteria, confirm or levels),
        searched=_searched(ready, levels, confirm),
        seconds=estimated(ready, probe, count, criteria, levels, confirm, chunk)
        + needed.solids * solid_seconds,
        measured=dict(task.measured),
        solids=needed.solids,
        solid_seconds=solid_seconds if needed.solids else 0.0,
        set_aside=relations_at(Document.model_validate_json(task.design.document), body.set_aside),
        words=headings(names, ready.engine.graph) | _criteria_in_words(ready, criteria),
    )
    return plan, given


def _criteria_in_words(ready: TaskState, criteria: Sequence[str]) -> dict[str, str]:
    return {name: subject_of(name, criterion_of(ready.engine, name).require) for name in criteria}


def _count(asked: StudyQuestion, given: Array | None) -> int:
    if given is not None:
        return len(given)
    return asked.points.count if asked.points else asked.body.points or MOST_ROWS["optimise"]


def _probe(asked: StudyQuestion, count: int, given: Array | None) -> Array:
    """Return a sample of the study's rows."""
    if asked.points is None and given is None:
        return asked.space.at(_lattice(len(asked.space)))
    numbers = np.unique(np.linspace(0, count - 1, min(count, PROBED)).astype(int)).tolist()
    if given is not None:
        chosen: Array = given[numbers]
        return chosen
    assert asked.points is not None
    return np.concatenate([asked.points.rows(n, n + 1) for n in numbers])


def _lattice(dimensions: int) -> Array:
    """Return evenly spread points of the unit cube (Kronecker's lattice), beginning with the middle."""
    steps = np.sqrt(np.arange(2, 2 + dimensions))
    return np.asarray((0.5 + np.outer(np.arange(PROBED), steps)) % 1.0)


def _levels(
    ready: TaskState, rows: Array, criteria: Collection[str], tolerance: float, share: float
) -> dict[str, str | None]:
    values = {place: rows[:, column] for column, place in enumerate(ready.asked.places)}
    return ready.engine.levels_for(values, ready.asked.wanted, tolerance, share, criteria=criteria)


def _chunk(ready: TaskState, criteria: Collection[str], levels: Levels) -> int:
    """Return the number of rows in a chunk: half a second of calculation, in multiples of `STEP_OF_CHUNK`."""
    wanted = ready.asked.wanted  # from cost tables, so that equal studies have equal chunks
    seconds = ready.engine.seconds(STEP_OF_CHUNK, wanted, levels, criteria=criteria, by_tables=True)
    per_row = seconds / STEP_OF_CHUNK
    fitting = max(1, min(MOST_IN_CHUNK, int(CHUNK_SECONDS / max(per_row, 1e-9))))
    return fitting // STEP_OF_CHUNK * STEP_OF_CHUNK or fitting


def _searched(
    ready: TaskState, levels: dict[str, str | None], confirm: dict[str, str | None] | None
) -> list[dict[str, str | None]]:
    """Return the levels at which an optimisation searches: explore, confirm, then cheaper ones to compare."""
    if ready.asked.points is not None or ready.asked.body.method != "optimise":
        return []
    searched = [levels, confirm or levels]
    for step in levels if confirm else ():
        ladder = ready.engine.graph.blocks[step].cls.levels
        cheaper = ladder[: ladder.index(levels[step])] if levels[step] in ladder else ()
        searched += [{**levels, step: level} for level in cheaper]
    return searched[: 2 + MOST_COMPARED]


def _judged(hold: Sequence[str] | None, names: Collection[str]) -> list[str]:
    """Return the criteria to judge: the named ones, else all of the design."""
    if hold is None:
        return sorted(names)
    if unknown := [name for name in hold if name not in names]:
        raise InvalidInputs(f.within("hold") for f in unknown_names(unknown, names, "criterion"))
    return list(dict.fromkeys(hold))


def _checked(criteria: Sequence[str], tried: Table, task: Task) -> list[str]:
    """Return the criteria that count: not waived, and checked in at least one trial row.

    The other criteria have no limits, so that no row could meet them.
    """
    waived = {n for n, c in Document.model_validate_json(task.design.document).criteria.items() if c.waived}
    there = np.isin(np.arange(tried.count), list(tried.refusals), invert=True)
    codes = {name: np.broadcast_to(tried.verdicts[name], (tried.count,))[there] for name in criteria}
    open_ones = {name for name, code in codes.items() if code.size and (code == NOT_CHECKED).all()}
    return [name for name in criteria if name not in waived | open_ones]


def _refuse_curves(columns: dict[Reference, Array], wanted: Sequence[Reference]) -> None:
    curves = [output for output in wanted if columns[output].ndim > 1]
    if curves:
        detail = "is a curve; a study stores one number for each row, such as its least or greatest value"
        raise InvalidInputs(Fault(f"outputs.{curve}", "shape", f"{curve} {detail}") for curve in curves)


def _check_built(asked: StudyQuestion, count: int) -> None:
    build = asked.body.build
    if build in ("best", "front") and not asked.objectives:
        raise InvalidInputs([Fault("build", "missing", "name an output to minimise or maximise")])
    if build == "all" and count > MOST_BUILT:
        detail = f"at most {MOST_BUILT} rows become variants, not {count}; name some by their numbers"
        raise InvalidInputs([Fault("build", "too_many_rows", detail)])
    if isinstance(build, list) and max(build) >= count:
        raise InvalidInputs([Fault("build", "unknown_row", f"rows are numbered from 0 to {count - 1}")])
