"""A slice of a search in a calculation process: it repeats the search from the seed with the stored results.

An optimiser requests the same rows in the same order whenever it starts with the same seed. So an interrupted
search starts again and receives the stored results, keyed by the bytes of the rows, until it requests new
rows. Finished generations of NSGA-II are stored as well and not repeated. A slice ends after a number of
estimated seconds, not of measured ones, so that equal studies have equal chunks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.plain import JsonObject
from app.studies.archive import AnyArray, Archive, packed
from app.studies.chunks import Chunk, Levels, called, columns_of, reasons_of, results_of
from app.studies.criteria import JUDGED, SIDES, criterion_of, judged_of
from app.studies.methods.answers import AllRefused, Answer, Columns, Held, Objective, Problem
from app.studies.methods.confirmation import Round
from app.studies.methods.front import Effort, pareto_front
from app.studies.methods.optimise import Optimum, optimise
from app.studies.methods.space import Interval
from app.studies.methods.stages import Stage
from app.studies.row_columns import CONFIRM, EXPLORE, OUTPUT
from app.studies.task import Task, TaskState, prepared
from app.workers.pieces import Pieces
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs

SLICE_SECONDS = 0.5  # estimated time of the new rows of a slice
ALONE = Effort(generations=50, rounds=1)
"""Effort for the front of a single level: enough for a comparison."""
ACTIVE = 2e-3  # relative distance below which an optimum counts as lying on a limit
AT_BOUND = 1e-6  # relative distance, by the width of the interval, that counts as lying on a bound
CALL_SECONDS = 0.03  # fixed time of a call


@dataclass(frozen=True)
class Search:
    """The parameters of a search: its levels, its criteria, and the largest number of rows.

    `levels` holds the levels for exploring and confirming, then levels that are each searched alone once.
    """

    levels: tuple[tuple[tuple[str, str | None], ...], ...]
    criteria: tuple[str, ...]
    required: tuple[str, ...]
    most: int


@dataclass(frozen=True)
class Prediction:
    """The best point of a level, or its front, with predicted and confirmed values [SI]."""

    level: int
    places: tuple[Round, ...]
    rows: int
    seconds: float


@dataclass(frozen=True)
class Outcome:
    """The result of a search: confirmed points, either the best one or those of a front."""

    state: str
    places: tuple[Array, ...]
    trade: tuple[Prediction, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Slice:
    """The new results of a search, and its outcome if it has ended."""

    chunk: Chunk | None
    outcome: Outcome | None


class SearchPause(Exception):
    """Raised if a slice has used its estimated time."""


class TooManyRows(InvalidInputs):
    """Raised if a search needs more rows than it may calculate."""


def searched(task: Task, search: Search, stored: tuple[Pieces, ...]) -> Slice:
    """Repeat a search with its stored results, and continue it for one slice.

    Raises
    ------
    InvalidInputs
        If no row has results, or the search needs more rows than it may calculate.
    """
    ready = prepared(task)
    problem = _problem(ready, search)
    book = _Book(ready, task, search, problem, stored)
    try:
        outcome = _outcome(ready, problem, search, book)
    except SearchPause:
        return Slice(book.chunk(), None)
    return Slice(book.chunk(), outcome)


def _problem(ready: TaskState, search: Search) -> Problem:
    body = ready.asked.body
    objectives = [Objective(name) for name in body.minimise]
    objectives += [Objective(name, "maximise") for name in body.maximise]
    held = tuple(Held(name, criterion_of(ready.engine, name).sign) for name in search.required)
    return Problem(ready.asked.space, tuple(objectives), held)


def _outcome(ready: TaskState, problem: Problem, search: Search, book: _Book) -> Outcome:
    seed, explore, confirm = ready.asked.body.seed, book.answer(EXPLORE), book.answer(CONFIRM)
    if len(problem.objectives) > 1:
        front = pareto_front(problem, explore, confirm, seed=seed, journal=book.journal(EXPLORE))
        first = Prediction(EXPLORE, front.rounds[0], front.explored, front.seconds)
        places = tuple(place.at for place in front.places)
        return Outcome(front.state, places, *_compared(problem, search, book, seed, first, ()))
    optimum = optimise(problem, explore, confirm, seed=seed)
    first = Prediction(EXPLORE, optimum.rounds[:1], optimum.explored, optimum.seconds)
    notes = tuple(f"{v.criterion} is not met by {v.relative:.2%} of its limit" for v in optimum.violations)
    notes = (*_differences(optimum), *notes, *_active(problem, optimum.best))
    return Outcome(optimum.state, (optimum.best.at,), *_compared(problem, search, book, seed, first, notes))


def _differences(optimum: Optimum) -> tuple[str, ...]:
    """Return a sentence that says why a search did not converge; empty if it did."""
    last = optimum.rounds[-1]
    if optimum.state != "not_settled":
        return ()
    if last.reason:
        return (f"the confirming level refuses the best place: {last.reason}",)
    if last.agrees or not np.isfinite(last.confirmed).all():
        return (f"it ended after {len(optimum.rounds)} confirmations",)
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(last.promise - last.confirmed) / np.abs(last.confirmed)
    largest = np.max(apart[np.isfinite(apart)], initial=0.0)
    return (f"predicted and confirmed value differ by {100 * largest:.2g} %",)


def _active(problem: Problem, best: Round) -> tuple[str, ...]:
    """Return the limits and bounds at which an optimum lies, as sentences."""
    count, held = len(problem.objectives), len(problem.held)
    limits = best.confirmed[count + held :]
    near = np.abs(best.worst) <= ACTIVE * np.abs(limits)
    sentences = [
        f"the optimum sits on the limit of {one.name}"
        for one, at in zip(problem.held, near, strict=True)
        if at
    ]
    for one, value in zip(problem.space.variables, best.at.tolist(), strict=True):
        place = float(one.place(np.array(value))) if isinstance(one, Interval) else 0.5
        if min(place, 1 - place) <= AT_BOUND:
            end = "lower" if place < 0.5 else "upper"
            sentences.append(f"the optimum sits on the {end} bound of {one.name}")
    return tuple(sentences)


def _compared(
    problem: Problem, search: Search, book: _Book, seed: int, first: Prediction, notes: tuple[str, ...]
) -> tuple[tuple[Prediction, ...], tuple[str, ...]]:
    """Return the predictions of all levels, and the notes; a note names an incomplete comparison."""
    others: list[Prediction] = []
    try:
        for level in range(CONFIRM + 1, len(search.levels)):
            others += _alone(problem, book, level, seed)
    except TooManyRows:
        detail = f"not every level is compared: a search takes at most {search.most} rows"
        notes = (*notes, detail)
    return (first, *others), notes


def _alone(problem: Problem, book: _Book, level: int, seed: int) -> list[Prediction]:
    """Return the prediction of one level searched alone and confirmed once; empty if it has no result."""
    answer, confirm = book.answer(level), book.answer(CONFIRM)
    try:
        if len(problem.objectives) > 1:
            front = pareto_front(
                problem, answer, confirm, seed=seed, effort=ALONE, journal=book.journal(level)
            )
            return [Prediction(level, front.rounds[0], front.explored, front.seconds)]
        optimum = optimise(problem, answer, confirm, seed=seed, rounds=1)
    except AllRefused:
        return []
    return [Prediction(level, optimum.rounds[:1], optimum.explored, optimum.seconds)]


@dataclass(frozen=True)
class _Call:
    """One call of a search, as stored in a chunk: its level, its rows, and their results."""

    level: int
    arrays: Mapping[str, AnyArray]
    reasons: list[list[str]]
    seconds: float

    @property
    def count(self) -> int:
        return len(self.arrays["reason"])


@dataclass(frozen=True)
class _Journal:
    """The stages of one level, stored with those of all levels."""

    level: int
    stages: dict[str, Stage]
    changed: set[str]

    def stored(self, name: str) -> Stage | None:
        """Return the latest stored state of the stage with this name, or None."""
        return self.stages.get(f"{self.level}: {name}")

    def keep(self, name: str, stage: Stage) -> None:
        """Store the present state of a stage for the next chunk."""
        self.stages[f"{self.level}: {name}"] = stage
        self.changed.add(f"{self.level}: {name}")


class _Book:
    """All results of a search by level and by the bytes of the rows, and all stages."""

    def __init__(
        self, ready: TaskState, task: Task, search: Search, problem: Problem, stored: Sequence[Pieces]
    ) -> None:
        self._ready, self._task, self._search, self._problem = ready, task, search, problem
        self._levels: list[Levels] = [dict(pairs) for pairs in search.levels]
        self._answers: dict[tuple[int, bytes], Columns] = {}
        self._new: list[_Call] = []
        self._rows, self._spent = 0, 0.0
        self._stages, self._changed = dict[str, Stage](), set[str]()
        for pieces in stored:
            calls, stages = _read(pieces)
            self._stages |= stages
            for call in calls:
                self._remember(call)

    def journal(self, level: int) -> _Journal:
        """Return the stages of the search at a level."""
        return _Journal(level, self._stages, self._changed)

    def answer(self, level: int) -> Answer:
        """Return a function that returns results at a level, stored or newly calculated."""
        same = next(n for n, levels in enumerate(self._levels) if levels == self._levels[level])

        def answered(rows: Array) -> Columns:
            rows = np.ascontiguousarray(rows)
            key = same, rows.tobytes()
            if key not in self._answers:
                self._remember(self._calculated(same, rows))
            return self._answers[key]

        return answered

    def chunk(self) -> Chunk | None:
        """Return the new results as a chunk; None if there are none."""
        if not self._new:
            return None
        names = sorted({name for call in self._new for name in call.arrays})
        arrays = {name: np.concatenate([_array(call, name) for call in self._new]) for name in names}
        reasons, shift = list[list[str]](), list[AnyArray]()
        for call in self._new:
            which = call.arrays["reason"].astype(np.int32)
            shift.append(np.where(which >= 0, which + len(reasons), which).astype(np.int32))
            reasons += call.reasons
        arrays["reason"] = np.concatenate(shift)
        calls = [[call.level, call.count, call.seconds] for call in self._new]
        about: JsonObject = {"reasons": reasons, "levels": self._levels, "calls": calls}
        if self._changed:
            about["stages"] = {name: _plain(self._stages[name]) for name in sorted(self._changed)}
        refused: dict[str, int] = {}
        for which in arrays["reason"][arrays["reason"] >= 0].tolist():
            name = ": ".join(reasons[which][:2])
            refused[name] = refused.get(name, 0) + 1
        return Chunk(packed(arrays, about), len(arrays["reason"]), refused)

    def _calculated(self, level: int, rows: Array) -> _Call:
        """Calculate new rows at a level.

        Raises
        ------
        SearchPause
            If the slice has used its estimated time.
        TooManyRows
            If the search would exceed its number of rows.
        """
        if self._spent >= SLICE_SECONDS:
            raise SearchPause
        if self._rows + len(rows) > self._search.most:
            detail = (
                f"the search needs more than {self._search.most} rows; narrow the bounds, or raise `points`"
            )
            raise TooManyRows([Fault("points", "too_many_rows", detail)])
        engine, asked = self._ready.engine, self._ready.asked
        levels = self._levels[level]
        criteria = self._search.criteria  # from cost tables, because measured times differ from run to run
        seconds = engine.seconds(len(rows), asked.wanted, levels, criteria=criteria, by_tables=True)
        self._spent += seconds + CALL_SECONDS
        table = called(self._ready, rows, levels, criteria, judge=True)
        arrays = {**columns_of(self._task.varied, rows), **results_of(table, asked.wanted)}
        for name in self._search.required:
            arrays |= judged_of(engine, name, table)
        reasons, arrays["reason"] = reasons_of(table)
        arrays["level"] = np.full(len(rows), level, dtype=np.int16)
        call = _Call(level, arrays, reasons, seconds)
        self._new.append(call)
        return call

    def _remember(self, call: _Call) -> None:
        rows = np.stack([call.arrays[f"place/{name}"] for name in self._task.varied], axis=-1)
        self._answers[call.level, np.ascontiguousarray(rows).tobytes()] = self._columns(call)
        self._rows += call.count

    def _columns(self, call: _Call) -> Columns:
        def side(name: str) -> Array:
            parts = [call.arrays[f"{JUDGED}{one.name}/{name}"] for one in self._problem.held]
            return np.stack(parts, axis=-1).astype(float) if parts else np.empty((call.count, 0))

        objectives = [
            np.asarray(call.arrays[f"{OUTPUT}{one.name}"], np.float64) for one in self._problem.objectives
        ]
        which = call.arrays["reason"].tolist()
        reasons = {n: call.reasons[place][2] for n, place in enumerate(which) if place >= 0}
        value, limit, low, high, is_known = (side(name) for name in SIDES)
        both = np.stack(objectives, axis=-1)
        return Columns(both, value, limit, low, high, reasons, call.seconds, is_known=is_known == 1)


def _array(call: _Call, name: str) -> AnyArray:
    """Return one array of a call, or NaN if the call lacks it, as when its level does not state the error."""
    return call.arrays[name] if name in call.arrays else np.full(call.count, np.nan)


def _read(pieces: Pieces) -> tuple[list[_Call], dict[str, Stage]]:
    """Return the calls stored in a chunk, in order, and the stages at its end."""
    with Archive(pieces.joined()) as archive:
        arrays, about = {name: archive[name] for name in archive.names}, archive.about()
    calls, start = [], 0
    for level, count, seconds in about["calls"]:
        part = {name: array[start : start + count] for name, array in arrays.items()}
        calls.append(_Call(level, part, about["reasons"], seconds))
        start += count
    return calls, {name: _stage(plain) for name, plain in about.get("stages", {}).items()}


def _plain(stage: Stage) -> JsonObject:
    """Return a stage as JSON; numbers keep all their digits."""
    return {**vars(stage), "arrays": [array.tolist() for array in stage.arrays]}


def _stage(plain: JsonObject) -> Stage:
    arrays = tuple(np.array(array, dtype=np.float64) for array in plain["arrays"])
    return Stage(plain["done"], arrays, plain["rows"], plain["seconds"])
