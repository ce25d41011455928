"""Decide criteria of a design: steps climb where a criterion is undecided, or its error unknown.

Each round calculates one step at its next level: the step that removes most of the error for its cost. It
ends when all criteria are decided, when no level states a smaller error of the same truth, or when the budget
is spent. Nothing is saved, and solids stay as they are.
"""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from app.designs.engine.calculate import recalculated
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import Verdicts
from app.designs.network import Block
from app.pool.cost import level_seconds
from app.pool.steps import announce
from app.reference import Reference
from templates.core.criteria.judgement import Judgement
from templates.core.criteria.summary import worst_first
from templates.core.language.levels import accuracy, next_levels
from templates.core.language.template import Template

Stop = Literal["decided", "no_finer_level", "budget", "pending", "estimated"]
STOPS: tuple[Stop, ...] = ("pending", "estimated", "budget", "no_finer_level", "decided")
"""Most telling first, where several designs are decided together."""


@dataclass(frozen=True)
class Trial:
    """One step at one level: what it decided, what it took [s], and why it was of no use.

    `expected` is the time that was estimated before [s]. `variant` is empty for the design itself.
    """

    step: str
    level: str
    rows: int
    seconds: float
    decided: tuple[str, ...] = ()
    reason: str | None = None
    expected: float = 0.0
    variant: str = ""


@dataclass(frozen=True)
class ClimbResult:
    """Criteria as far as they could be decided, worst first, and what that took.

    `asked` are those of the `wanted` ones that a level might decide; all are wanted where it is None.
    """

    criteria: Sequence[Judgement]
    wanted: Collection[str] | None
    asked: tuple[str, ...]
    trials: tuple[Trial, ...]
    skipped: tuple[Trial, ...]
    stopped: Stop

    @property
    def undecided(self) -> list[str]:
        """Return the requested criteria that are still undecided."""
        return [j.name for j in self.criteria if j.verdict == "undecided" and j.name in self.asked]

    @property
    def error_unknown(self) -> list[str]:
        """Return the wanted criteria whose values still have an unknown error."""
        wanted = [j for j in self.criteria if self.wanted is None or j.name in self.wanted]
        return [j.name for j in wanted if j.is_open and j.verdict != "undecided"]


@dataclass(frozen=True)
class _Move:
    """A step that could climb: to which level, from which error to which, and at what cost [s]."""

    block: Block
    level: str
    before: float
    after: float
    seconds: float

    @property
    def gain(self) -> float:
        """Return the removed error divided by its cost."""
        return (min(self.before, 1e6) - min(self.after, 1e6)) / max(self.seconds, 1e-6)


@dataclass
class Climb:
    """One design whose criteria are decided, or a variant of one; `budget` is in s."""

    calculation: Calculation
    wanted: Collection[str] | None
    budget: float
    variant: str = ""
    trials: list[Trial] = field(default_factory=list)
    skipped: dict[tuple[str, str], Trial] = field(default_factory=dict)
    _tried: set[tuple[str, str]] = field(default_factory=set)

    def decide(self) -> ClimbResult:
        """Refine levels until no step can improve a verdict."""
        start = time.monotonic()
        verdicts = Verdicts(self.calculation)
        judgements = {judgement.name: judgement for judgement in verdicts.all()}
        asked = tuple(n for n, j in judgements.items() if self._is_wanted(n) and self._is_asked(j))
        stopped: Stop | None = None
        while stopped is None:
            open_now = [name for name in asked if judgements[name].is_open]
            stopped = self._next(open_now, self.budget - (time.monotonic() - start))
            if stopped is None:
                judgements |= self._judged(open_now)
        result = self._result(judgements, asked, self.trials, stopped)
        is_open = stopped == "decided" and result.error_unknown
        return replace(result, stopped="no_finer_level") if is_open else result

    def estimated(self) -> ClimbResult:
        """Return the level that would be calculated first, as a trial that took no time; nothing is."""
        judgements = {judgement.name: judgement for judgement in Verdicts(self.calculation).all()}
        asked = tuple(n for n, j in judgements.items() if self._is_wanted(n) and self._is_asked(j))
        moves = list(self._moves(asked))
        first = [self._trial(max(moves, key=lambda move: move.gain))] if moves else []
        return self._result(judgements, asked, first, "estimated")

    def _result(
        self,
        judgements: Mapping[str, Judgement],
        asked: tuple[str, ...],
        trials: Sequence[Trial],
        stopped: Stop,
    ) -> ClimbResult:
        ordered, skipped = worst_first(judgements.values()), tuple(self.skipped.values())
        return ClimbResult(ordered, self.wanted, asked, tuple(trials), skipped, stopped)

    def _is_asked(self, judgement: Judgement) -> bool:
        """Return whether a criterion is undecided, or of an unknown error that a level would state."""
        if judgement.verdict == "undecided":
            return True
        return judgement.is_open and next(self._moves([judgement.name]), None) is not None

    def _is_wanted(self, name: str) -> bool:
        return self.wanted is None or name in self.wanted

    def _next(self, open_now: Sequence[str], left: float) -> Stop | None:
        """Make the best move, or note why there is none."""
        if not open_now:
            return "decided"
        moves = [move for move in self._moves(open_now) if (move.block.name, move.level) not in self._tried]
        if not moves:
            return "no_finer_level"
        affordable = [move for move in moves if move.seconds <= left]
        if not affordable:
            for move in moves:
                reason = f"it takes about {move.seconds:.2g} s, which is beyond the budget"
                self._skip(move.block.name, move.level, reason)
            return "budget"
        return self._climb(max(affordable, key=lambda move: move.gain), open_now)

    def _moves(self, open_now: Sequence[str]) -> Iterator[_Move]:
        """Yield the next levels of each uncertain output of the open criteria, cheapest first."""
        verdicts = Verdicts(self.calculation)
        for reference in sorted({r for name in open_now for r in verdicts.uncertain(name)}, key=str):
            block = self.calculation.graph.blocks[reference.block]
            self._note_levels(block, reference)
            yield from self._moves_of(block, reference, open_now)

    def _moves_of(self, block: Block, reference: Reference, open_now: Sequence[str]) -> Iterator[_Move]:
        evaluation = self.calculation.evaluations[block.name]
        before = _largest(evaluation.error.get(reference.member))
        points = math.prod(evaluation.template.shape_of_points())
        for finer in next_levels(evaluation.template, reference.member):
            if points > block.cls.most_points.get(finer.level, points):
                most = block.cls.most_points[finer.level]
                self._skip(block.name, finer.level, f"it takes at most {most} points at once, not {points}")
                continue
            seconds = self._seconds(block, evaluation.template, finer.level, open_now)
            yield _Move(block, finer.level, before, _largest(finer.error), seconds)

    def _note_levels(self, block: Block, reference: Reference) -> None:
        """Note why levels are skipped: another truth, or an error that is not smaller or not stated."""
        evaluation, measured = self.calculation.evaluations[block.name], accuracy(block.cls)
        if measured is None:
            return
        here, output = evaluation.template.level, reference.member
        useful = {finer.level for finer in next_levels(evaluation.template, output)}
        for level in evaluation.template.ladder():
            if level in useful or level == here or (block.name, level) in self._tried:
                continue
            if measured.truth(level, output) != measured.truth(here, output):
                reason = f"its error of {output} was measured against another truth"
            else:
                reason = f"its stated error of {output} is not smaller"
            self._skip(block.name, level, reason)

    def _skip(self, step: str, level: str, reason: str) -> None:
        self.skipped.setdefault(
            (step, level), Trial(step, level, 0, 0.0, reason=reason, variant=self.variant)
        )

    def _trial(self, move: _Move) -> Trial:
        """Return a step at a finer level before it is calculated."""
        rows = math.prod(self.calculation.evaluations[move.block.name].template.shape_of_points())
        return Trial(move.block.name, move.level, rows, 0.0, expected=move.seconds, variant=self.variant)

    def _needed(self, block: Block, open_now: Sequence[str]) -> tuple[str, ...]:
        """Return the outputs of a step that the open criteria and relations use."""
        verdicts = Verdicts(self.calculation)
        named = (r for name in open_now for r in verdicts.references(name).values() if r.block == block.name)
        used = (*named, *self.calculation.graph.used.get(block.name, ()))
        return tuple(sorted({r.member for r in used if r.member in block.cls.formulas}))

    def _seconds(self, block: Block, template: Template, level: str, open_now: Sequence[str]) -> float:
        typed = self.calculation.typed
        raw = {name: typed.get(cell.name, cell.raw) for name, cell in block.cells.items()}
        return level_seconds(template, raw, level, self._needed(block, open_now))

    def _climb(self, move: _Move, open_now: Sequence[str]) -> Stop | None:
        """Calculate a step at a finer level, and keep the result if its error is smaller."""
        name, level, start = move.block.name, move.level, time.perf_counter()
        self._tried.add((name, level))
        self.skipped.pop((name, level), None)
        needed = {name: self._needed(move.block, open_now)}
        levels = {**self.calculation.levels_used(), name: level}
        trial = self._trial(move)
        announce(_announcement(trial))
        finer = recalculated(self.calculation, {}, levels, again=[name], outputs=needed)
        trial = replace(trial, seconds=time.perf_counter() - start)
        if finer.deferred:
            self.trials.append(replace(trial, reason="it is still calculated"))
            return "pending"
        if finer.faults or name not in finer.evaluations:
            refused = "; ".join(fault.detail for fault in finer.faults) or "it has no result"
            self.trials.append(replace(trial, reason=f"it refuses: {refused}"))
            return None
        self.calculation = finer
        judged = self._judged(open_now).values()
        decided = sorted(judgement.name for judgement in judged if not judgement.is_open)
        self.trials.append(replace(trial, decided=tuple(decided)))
        return None

    def _judged(self, names: Sequence[str]) -> dict[str, Judgement]:
        """Return the criteria with these names, judged again."""
        return {judgement.name: judgement for judgement in Verdicts(self.calculation).some(names)}


def _announcement(trial: Trial) -> str:
    """Return what is calculated next, and how long it is expected to take."""
    points = f", {trial.rows} points" if trial.rows > 1 else ""
    return f"{trial.step} at level {trial.level}{points}, about {trial.expected:.2g} s"


def _largest(error: object) -> float:
    """Return the largest error of several points; infinite where it is unknown at any."""
    errors = np.asarray(error if error is not None else np.nan, dtype=float)
    return float(np.max(np.where(np.isnan(errors), np.inf, errors)))
