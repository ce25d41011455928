"""Answers to questions that may take long: the answer itself, or the job that makes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from pydantic import TypeAdapter
from pydantic_core import to_json
from starlette.responses import Response

from app.api.expensive_answers import to_try
from app.calculations.bodies import Asked
from app.calculations.operations import OPERATIONS, Question
from app.calculations.routes.evaluations import show_evaluation
from app.http.pace import PiecesResponse
from app.pool.cost import EXPENSIVE
from app.presentation.units import System
from app.schemas.problems import Problem
from app.web.shared.services import PageServices, Refused
from app.workers.pieces import Pieces
from templates.core.language.template import Template

Kind = TypeVar("Kind")
Body = TypeVar("Body", bound=Asked)
ACCEPTED = 202


@dataclass(frozen=True)
class Answered(Generic[Kind]):
    """An answer, or the id of the job that makes it."""

    answer: Kind | None
    job: str = ""


@dataclass(frozen=True)
class TemplateQuestion(Generic[Body]):
    """A question about a version of a template: an operation, its body, and the units of its answer."""

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
) -> Answered[Kind]:
    """Return the answer about a template; of an expensive one the job, if it is not there in time [s].

    Raises
    ------
    Refused
        With everything that is wrong.
    """
    cls = await services.ask(to_try(services.catalogues, asked.template, asked.version))
    if await services.run(seconds_needed, cls, asked.body) <= EXPENSIVE:
        write = OPERATIONS[asked.operation].write["json"]
        return Answered(_read(kind, await services.run(write, cls, asked.body, asked.units)))
    body = Pieces.of(to_json(asked.body.model_dump(exclude_unset=True, by_alias=True)))
    question = Question(asked.template, asked.version, asked.operation, body, asked.units, "json")
    return _answered(await services.ask(services.answering.answer(services.request, question, within)), kind)


async def stored(services: PageServices, job: str, kind: type[Kind]) -> Answered[Kind]:
    """Return the answer that a job has made, or the job while it still runs.

    Raises
    ------
    Refused
        If there is no such job, or it has failed.
    """
    look = show_evaluation(
        job, services.jobs, services.store, services.answering, services.client, services.request
    )
    return _answered(await services.ask(look), kind)


def _answered(response: Response, kind: type[Kind]) -> Answered[Kind]:
    if response.status_code >= 400:
        raise Refused(Problem.model_validate_json(bytes(response.body)))
    if response.status_code == ACCEPTED:
        return Answered(None, response.headers["Location"].rpartition("/")[2])
    if isinstance(response, PiecesResponse):
        return Answered(_read(kind, response.pieces.joined()))
    return Answered(_read(kind, bytes(response.body)))


def _read(kind: type[Kind], content: bytes) -> Kind:
    return TypeAdapter(kind).validate_json(content)
