"""Which rows meet the criteria of a design, at the least cost: only undecided rows climb to finer levels.

All rows begin at the cheapest levels of the truth that the finest level has (`core.language.levels`). In each
round one step climbs, the one whose next level takes away most of the error for its cost, in the rows that
are still undecided. It ends when all is decided, when no level states a smaller error, or when the budget is
spent. Rows that have no value so far climb too, but not to levels that take few points at once: what a
cheaper level cannot calculate is rarely worth it.
"""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.calculations.cost import array_seconds
from app.designs.deciding import Stop
from app.designs.net import Net
from app.designs.network import Block
from app.designs.row_design import Levels, Rows, Wanted
from app.designs.row_judging import JudgedColumn, RowCodes, RowJudging
from app.designs.row_pass import RowPass
from app.designs.step_rows import StepRows
from app.designs.subjects import Subject
from templates.core.arrays import Array, Mask
from templates.core.judging.comparison import NOT_CHECKED, UNDECIDED
from templates.core.language.levels import accuracy

LARGEST = 1e6  # error that counts when gains are compared


@dataclass(frozen=True, slots=True)
class RowTrial:
    """One round: at which levels how many rows were judged, how many that decided, and the time taken [s]."""

    levels: Mapping[str, str | None]
    rows: int
    decided: int
    seconds: float


@dataclass
class DecidedRows:
    """The verdicts of all rows.

    Attributes
    ----------
    verdicts, judged
        As in a `Table`; each row at the last level that helped it.
    levels
        By step, the level of each row.
    trials
        What was spent, in order.
    skipped
        Levels of steps that were left out, and why.
    """

    count: int
    verdicts: dict[str, RowCodes]
    judged: dict[str, JudgedColumn]
    levels: dict[str, NDArray[np.object_]]
    trials: list[RowTrial] = field(default_factory=list)
    skipped: dict[tuple[str, str], str] = field(default_factory=dict)
    stopped: Stop = "no_finer_level"

    def undecided(self) -> Mask:
        """The rows in which a criterion is undecided."""
        open_rows = np.zeros(self.count, dtype=bool)
        for codes in self.verdicts.values():
            open_rows |= codes == UNDECIDED
        return open_rows


def decide_rows(
    net: Net,
    rows: Rows,
    criteria: Collection[str],
    *,
    levels: Levels | None = None,
    budget: float = float("inf"),
) -> DecidedRows:
    """The verdicts of some criteria of a design for all rows.

    Parameters
    ----------
    net
        The design.
    rows
        A column for every varied place.
    criteria
        The criteria that are decided.
    levels
        With which to begin, by step; the cheapest of the finest level's truth, where none is given.
    budget
        After which no further round begins [s].

    Raises
    ------
    InvalidInputs
        If columns, criteria or levels are wrong.
    """
    judged = net.subjects(criteria)
    count, given = net.checked(rows, levels or {})
    with np.errstate(all="ignore"):
        return _Climb(net, given, count, judged).decided(levels or {}, budget)


@dataclass
class _Climb:
    """Rows that climb, and what is known of each so far."""

    net: Net
    rows: Rows
    count: int
    subjects: Mapping[str, Subject]
    at: dict[str, str | None] = field(default_factory=dict)
    ladders: dict[str, tuple[str, ...]] = field(default_factory=dict)
    expected: dict[tuple[str, str], Array] = field(default_factory=dict)
    """By step and level, the error that is stated where the rows lie now; infinite, where none is."""

    def __post_init__(self) -> None:
        self.asked = Wanted.of((), self.subjects.values())
        self.steps = [step for step in self.net.design.steps(self.asked) if step.cls.levels]
        self.valueless: Mask = np.ones(self.count, dtype=bool)
        codes = {name: np.full(self.count, NOT_CHECKED, dtype=np.int8) for name in self.subjects}
        none = {step.name: np.full(self.count, None, dtype=object) for step in self.steps}
        self.result = DecidedRows(self.count, codes, {}, none)

    def decided(self, levels: Levels, budget: float) -> DecidedRows:
        """Climb until there is nothing more to do."""
        start = time.perf_counter()
        self._begin(levels)
        due = np.arange(self.count)
        while due.size:
            self._judge(due)
            if time.perf_counter() - start >= budget:
                self.result.stopped = "budget"
                break
            due = self._climbed()
        if not self.result.undecided().any():
            self.result.stopped = "decided"
        return self.result

    def _begin(self, levels: Levels) -> None:
        """The levels that answer the design as it was written, and that with which to begin."""
        cheapest = {step.name: step.cls.levels[0] for step in self.steps}
        written = self.net.written.nominal(self.asked, cheapest)
        for step in self.steps:
            ladder = self._of_one_truth(step, _ladder(written, step))
            self.ladders[step.name] = ladder
            self.at[step.name] = levels.get(step.name) or ladder[0]

    def _of_one_truth(self, step: Block, ladder: tuple[str, ...]) -> tuple[str, ...]:
        """The levels whose errors were measured against the same truth as those of the finest one."""
        measured, outputs = accuracy(step.cls), self._outputs(step)
        if measured is None or not outputs:
            return ladder
        kept = []
        for level in ladder:
            other = next(
                (o for o in outputs if measured.truth(level, o) != measured.truth(ladder[-1], o)), None
            )
            if other is None:
                kept.append(level)
            else:
                reason = f"its error of {other} was measured against another truth"
                self.result.skipped[step.name, level] = reason
        return tuple(kept)

    def _outputs(self, step: Block) -> list[str]:
        """The outputs of a step that are used and in which a level has a say."""
        used = self.net.design.needs(self.asked).outputs(step)
        return [n for n in used if "level" in step.cls.ancestors(step.cls.formulas[n].attribute)]

    def _left(self) -> Mask:
        """The rows that a finer level may decide."""
        return self.result.undecided() | self.valueless

    def _judge(self, due: NDArray[np.intp]) -> None:
        """Judge some rows at the present levels, and keep what is better than before."""
        start = time.perf_counter()
        columns = {place: column[due] for place, column in self.rows.items()}
        for first, part in self.net.design.passes(columns, due.size, self.asked, self.at):
            if self._has_moved(part):
                self._judge(due)
                return
            self._take(due[first : first + part.count], part)
        decided, seconds = int((~self._left()[due]).sum()), time.perf_counter() - start
        self.result.trials.append(RowTrial(dict(self.at), int(due.size), decided, seconds))

    def _has_moved(self, part: RowPass) -> bool:
        """Return whether rows ask for a finer level than those before, which then serves all of them."""
        for step in self.steps:
            allowed, here = _ladder(part, step), self.at[step.name] or step.cls.default_level
            if here in allowed:
                continue
            ladder = self._of_one_truth(step, allowed)
            if step.cls.levels.index(ladder[0]) > step.cls.levels.index(here):
                self.ladders[step.name], self.at[step.name] = ladder, ladder[0]
                return True
        return False

    def _take(self, rows: NDArray[np.intp], part: RowPass) -> None:
        """Take over the verdicts of a chunk where they are decided, or nearer to it."""
        judging = RowJudging(part)
        valued = self._valued(part)
        for name, subject in self.subjects.items():
            codes, column = judging.judged(subject)
            better = (codes != NOT_CHECKED) | (self.result.verdicts[name][rows] == NOT_CHECKED)
            self.result.verdicts[name][rows[better]] = codes[better]
            self.result.judged[name] = column.taken(
                self.result.judged.get(name), rows[better], better, self.count
            )
        for step in self.steps:
            self.result.levels[step.name][rows[valued]] = self.at[step.name]
            self._expect(step, part.steps[step.name], rows)
        self.valueless[rows[valued]] = False
        for row, refusal in part.refusals.items():
            if refusal.code in ("out_of_range", "not_finite", "missing"):
                self.valueless[rows[row]] = False  # every level refuses it

    def _valued(self, part: RowPass) -> Mask:
        """The rows of a chunk in which all outputs that criteria name have values."""
        valued = np.ones(part.count, dtype=bool)
        for step in self.steps:
            rows = part.steps[step.name]
            for name in self._outputs(step):
                value = rows.values[name].spread(part.count).reshape(part.count, -1)
                valued &= np.isfinite(value).all(axis=1)
        return valued

    def _expect(self, step: Block, step_rows: StepRows, rows: NDArray[np.intp]) -> None:
        """What each level states for rows where these lie now; nothing is calculated for it."""
        measured, outputs = accuracy(step.cls), self._outputs(step)
        for level in self.ladders[step.name] if measured and outputs else ():
            errors = self.expected.setdefault((step.name, level), np.full(self.count, np.inf))
            for part in step_rows.parts:
                stated = measured.expected(part.template, level, outputs) if measured else {}
                worst = np.max(np.broadcast_arrays(*(stated[name] for name in outputs)), axis=0)
                there = rows[part.rows] if step_rows.has_rows else rows
                errors[there] = np.nan_to_num(worst, nan=np.inf)

    def _climbed(self) -> NDArray[np.intp]:
        """The rows that climb in the next round, after the best step was moved to its next level."""
        moves = list(self._moves(self._left()))
        if not moves:
            return np.array([], dtype=np.intp)
        _, name, level, due = max(moves, key=lambda move: move[0])
        self.at[name] = level
        return np.flatnonzero(due)

    def _moves(self, left: Mask) -> Iterator[tuple[float, str, str, Mask]]:
        """For each step the next level that helps any row: what it gains for its cost, and which rows."""
        for step in self.steps:
            ladder, here = self.ladders[step.name], self.at[step.name]
            finer = ladder[ladder.index(here) + 1 :] if here in ladder else ladder
            for level in finer:
                due = left & self._is_smaller(step.name, level)
                if level not in step.cls.most_points:
                    due |= self.valueless
                if due.any():
                    yield self._gain(step, level, due), step.name, level, due
                    break
                self.result.skipped[step.name, level] = "its stated error is nowhere smaller"

    def _is_smaller(self, name: str, level: str) -> Mask:
        here = self.expected.get((name, str(self.at[name])))
        there = self.expected.get((name, level))
        if here is None or there is None:
            return np.zeros(self.count, dtype=bool)
        smaller: Mask = there < here
        return smaller

    def _gain(self, step: Block, level: str, due: Mask) -> float:
        """The error that a level takes away, for what it costs."""
        here = self.expected.get((step.name, str(self.at[step.name])), np.zeros(self.count))
        there = self.expected.get((step.name, level), here)
        gained = np.mean(np.minimum(here[due], LARGEST) - np.minimum(there[due], LARGEST))
        seconds = array_seconds(step.cls, level, int(due.sum()), self._outputs(step), 1, 1)
        return float(gained) / max(seconds, 1e-9)


def _ladder(rows: RowPass, step: Block) -> tuple[str, ...]:
    """The levels that answer the inputs of some rows; all levels, where no row has inputs."""
    templates = [part.template for part in rows.steps[step.name].parts]
    return templates[0].ladder() if templates else step.cls.levels
