"""`/designs/{id}/decide`: levels climb only where a criterion is undecided."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.dependencies import ExpensiveSteps, TheDecisions, TheThreads, Units
from app.api.responses import accepted, later, patience, written
from app.designs.bodies import DecideIn
from app.designs.decisions import LONGEST_BUDGET, Asked, read_budget
from app.designs.routes.designs import Id, Prefer
from app.designs.schemas.decision import Decision
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(
    prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)


@router.post(
    "/{id}/decide",
    response_model=Decision,
    responses={**later(Decision), **refusals(404, 429)},
    dependencies=[needs("viewer")],
)
async def decide_criteria(
    id: Id,
    decisions: TheDecisions,
    threads: TheThreads,
    client: TheClient,
    request: Request,
    body: DecideIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Decide the criteria of the newest revision: finer levels where they are undecided; nothing is saved."""
    wanted = body or DecideIn()
    asked = Asked(id, wanted.criteria, read_budget(wanted.budget), units=units)
    seconds = patience(prefer, LONGEST_BUDGET)
    answer, job = await threads.run_within(seconds, request, decisions.in_parts, asked, client)
    return accepted(job, answer) if job else written(answer)
