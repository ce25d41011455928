"""`/designs/{id}/tolerance`: what the tolerances of a design do to its outputs and criteria."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.dependencies import ExpensiveSteps, TheThreads, TheTolerances, Units
from app.api.responses import LATER
from app.designs.questions import Asked
from app.designs.routes.designs import Id, Prefer
from app.designs.routes.solution import answer_asked
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals
from app.tolerances.bodies import ToleranceIn
from app.tolerances.schemas import ToleranceAnalysis

router = APIRouter(
    prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)


@router.post(
    "/{id}/tolerance",
    response_model=ToleranceAnalysis,
    responses={**LATER, **refusals(404, 422, 429)},
    dependencies=[needs("viewer")],
)
async def analyse_tolerances(
    id: Id,
    tolerances: TheTolerances,
    threads: TheThreads,
    client: TheClient,
    request: Request,
    body: ToleranceIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Analyse the tolerances of the newest revision: worst case, scatter, shares, yields."""
    asked = Asked(id, (body or ToleranceIn()).model_dump_json(exclude_unset=True), units=units)
    return await answer_asked(tolerances, asked, threads, request, client, prefer)
