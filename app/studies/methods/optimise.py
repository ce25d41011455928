"""One objective: explore at a coarse level, confirm at a fine one, correct, and repeat until both agree.

After the first confirmation the search tightens each limit by the error band of the fine level, so that the
confirmed optimum meets it fully. A feasible point is not necessarily optimal: the ratios to the coarse level
are exact at the confirmed rows, but slopes between them may be wrong.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.studies.methods.answers import Answer, Problem
from app.studies.methods.confirmation import WITHIN, Round, Run, State, state_of_met, unmet
from app.studies.methods.search import best
from templates.core.arrays import Array

ROUNDS = 8
"""Largest number of confirmations of one optimum."""


@dataclass(frozen=True)
class Violation:
    """A criterion that the best point does not meet: the violation [SI], and its ratio to the limit."""

    criterion: str
    by: float
    relative: float


@dataclass(frozen=True)
class Optimum:
    """The best confirmed point, the rounds that led to it, and their cost.

    Attributes
    ----------
    state
        `settled`: prediction and fine level agree, and all criteria are met. `unconfirmed`: as `settled`, but
        the error of a criterion at the fine level is unknown. `undecided`: they agree, but a limit lies in
        the error band of the fine level. `infeasible`: they agree, and no examined point meets all criteria.
        `not_settled`: they do not agree after the last round, or the fine level refuses the point.
    best
        The round with the best objective among those that meet all criteria; if none does, the round of least
        violation for an infeasible problem, else the last round.
    violations
        Criteria that `best` does not meet, the least violated first.
    explored, confirmations
        The numbers of rows calculated at the coarse and at the fine level.
    seconds
        The total cost [s], as the results state it.
    """

    state: State
    best: Round
    rounds: tuple[Round, ...]
    violations: tuple[Violation, ...]
    explored: int
    confirmations: int
    seconds: float
    is_global: Literal["not proven"] = "not proven"


def optimise(
    problem: Problem,
    explore: Answer,
    confirm: Answer,
    *,
    seed: int,
    rounds: int = ROUNDS,
    within: float = WITHIN,
) -> Optimum:
    """Return the optimum of the first objective of a problem.

    Parameters
    ----------
    problem
        The variables, objectives and required criteria.
    explore, confirm
        Functions that return results at the coarse level, for thousands of rows, and at the fine one, for a
        few.
    seed
        Seed of the scan; equal seeds and results give equal optima.
    rounds
        Largest number of confirmations.
    within
        Relative difference between prediction and fine level that counts as agreement.

    Raises
    ------
    InvalidInputs
        If no row of the scan has results; the code is `all_refused`.
    """
    return optimised_run(Run(problem, explore, confirm, seed, within), rounds)


def optimised_run(run: Run, rounds: int = ROUNDS, challenges: int = 0) -> Optimum:
    """Return the optimum of a run that has not begun; the run then holds the corrections.

    Each of the `challenges` confirms the best point far from all confirmed ones after the search has settled,
    and continues it: the ratio of the levels there may make another valley the better one.
    """
    done: list[Round] = []
    state = _settle(run, done, rounds)
    for number in range(challenges):
        if (
            state not in ("settled", "unconfirmed")
            or (unit := run.challenger(done, is_first=not number)) is None
        ):
            break
        _confirm(run, unit, done)
        if run.promises_more(best(run.surface, run.scanned, tuple(run.surface.places[-2:])).unit, done):
            state = _settle(run, done, len(done) + rounds)
    return _optimum(run, done, state)


def _settle(run: Run, done: list[Round], most: int) -> State | None:
    """Confirm optima until the levels agree or there are `most` rounds; return the state, None if open."""
    state: State | None = None
    while state is None and len(done) < most:
        _confirm(run, _next(run), done)
        state = _state(done)
    return state


def _confirm(run: Run, unit: Array, done: list[Round]) -> None:
    (confirmed,), fine = run.confirmed(unit)
    done.append(confirmed)
    run.learn(unit, [confirmed], fine)


def _next(run: Run) -> Array:
    """Return the point to confirm, shape (1, d): the optimum according to the present corrections.

    If that point is infeasible and close to a confirmed one, return a point far from all confirmed ones
    instead, because the corrections may be wrong there.
    """
    place = best(run.surface, run.scanned, tuple(run.surface.places[-1:]))
    if place.violation > 0 and run.surface.is_known(place.unit):
        return run.unknown_place()
    return place.unit[None]


def _state(done: list[Round]) -> State | None:
    """Return the final state if the search ends with the last round; None if it continues."""
    confirmed = done[-1]
    if not np.isfinite(confirmed.confirmed).all():
        return "not_settled"
    if not confirmed.agrees:
        return None
    if confirmed.is_met:
        return state_of_met([confirmed])
    looks_elsewhere = not confirmed.is_feasible and not done[0].agrees
    if confirmed.fell_short or looks_elsewhere:
        return None  # tighten the limits or improve the corrections first
    return unmet([confirmed])


def _optimum(run: Run, done: list[Round], state: State | None) -> Optimum:
    """Return the optimum of the finished rounds; if `state` is None, it is infeasible or not settled."""
    sense = float(run.problem.senses[0])
    met = [one for one in done if one.is_met]
    chosen = done[-1]
    if met:
        chosen = min(met, key=lambda one: sense * float(one.confirmed[0]))
        state = state_of_met([chosen]) if state in ("settled", "unconfirmed") else "not_settled"
    elif state is None and len(done) > 1 and not chosen.is_feasible:
        chosen = min(done, key=lambda one: float(np.max(-one.worst / run.scales)))
        state = unmet([chosen])
    state = state or "not_settled"
    violations = violated(run.problem, chosen, run.scales)
    return Optimum(state, chosen, tuple(done), violations, *run.rows, run.seconds)


def violated(problem: Problem, place: Round, scales: Array) -> tuple[Violation, ...]:
    """Return the criteria that a point does not meet, the least violated first; `scales` [SI], shape (m,)."""
    count, held = len(problem.objectives), len(problem.held)
    values, limits = place.confirmed[count : count + held], place.confirmed[count + held :]
    by = (-problem.signs * (values - limits)).tolist()
    each = zip(problem.held, by, (by / scales).tolist(), strict=True)
    violations = [Violation(one.name, short, relative) for one, short, relative in each if short > 0]
    return tuple(sorted(violations, key=lambda one: one.relative))
