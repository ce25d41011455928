"""`/templates/{id}/versions/{number}/impact`: which designs another version moves, and how."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheImpacts, TheJobs, TheStore, Units
from app.api.responses import LATER, accepted, finished
from app.calculations.routes.evaluations import stored_answer
from app.catalogue.routes.templates import Id, Number
from app.designs.routes.designs import Prefer
from app.http import problems
from app.http.access import TheClient
from app.http.pace import PiecesResponse
from app.http.problem_kinds import INTERNAL
from app.http.strict_requests import StrictRoute
from app.impact.bodies import ImpactIn
from app.impact.schemas import Impact
from app.impact.survey import Asked
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
    jobs: TheJobs,
    store: TheStore,
    client: TheClient,
    request: Request,
    body: ImpactIn | None = None,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Calculate every design that uses another version as if it used this one; nothing is saved.

    The worst of the designs that move come first. 202 with a job where it takes longer than is waited for.
    """
    asked = Asked(id, number, body or ImpactIn(), units)
    job = await run_in_threadpool(impacts.requested, asked, client)
    if not await finished(jobs, job, prefer):
        return accepted(job)
    row = await run_in_threadpool(jobs.get, job)
    if row.result is None:
        return problems.answer(row.problem or problems.problem(INTERNAL, "the job left no answer"))
    return PiecesResponse(await run_in_threadpool(stored_answer, store, row), request.app.state.pace)
