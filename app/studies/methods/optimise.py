"""One objective: explore at a coarse level, confirm at a fine one, correct, and repeat until both agree.

After the first confirmation the search tightens each limit by the error band of the fine level, so that the
confirmed optimum meets it fully. Feasible is not optimal: the ratios to the coarse level are exact at the
confirmed rows, but slopes between them may be wrong.
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
"""Most confirmations of one optimum."""


@dataclass(frozen=True)
class Violation:
    """A criterion that the best place does not meet: by how much [SI], and relative to its limit."""

    criterion: str
    by: float
    relative: float


@dataclass(frozen=True)
class Optimum:
    """The best confirmed place, how it was reached, and what it cost.

    Attributes
    ----------
    state
        `settled`: promise and truth agree, all criteria are met. `unconfirmed`: so do they, but the error of
        a criterion at the fine level is not known. `undecided`: they agree, but a limit lies in
        the band of the fine level. `infeasible`: they agree, and nowhere that the search looked all criteria
        are met. `not_settled`: they do not agree after the last round, or the fine level refuses the place.
    best
        The round that counts: of those that meet all criteria the one with the best objective; if it is
        infeasible, the one of least violation; else the last.
    violations
        Criteria that `best` does not meet, the least violated first.
    explored, confirmations
        Rows asked of the coarse and of the fine level.
    seconds
        What both cost, as the answers state it.
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
        What to vary, to optimise and to hold.
    explore, confirm
        The results at the coarse level, asked for thousands of rows, and at the fine one, asked for a few.
    seed
        Of the scan; equal seeds and answers give equal optima.
    rounds
        Most confirmations.
    within
        Relative difference between promise and truth that counts as agreement.

    Raises
    ------
    InvalidInputs
        With code `all_refused`, if no row of the scan has results.
    """
    run = Run(problem, explore, confirm, seed, within)
    done: list[Round] = []
    state: State | None = None
    while state is None and len(done) < rounds:
        unit = _next(run)
        (confirmed,), fine = run.confirmed(unit)
        done.append(confirmed)
        state = _state(done)
        run.learn(unit, [confirmed], fine)
    return _optimum(run, done, state)


def _next(run: Run) -> Array:
    """Return the place to confirm, shape (1, d): the optimum by all that is known.

    If nothing is feasible by that, and the place next to the limits is known already, it is a place far from
    all that are known: the corrections may be what is wrong there.
    """
    place = best(run.surface, run.scanned, tuple(run.surface.places[-1:]))
    if place.violation > 0 and run.surface.is_known(place.unit):
        return run.unknown_place()
    return place.unit[None]


def _state(done: list[Round]) -> State | None:
    """Return the state in which the search ends with the last round; None if it goes on."""
    confirmed = done[-1]
    if not np.isfinite(confirmed.confirmed).all():
        return "not_settled"
    if not confirmed.agrees:
        return None
    if confirmed.is_met:
        return state_of_met([confirmed])
    looks_elsewhere = not confirmed.is_feasible and not done[0].agrees
    if confirmed.fell_short or looks_elsewhere:
        return None  # hold the bands, or a little more; or doubt the corrections first
    return unmet([confirmed])


def _optimum(run: Run, done: list[Round], state: State | None) -> Optimum:
    """Return the optimum, from the rounds done; without a state it is in vain or has not settled."""
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
    """Return the criteria that a place does not meet, the least violated first; `scales` [SI], shape (m,)."""
    count, held = len(problem.objectives), len(problem.held)
    values, limits = place.confirmed[count : count + held], place.confirmed[count + held :]
    by = (-problem.signs * (values - limits)).tolist()
    each = zip(problem.held, by, (by / scales).tolist(), strict=True)
    violations = [Violation(one.name, short, relative) for one, short, relative in each if short > 0]
    return tuple(sorted(violations, key=lambda one: one.relative))
