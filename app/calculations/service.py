"""Evaluate and solve a template: convert a request into an answer in plain JSON."""

from __future__ import annotations

import numpy as np

from app.calculations import json_values
from app.calculations.bodies import EvaluateIn, SolveIn
from app.calculations.errors import TooManyValues
from app.plain import JsonObject
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.question import read_question
from templates.core.language.request import read_request, require_points
from templates.core.language.solve import solve
from templates.core.language.template import Template

MOST_VALUES = 2_000_000  # in one answer: about 40 MB of JSON


def run_evaluate(cls: type[Template], body: EvaluateIn) -> JsonObject:
    """Evaluate a template as `evaluated` does, and return the answer as plain JSON."""
    return json_values.evaluation(evaluated(cls, body))


def evaluated(cls: type[Template], body: EvaluateIn) -> Evaluation:
    """Evaluate a template.

    Raises
    ------
    InvalidInputs
        If inputs are wrong; the error lists all of them.
    TooManyValues
        If the answer would be too large.
    """
    _limit_answer(cls, body)
    result = evaluate(
        cls,
        body.inputs,
        outputs=body.outputs,
        units=body.units,
        level=body.level,
        tolerance=body.tolerance,
        per_point=body.per_point,
        limits=body.limits,
    )
    _limit(result.count())  # curves are longer than their inputs
    return result


def check_evaluate(cls: type[Template], body: EvaluateIn) -> None:
    """Check a request to evaluate, as far as possible without calculating.

    Raises
    ------
    InvalidInputs
        If inputs are wrong; the error lists all of them.
    TooManyValues
        If the answer would be too large.
    """
    _limit_answer(cls, body)
    request = read_request(cls, body.inputs, body.outputs, body.units, body.level, body.limits)
    with np.errstate(all="ignore"):
        require_points(request.template, body.level, body.tolerance)


def check_solve(cls: type[Template], body: SolveIn) -> None:
    """Check a request to solve, as far as possible without calculating.

    Raises
    ------
    InvalidInputs
        If inputs are wrong; the error lists all of them.
    """
    read_question(
        cls,
        body.inputs,
        body.unknown,
        body.between,
        body.target,
        outputs=body.outputs,
        units=body.units,
        level=body.level,
    )


def _limit_answer(cls: type[Template], body: EvaluateIn) -> None:
    outputs = len(cls.formulas) if body.outputs is None else len(body.outputs)
    _limit(body.points * max(1, outputs))


def _limit(values: int) -> None:
    if values > MOST_VALUES:
        message = f"{values} values in one answer are more than {MOST_VALUES}; name fewer outputs or points"
        raise TooManyValues(message)


def run_solve(cls: type[Template], body: SolveIn) -> JsonObject:
    """Find the value of one input that gives a wanted output, and return the answer as plain JSON.

    Raises
    ------
    InvalidInputs
        If inputs are wrong; the error lists all of them.
    Unreachable
        If no value of the input gives the output; the error states the reachable range.
    """
    solution = solve(
        cls,
        body.inputs,
        body.unknown,
        body.between,
        body.target,
        outputs=body.outputs,
        units=body.units,
        level=body.level,
        tolerance=body.tolerance,
    )
    return json_values.solution(solution)
