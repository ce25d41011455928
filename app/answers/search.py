"""Search the free places: the best values, the requirement that binds, and what conflicts if there are none.

One optimiser does all of it (`app.studies.methods`): it explores at the coarse levels, corrects them by the
fine ones, and confirms there, on the grid.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.studies.methods.answers import Answer, Columns, Objective, Problem
from app.studies.methods.confirmation import WITHIN, Round, Run
from app.studies.methods.correction import CorrectedAnswer
from app.studies.methods.optimise import Optimum, optimise, optimised_run
from app.studies.methods.polish import Place, ScaledProblem, polished
from app.studies.methods.search import best, middle_and_width, on_grid
from templates.core.arrays import Array
from templates.core.progress import report

SEED = 1
CHALLENGES = 2
"""Points far from the optimum at which the levels are compared before an answer."""
RELAXED_BY = (0.01, 0.02, 0.05, 0.1, 0.2)
"""Relaxations of a limit that are tried until the objective gains, relative to the limit."""
MOST_BINDING = 3
NEAR = 0.05
"""Margin relative to the limit below which a requirement may bind."""
FEASIBLE = 1e-7
"""Largest relative violation that counts as none."""
GAIN = 1e-7


@dataclass(frozen=True)
class BindingLimit:
    """A requirement, the relaxation of its limit, and the objective with this relaxation [SI]."""

    number: int
    by: float
    gain: float


@dataclass(frozen=True)
class Reach:
    """The best value of a requirement [SI] while the others are met, where it is, and the limit it allows.

    `limit` is the limit that the value meets with its whole error band.
    """

    number: int
    at: Array
    value: float
    limit: float
    by: float


@dataclass(frozen=True)
class Conflict:
    """Requirements of which all but any one can be met, and what would make the request feasible.

    `joint` holds the limits [SI] of all violated requirements at the point of least violation, by number.
    """

    numbers: tuple[int, ...]
    reaches: tuple[Reach, ...]
    joint: dict[int, float]
    joint_at: Array


@dataclass(frozen=True)
class Search:
    """The search of one request."""

    problem: Problem
    explore: Answer
    confirm: Answer

    def run(self) -> tuple[Optimum, Run]:
        """Return the optimum, and the run with its corrections."""
        run = Run(self.problem, self.explore, self.confirm, SEED, WITHIN)
        return optimised_run(run, challenges=CHALLENGES), run

    def bindings(self, optimum: Optimum, run: Run) -> list[BindingLimit]:
        """Return the requirements whose relaxation gains, the largest gain first; else the nearest one."""
        margins = optimum.best.worst / run.scales
        order = [
            n for n in np.argsort(margins).tolist() if margins[n] <= NEAR or n == int(np.argmin(margins))
        ]
        unit = self.problem.space.place(optimum.best.at[None])[0]
        limits = [self._binding(run, unit, number) for number in order[:MOST_BINDING]]
        return sorted(limits, key=lambda one: (one.gain <= 0, one.by, -one.gain))

    def _binding(self, run: Run, unit: Array, number: int) -> BindingLimit:
        base = self._moved(run, unit, number, 0.0)
        for by in RELAXED_BY:
            gain = base.objective - self._moved(run, base.unit, number, by).objective
            if gain > GAIN * max(1.0, abs(base.objective)):
                break
        else:
            gain, by = 0.0, RELAXED_BY[0]
        width = float(self._scaled(run, run.surface).width[0])
        return BindingLimit(number, by, gain * width)

    def _moved(self, run: Run, unit: Array, number: int, by: float) -> Place:
        """Return the optimum near a point with the limit of one requirement relaxed."""
        scaled = self._scaled(run, _with_reserve(run.surface, {number: -by}))
        end = polished(scaled, unit)
        return on_grid(scaled, end) if self.problem.space.gridded.any() else end

    @staticmethod
    def _scaled(run: Run, surface: CorrectedAnswer) -> ScaledProblem:
        seen = run.surface.seen(run.scanned.unit, run.scanned.columns)
        return ScaledProblem(surface, *middle_and_width(seen.objectives[seen.complete]))

    def conflict(self, optimum: Optimum, run: Run) -> Conflict:
        """Return a minimal set of requirements that cannot all be met, and what would make them feasible."""
        kept = self._minimal(run)
        reaches: list[Reach] = []
        for done, number in enumerate(kept):
            report((1 + done) / (1 + len(kept)), f"reach of {self.problem.held[number].name}")
            reaches += self._reaches(number)
        worst = optimum.best.worst
        joint = {n: self._limit(optimum.best, n) for n in np.flatnonzero(worst < 0).tolist()}
        return Conflict(kept, tuple(sorted(reaches, key=lambda one: one.by)), joint, optimum.best.at)

    def _minimal(self, run: Run) -> tuple[int, ...]:
        """Return the requirements left after removing each without which the rest is still infeasible."""
        kept = list(range(len(self.problem.held)))
        margins = np.max(np.nan_to_num(_margins(run), nan=-np.inf), axis=0)
        for number in np.argsort(-margins).tolist():
            others = [one for one in kept if one != number]
            if others and self._violation(run, others) > FEASIBLE:
                kept = others
        return tuple(kept)

    def _violation(self, run: Run, kept: Sequence[int]) -> float:
        """Return the least relative violation of some requirements alone."""
        return best(
            _subset(run.surface, kept), replace(run.scanned, columns=_part(run.scanned.columns, kept))
        ).violation

    def _reaches(self, number: int) -> Iterator[Reach]:
        """Yield the best value of a requirement while all others are met, if they can be met."""
        held = self.problem.held[number]
        goal = Objective(held.name, "maximise" if held.sign == ">=" else "minimise")
        others = tuple(one for n, one in enumerate(self.problem.held) if n != number)
        problem = replace(self.problem, objectives=(goal,), held=others)
        fine: dict[bytes, Columns] = {}

        def confirm(rows: Array) -> Columns:
            columns = self.confirm(rows)
            fine.update({row.tobytes(): columns.row(n) for n, row in enumerate(rows)})
            return _without(columns, number)

        optimum = optimise(problem, lambda rows: _without(self.explore(rows), number), confirm, seed=SEED)
        if not optimum.best.is_met:
            return
        columns = fine[np.ascontiguousarray(optimum.best.at).tobytes()]
        sign = float(self.problem.signs[number])
        limit, worst = float(columns.limits[0, number]), float(columns.worst(self.problem)[0, number])
        value = float(columns.values[0, number])
        yield Reach(number, optimum.best.at, value, limit + sign * worst, -worst / (abs(limit) or 1.0))

    def _limit(self, place: Round, number: int) -> float:
        """Return the limit that a point meets with its whole error band [SI]."""
        limit = float(place.confirmed[len(self.problem.objectives) + len(self.problem.held) + number])
        return limit + float(self.problem.signs[number] * place.worst[number])


def _with_reserve(surface: CorrectedAnswer, more: dict[int, float]) -> CorrectedAnswer:
    """Return a surface whose limits are moved, relative to their scales; a negative number relaxes one."""
    other = CorrectedAnswer(surface.problem, surface.answer, surface.scales)
    for name in ("places", "coarse", "fine", "guards"):
        setattr(other, name, getattr(surface, name))
    other.reserve = surface.reserve.copy()
    for number, by in more.items():
        other.reserve[number] += by
    return other


def _subset(surface: CorrectedAnswer, kept: Sequence[int]) -> CorrectedAnswer:
    """Return a surface with some of the requirements only."""
    whole, rows = surface.problem, list(kept)
    problem = replace(whole, held=tuple(whole.held[n] for n in rows))
    other = CorrectedAnswer(problem, lambda x: _part(surface.answer(x), rows), surface.scales[rows])
    goals, held = len(whole.objectives), len(whole.held)
    columns = [*range(goals), *(goals + n for n in rows), *(goals + held + n for n in rows)]
    other.places, other.reserve = surface.places, surface.reserve[rows]
    other.coarse, other.fine = ([row[columns] for row in part] for part in (surface.coarse, surface.fine))
    other.guards = [row[rows] for row in surface.guards]
    return other


def _part(columns: Columns, kept: Sequence[int]) -> Columns:
    """Return columns with some of the requirements only."""
    return columns.with_sides(lambda side: side[:, list(kept)])


def _margins(run: Run) -> Array:
    columns = run.scanned.columns
    return np.asarray(run.problem.signs * (columns.values - columns.limits) / run.scales)


def _without(columns: Columns, number: int) -> Columns:
    """Return columns with the value of one requirement as the objective, and without this requirement."""
    kept = [n for n in range(columns.values.shape[1]) if n != number]
    return replace(_part(columns, kept), objectives=columns.values[:, [number]])
