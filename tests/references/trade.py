"""Compares choices of levels: the optimum, its predicted value, and the value at the confirming level."""

from __future__ import annotations

from collections.abc import Mapping

from app.studies.methods.answers import Answer, Problem
from app.studies.methods.optimise import Optimum, optimise


def trade(
    problem: Problem, levels: Mapping[str, Answer], confirm: Answer, *, seed: int
) -> dict[str, Optimum]:
    """Return for each level the optimum that it finds alone, confirmed once and not corrected.

    The `best` of an optimum has `at`, `promise`, `confirmed` and `verdicts`; rows and cost stand beside it.
    All levels are scanned at the same rows.

    Raises
    ------
    InvalidInputs
        With code `all_refused`, if no row of a scan has results.
    """
    return {name: optimise(problem, answer, confirm, seed=seed, rounds=1) for name, answer in levels.items()}
