"""`/designs/{id}/solve`: find the values of one parameter or input that give a requested output."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.answers import answered
from app.api.dependencies import TheSolving, Units
from app.api.responses import LATER, patience
from app.designs.questions import DesignQuestion
from app.designs.routes.designs import Id, Prefer
from app.designs.schemas.solution import DesignSolution
from app.designs.solution import SolveDesignIn
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)


@router.post(
    "/{id}/solve",
    response_model=DesignSolution,
    responses={**LATER, **refusals(404, 422, 429)},
    dependencies=[needs("viewer")],
)
async def solve_design(
    id: Id,
    body: SolveDesignIn,
    solving: TheSolving,
    client: TheClient,
    request: Request,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Find every value of one parameter or input that gives a requested output; nothing is saved."""
    asked = DesignQuestion(id, body.model_dump_json(exclude_unset=True, by_alias=True), units=units)
    return await answered(solving, asked, request, client, patience(prefer, solving.steps.deadline))
