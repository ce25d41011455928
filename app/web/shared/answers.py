"""Answers to requests that may take long: the answer itself, or the job that computes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from pydantic import TypeAdapter
from pydantic_core import to_json

from app.api.answers import answer_of
from app.calculations.bodies import CalculationRequest
from app.calculations.operations import OPERATIONS, Question
from app.http.connections import PiecesResponse
from app.pool.cost import EXPENSIVE
from app.presentation.units import System
from app.schemas.problems import Problem
from app.web.shared.services import PageServices, Refused
from app.workers.pieces import Pieces
from templates.core.language.template import Template

Kind = TypeVar("Kind")
Body = TypeVar("Body", bound=CalculationRequest)
ACCEPTED = 202


@dataclass(frozen=True)
class AnswerOrJob(Generic[Kind]):
    """An answer, or the id of the job that computes it."""

    answer: Kind | None
    job: str = ""


@dataclass(frozen=True)
class TemplateQuestion(Generic[Body]):
    """A request about a version of a template: an operation, its body, and the units of its answer."""

    template: str
    version: int
    operation: str
    body: Body
    units: System = "si"


async def calculated(
    services: PageServices,
    asked: TemplateQuestion[Body],
    seconds_needed: Callable[[type[Template], Body], float],
    kind: type[Kind],
    within: float,
) -> AnswerOrJob[Kind]:
    """Return the answer about a template, or the job if the calculation takes longer than the given time [s].

    Raises
    ------
    Refused
        If there are faults; the error lists all of them.
    """
    cls = await services.ask(services.catalogues.tried(asked.template, asked.version))
    if await services.run(seconds_needed, cls, asked.body) <= EXPENSIVE:
        write = OPERATIONS[asked.operation].write["json"]
        return AnswerOrJob(_read(kind, await services.run(write, cls, asked.body, asked.units)))
    body = Pieces.of(to_json(asked.body.model_dump(exclude_unset=True, by_alias=True)))
    question = Question(asked.template, asked.version, asked.operation, body, asked.units, "json")
    kept, job = await services.calculate(within, services.evaluations.answer, question, services.client)
    return AnswerOrJob(None if kept is None else _read(kind, kept.joined()), job or "")


async def stored(services: PageServices, job: str, kind: type[Kind]) -> AnswerOrJob[Kind]:
    """Return the answer of a job, or the job itself while it is running.

    Raises
    ------
    Refused
        If there is no such job, or it has failed.
    """
    response = await services.ask(answer_of(services, job, services.request, services.client))
    if response.status_code >= 400:
        raise Refused(Problem.model_validate_json(bytes(response.body)))
    if response.status_code == ACCEPTED:
        return AnswerOrJob(None, response.headers["Location"].rpartition("/")[2])
    assert isinstance(response, PiecesResponse), "an answer is sent as it is kept"
    return AnswerOrJob(_read(kind, response.pieces.joined()))


def _read(kind: type[Kind], content: bytes) -> Kind:
    return TypeAdapter(kind).validate_json(content)
