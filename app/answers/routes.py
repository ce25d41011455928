"""`/answer`: the values of free places that meet requirements, with the proof."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.answers.bodies import AnswerIn
from app.answers.schemas import DesignAnswer
from app.answers.service import question_of
from app.api.answers import answered
from app.api.dependencies import TheAnswers, TheCatalogues, TheOnce, Units
from app.api.responses import LATER, patience
from app.designs.routes.designs import IfMatch, Prefer
from app.http.access import TheClient, needs
from app.http.strict_requests import PreconditionRequired, StrictRoute
from app.identity.errors import RoleNeeded
from app.identity.principal import acting
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1", tags=["answers"], route_class=StrictRoute)


@router.post(
    "/answer",
    response_model=DesignAnswer,
    responses={**LATER, **refusals(404, 409, 422, 429)},
    dependencies=[needs("viewer")],
)
async def answer_requirements(
    body: AnswerIn,
    answers: TheAnswers,
    catalogues: TheCatalogues,
    client: TheClient,
    once: TheOnce,
    request: Request,
    units: Units = "si",
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Find the values of free places that meet requirements, or name the requirements that conflict.

    Verdicts are those of the chosen values: on their grid, at both ends of a fit, at the finest levels.
    Nothing is saved unless `save` is true; then an existing design needs If-Match, and the sender the role
    author. An infeasible request saves nothing.
    """
    asked = question_of(body, units, client, once, if_match, catalogues)
    if body.save and not acting().may("author"):
        raise RoleNeeded(acting(), ["author"])
    if body.save and asked.design and if_match is None:
        raise PreconditionRequired('send If-Match with the ETag of the design you read, such as "3"')
    return await answered(answers, asked, request, client, patience(prefer, answers.steps.deadline))
