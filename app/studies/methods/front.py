"""The Pareto front of several objectives, found by pymoo's NSGA-II.

The search runs at the coarse level, and points spread along the front are then polished. The fine level
confirms these points, which corrects the coarse level for the next round, as for one objective.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np

from app.studies.methods.answers import Answer, Problem
from app.studies.methods.confirmation import WITHIN, Round, Run, State, state_of_met, unmet
from app.studies.methods.correction import CorrectedAnswer
from app.studies.methods.evolution import evolved
from app.studies.methods.polish import ScaledProblem, polished
from app.studies.methods.search import best, middle_and_width
from app.studies.methods.stages import Forgetful, Journal, Stages
from templates.core.arrays import Array, Integers, Mask

POPULATION, GENERATIONS = 100, 200
"""Generations of the first round; later rounds start from the last population and take half as many."""
CONFIRMED = 20
"""Points of the front that each round confirms."""
ROUNDS = 4
"""Most rounds."""


@dataclass(frozen=True)
class Effort:
    """Limits of a search: population size, generations, confirmed points and rounds."""

    population: int = POPULATION
    generations: int = GENERATIONS
    confirmed: int = CONFIRMED
    rounds: int = ROUNDS


@dataclass(frozen=True)
class Front:
    """The confirmed front and its cost.

    Attributes
    ----------
    state
        The state as in `Optimum`, for all points of the last round together.
    places
        Confirmed points that meet all criteria and that no other such point betters in all objectives,
        ordered by the first objective. Empty if no point meets all criteria.
    rounds
        All confirmed points, by round.
    explored, confirmations
        The numbers of rows calculated at the coarse and at the fine level.
    seconds
        The total cost [s], as the results state it.
    """

    state: State
    places: tuple[Round, ...]
    rounds: tuple[tuple[Round, ...], ...]
    explored: int
    confirmations: int
    seconds: float
    is_global: Literal["not proven"] = "not proven"


def pareto_front(
    problem: Problem,
    explore: Answer,
    confirm: Answer,
    *,
    seed: int,
    effort: Effort = Effort(),
    within: float = WITHIN,
    journal: Journal | None = None,
) -> Front:
    """Return the front of a problem with several objectives; the parameters are those of `optimise`.

    Stages that `journal` has stored during an earlier call with equal arguments are not repeated.

    Raises
    ------
    InvalidInputs
        If no row of the scan has results (code `all_refused`), or pymoo is missing (code `not_installed`).
    """
    run = Run(problem, explore, confirm, seed, within)
    done: list[tuple[Round, ...]] = []
    state: State | None = None
    stages = Stages(journal or Forgetful(), run.explore)
    population = stages.once("first", lambda: _first(run, effort.population))
    while state is None and len(done) < effort.rounds:
        number, generations = len(done), effort.generations if not done else -(-effort.generations // 2)
        population = evolved(
            run.surface, population, (seed, number), generations, stages, f"evolved {number}"
        )
        unit = stages.once(f"chosen {number}", partial(_chosen, run.surface, population, effort.confirmed))
        rounds, fine = run.confirmed(unit)
        done.append(tuple(rounds))
        state = _state(rounds)
        run.learn(unit, rounds, fine)
    places = _best(problem, [one for rounds in done for one in rounds if one.is_met])
    return Front(state or "not_settled", places, tuple(done), *run.rows, run.seconds)


def dominations(objectives: Array) -> Integers:
    """Return the number of rows that dominate each row, (N,), for objectives to minimise, (N, k)."""
    columns = [np.ascontiguousarray(column) for column in objectives.T]
    counts = np.zeros(len(objectives), dtype=np.int64)
    for row, values in enumerate(objectives):
        as_good, better = np.ones(len(counts), dtype=bool), np.zeros(len(counts), dtype=bool)
        for column, value in zip(columns, values, strict=True):
            as_good &= column <= value
            better |= column < value
        counts[row] = np.count_nonzero(as_good & better)
    return counts


def _state(rounds: list[Round]) -> State | None:
    """Return the final state if the search ends with these points; None if it continues."""
    if not all(one.agrees for one in rounds):
        return None
    if all(one.is_met for one in rounds):
        return state_of_met(rounds)
    if any(one.fell_short for one in rounds):
        return None
    return unmet(rounds)


def _first(run: Run, count: int) -> Array:
    """Return the first population: the best rows of the scan.

    If no row is feasible, the first member is the best point that a local search finds.
    """
    seen = run.surface.seen(run.scanned.unit, run.scanned.columns)
    if not (seen.violation == 0).any():  # feasible points are rare, so evolution starts from the best one
        return np.vstack([best(run.surface, run.scanned).unit[None], run.scanned.unit[: count - 1]])
    rows = np.flatnonzero(seen.complete)
    order = np.lexsort((dominations(seen.objectives[rows]), seen.violation[rows]))
    return run.scanned.unit[rows[order[:count]]]


def _chosen(surface: CorrectedAnswer, population: Array, count: int) -> Array:
    """Return points of a population's front to confirm, far from each other.

    If no point is feasible, return the one of least violation.
    """
    unit = np.unique(population, axis=0)
    seen = surface(unit)
    feasible = seen.complete & (seen.violation == 0)
    if not feasible.any():
        return unit[[int(np.nanargmin(np.where(seen.complete, seen.violation, np.nan)))]]
    unit, objectives = unit[feasible], seen.objectives[feasible]
    front = dominations(objectives) == 0
    chosen = spread(objectives[front], count)
    return _polished(surface, unit[front][chosen], objectives[front][chosen])


def _polished(surface: CorrectedAnswer, unit: Array, objectives: Array) -> Array:
    """Return each point with its first objective minimised while no other objective increases.

    Some points that NSGA-II leaves in the gaps of its front do not quite belong to the front.
    """
    middle_width = middle_and_width(objectives)
    ends = [
        polished(ScaledProblem(surface, *middle_width, most=row[1:]), place)
        for place, row in zip(unit, objectives, strict=True)
    ]
    return np.array([end.unit for end in ends])


def spread(objectives: Array, count: int) -> list[int]:
    """Return up to `count` rows far from each other, including each objective's minimum; shape (N, k)."""
    low, high = objectives.min(axis=0), objectives.max(axis=0)
    scaled = (objectives - low) / np.where(high > low, high - low, 1.0)
    chosen = list(dict.fromkeys(int(row) for row in scaled.argmin(axis=0)))
    distance = np.min([np.linalg.norm(scaled - scaled[row], axis=1) for row in chosen], axis=0)
    while len(chosen) < count and distance.max() > 0:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(scaled - scaled[chosen[-1]], axis=1))
    return chosen


def _best(problem: Problem, met: list[Round]) -> tuple[Round, ...]:
    if not met:
        return ()
    objectives = problem.senses * np.array([one.confirmed[: len(problem.objectives)] for one in met])
    first = np.unique(objectives, axis=0, return_index=True)[1]
    kept: Mask = dominations(objectives[first]) == 0
    return tuple(met[row] for row in first[kept])
