"""What can be asked of a template, by name: from the bytes of a request to the bytes of an answer.

`answered` runs in a calculation process. Reading a large body and writing a large answer hold the interpreter
as long as the calculation itself, so both are done there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import from_json, to_json

from app.calculations.errors import InvalidBody
from app.calculations.schemas import Asked, EvaluateIn, SolveIn
from app.calculations.service import check_evaluate, check_solve, run_evaluate, run_solve
from app.calculations.sources import Source, loaded
from app.calculations.worksheet import run_worksheet
from app.plain import JsonObject
from app.presentation.units import System
from app.workers.pieces import Pieces
from templates.core.language.template import Template


@dataclass(frozen=True)
class Operation:
    """What is asked, the model of the body that asks it, and what refuses it without calculating."""

    body: type[Asked]
    check: Callable[[type[Template], Any], None]  # takes an object of `body`
    run: Callable[[type[Template], Any, System], JsonObject]


LARGE = 256 * 1024  # bytes of a body that is read in the process that calculates

OPERATIONS = {
    "evaluate": Operation(EvaluateIn, check_evaluate, lambda cls, body, system: run_evaluate(cls, body)),
    "solve": Operation(SolveIn, check_solve, lambda cls, body, system: run_solve(cls, body)),
    "worksheet": Operation(EvaluateIn, check_evaluate, run_worksheet),
}


@dataclass(frozen=True)
class Question:
    """A request to calculate, as it is sent to a process and kept in a job."""

    template: str
    version: int
    operation: str
    body: Pieces
    system: System = "si"


def answered(source: Source, question: Question) -> Pieces:
    """The answer as JSON.

    Raises
    ------
    InvalidBody
        If the body is no JSON, or not what the operation takes.
    TemplateError, TooManyValues
        As the operation itself.
    """
    operation = OPERATIONS[question.operation]
    body = _read(operation.body, question.body.joined())
    return Pieces.of(to_json(operation.run(loaded(source), body, question.system)))


def check(cls: type[Template], question: Question) -> None:
    """Return if nothing is wrong with a question, as far as shows without calculating.

    Raises
    ------
    InvalidBody, TemplateError, TooManyValues
        As `answered`.
    """
    operation = OPERATIONS[question.operation]
    operation.check(cls, _read(operation.body, question.body.joined()))


def checked(source: Source, question: Question) -> None:
    """As `check`, in a calculation process."""
    check(loaded(source), question)


def _read(model: type[Asked], body: bytes) -> Asked:
    try:
        raw = from_json(body)
    except ValueError as error:
        raise InvalidBody.not_json(str(error)[:200]) from None
    try:
        return model.model_validate(raw, from_attributes=True)  # as FastAPI, whose words are used
    except ValidationError as error:
        raise InvalidBody.of(error) from None
