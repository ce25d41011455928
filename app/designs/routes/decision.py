"""`/designs/{id}/decide`: refine the levels of steps whose criteria are undecided or of unknown error."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.answers import answered
from app.api.dependencies import TheDecisions, Units
from app.api.responses import later, patience
from app.designs.bodies import DecideIn
from app.designs.decisions import LONGEST_BUDGET, DecisionQuestion, read_budget
from app.designs.routes.designs import Id, Prefer
from app.designs.schemas.decision import Decision
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)


@router.post(
    "/{id}/decide",
    response_model=Decision,
    responses={**later(Decision), **refusals(404, 429)},
    dependencies=[needs("viewer")],
)
async def decide_criteria(
    id: Id,
    decisions: TheDecisions,
    client: TheClient,
    request: Request,
    body: DecideIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Decide the criteria of the newest revision and of its variants; nothing is saved.

    The service calculates finer levels where a criterion is undecided, or where the error of its value is
    unknown.
    """
    wanted = body or DecideIn()
    asked = DecisionQuestion(
        id, wanted.criteria, read_budget(wanted.budget), units=units, estimate_only=wanted.estimate_only
    )
    return await answered(decisions, asked, request, client, patience(prefer, LONGEST_BUDGET))
