"""Decide criteria of a design: raise the level of steps while a criterion is undecided or its error unknown.

Each round calculates one step at its next level: the step that removes most of the error for its cost. The
rounds end when all criteria are decided, when no level gives a smaller error against the same reference, or
when the budget is spent. Nothing is saved, and solids stay as they are.
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
"""In order of priority, if several designs are decided together."""


@dataclass(frozen=True)
class Trial:
    """One step at one level: which criteria it decided, its time [s], and the reason if it was of no use.

    `expected` is the estimated time [s]. `variant` is empty for the design itself.
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
    """The criteria after refinement, worst first, with the levels that were tried and skipped.

    `wanted` names the requested criteria; None means all. `asked` names those of them that a level might
    decide.
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
        """Return the requested criteria whose values still have an unknown error."""
        wanted = [j for j in self.criteria if self.wanted is None or j.name in self.wanted]
        return [j.name for j in wanted if j.is_open and j.verdict != "undecided"]


@dataclass(frozen=True)
class _Move:
    """A possible refinement of a step: its new level, the errors before and after, and its time [s]."""

    block: Block
    level: str
    before: float
    after: float
    seconds: float

    @property
    def gain(self) -> float:
        """Return the error removed per second."""
        return (min(self.before, 1e6) - min(self.after, 1e6)) / max(self.seconds, 1e-6)


@dataclass
class Climb:
    """Refines the levels of a design, or of one variant, to decide its criteria; `budget` is in s."""

    calculation: Calculation
    wanted: Collection[str] | None
    budget: float
    variant: str = ""
    trials: list[Trial] = field(default_factory=list)
    skipped: dict[tuple[str, str], Trial] = field(default_factory=dict)
    _tried: set[tuple[str, str]] = field(default_factory=set)

    def decide(self) -> ClimbResult:
        """Refine levels until no step can improve a verdict, and return the result."""
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
        """Return the first level that `decide` would calculate, as a trial that is not carried out."""
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
        """Return whether a finer level could settle a criterion: undecided, or with unknown error."""
        if judgement.verdict == "undecided":
            return True
        return judgement.is_open and next(self._moves([judgement.name]), None) is not None

    def _is_wanted(self, name: str) -> bool:
        return self.wanted is None or name in self.wanted

    def _next(self, open_now: Sequence[str], left: float) -> Stop | None:
        """Carry out the best refinement, or return the reason why there is none."""
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
        """Yield the possible refinements of each uncertain output that the open criteria use."""
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
        """Record the reasons for skipping levels: their error refers to another truth, or is not smaller."""
        evaluation, measured = self.calculation.evaluations[block.name], accuracy(block.cls)
        if measured is None:
            return
        here, output = evaluation.template.level, reference.member
        useful = {finer.level for finer in next_levels(evaluation.template, output)}
        for level in evaluation.template.ladder():
            if level in useful or level == here or (block.name, level) in self._tried:
                continue
            if measured.truth(level, output) != measured.truth(here, output):
                reason = f"its error of {output} was measured against another reference"
            else:
                reason = f"its stated error of {output} is not smaller"
            self._skip(block.name, level, reason)

    def _skip(self, step: str, level: str, reason: str) -> None:
        self.skipped.setdefault(
            (step, level), Trial(step, level, 0, 0.0, reason=reason, variant=self.variant)
        )

    def _trial(self, move: _Move) -> Trial:
        """Return the trial for a refinement before it is carried out."""
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
        """Calculate a step at a finer level, and keep the result unless the step is refused or pending."""
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
            self.trials.append(replace(trial, reason="it is still being calculated"))
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
        """Judge the named criteria again and return them by name."""
        return {judgement.name: judgement for judgement in Verdicts(self.calculation).some(names)}


def _announcement(trial: Trial) -> str:
    """Return a progress message: the step and level to be calculated next, and the expected time."""
    points = f", {trial.rows} points" if trial.rows > 1 else ""
    return f"{trial.step} at level {trial.level}{points}, about {trial.expected:.2g} s"


def _largest(error: object) -> float:
    """Return the largest error of several points; infinite if the error at any point is unknown."""
    errors = np.asarray(error if error is not None else np.nan, dtype=float)
    return float(np.max(np.where(np.isnan(errors), np.inf, errors)))
