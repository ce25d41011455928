"""`/templates/{id}/versions/{number}/impact`: the designs that this version would change, and how."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.answers import answered
from app.api.dependencies import TheImpacts, Units
from app.api.responses import LATER, patience
from app.catalogue.routes.templates import Id, Number
from app.designs.routes.designs import Prefer
from app.http.access import TheClient
from app.http.strict_requests import StrictRoute
from app.impact.bodies import ImpactIn
from app.impact.schemas import Impact
from app.impact.survey import ImpactQuestion
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)


@router.post(
    "/{id}/versions/{number}/impact",
    response_model=Impact,
    responses={**LATER, **refusals(404, 409, 422, 429)},
)
async def show_impact(
    id: Id,
    number: Number,
    impacts: TheImpacts,
    client: TheClient,
    request: Request,
    body: ImpactIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Calculate every design that uses another version as if it used this one; nothing is saved.

    The changed designs are sorted worst first. The answer is 202 with a job if the calculation takes longer
    than the client waits.
    """
    asked = ImpactQuestion(id, number, body or ImpactIn(), units)
    return await answered(impacts, asked, request, client, patience(prefer, impacts.jobs.wait_seconds))
