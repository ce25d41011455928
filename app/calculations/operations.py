"""The operations on a template, by name: each turns the bytes of a request into the bytes of an answer.

`answered` runs in a calculation process. Python's interpreter lock is held while a large body is read or a
large answer is written, for about as long as the calculation takes, so the process does both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import from_json, to_json

from app.calculations.array_files import MEDIA_TYPES, Form, npy
from app.calculations.bodies import CalculationRequest, EvaluateIn, SolveIn
from app.calculations.errors import InvalidBody
from app.calculations.service import check_evaluate, check_solve, evaluated, run_evaluate, run_solve
from app.calculations.worksheet import run_worksheet
from app.pool.sources import Source, loaded
from app.presentation.units import System
from app.workers.pieces import Pieces
from templates.core.language.template import Template


@dataclass(frozen=True)
class Operation:
    """An operation: the model of its body, a check without calculation, and a writer for each format."""

    body: type[CalculationRequest]
    check: Callable[[type[Template], Any], None]  # takes an object of `body`
    write: Mapping[Form, Callable[[type[Template], Any, System], bytes]]


LARGE = 256 * 1024  # bytes of a body that is read in the process that calculates

OPERATIONS = {
    "evaluate": Operation(
        EvaluateIn,
        check_evaluate,
        {
            "json": lambda cls, body, system: to_json(run_evaluate(cls, body)),
            "npy": lambda cls, body, system: npy(evaluated(cls, body)),
        },
    ),
    "solve": Operation(
        SolveIn, check_solve, {"json": lambda cls, body, system: to_json(run_solve(cls, body))}
    ),
    "worksheet": Operation(
        EvaluateIn, check_evaluate, {"json": lambda *asked: to_json(run_worksheet(*asked))}
    ),
}


@dataclass(frozen=True)
class Question:
    """A calculation request, as it is sent to a process and stored in a job."""

    template: str
    version: int
    operation: str
    body: Pieces
    system: System = "si"
    form: Form = "json"
    """Format of the answer; only `evaluate` offers a format other than JSON."""

    @property
    def media_type(self) -> str:
        """Return the media type of the answer."""
        return MEDIA_TYPES[self.form]


def answered(source: Source, question: Question) -> Pieces:
    """Return the answer in the requested format.

    Raises
    ------
    InvalidBody
        If the body is not JSON, or does not fit the operation.
    NoArray
        If an array is requested and the outputs do not fit into one.
    TemplateError, TooManyValues
        As raised by the operation.
    """
    operation = OPERATIONS[question.operation]
    body = _read(operation.body, question.body.joined())
    return Pieces.of(operation.write[question.form](loaded(source), body, question.system))


def check(cls: type[Template], question: Question) -> None:
    """Check a request as far as possible without calculating.

    Raises
    ------
    InvalidBody, TemplateError, TooManyValues
        As raised by `answered`.
    """
    operation = OPERATIONS[question.operation]
    operation.check(cls, _read(operation.body, question.body.joined()))


def checked(source: Source, question: Question) -> None:
    """Check a request as `check` does, in a calculation process."""
    check(loaded(source), question)


def _read(model: type[CalculationRequest], body: bytes) -> CalculationRequest:
    try:
        raw = from_json(body)
    except ValueError as error:
        raise InvalidBody.not_json(str(error)[:200]) from None
    try:
        return model.model_validate(
            raw, from_attributes=True
        )  # as FastAPI does, so that faults read the same
    except ValidationError as error:
        raise InvalidBody.of(error) from None
