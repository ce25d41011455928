"""`/designs/{id}/tolerance`: the effect of a design's tolerances on its outputs and criteria."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.answers import answered
from app.api.dependencies import TheTolerances, Units
from app.api.responses import LATER, patience
from app.designs.questions import DesignQuestion
from app.designs.routes.designs import Id, Prefer
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals
from app.tolerances.bodies import ToleranceIn
from app.tolerances.schemas import ToleranceAnalysis

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)


@router.post(
    "/{id}/tolerance",
    response_model=ToleranceAnalysis,
    responses={**LATER, **refusals(404, 422, 429)},
    dependencies=[needs("viewer")],
)
async def analyse_tolerances(
    id: Id,
    tolerances: TheTolerances,
    client: TheClient,
    request: Request,
    body: ToleranceIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Analyse the tolerances of the newest revision: worst case, scatter, shares of variance, yields."""
    asked = DesignQuestion(id, (body or ToleranceIn()).model_dump_json(exclude_unset=True), units=units)
    return await answered(tolerances, asked, request, client, patience(prefer, tolerances.steps.deadline))
