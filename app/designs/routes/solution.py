"""`/designs/{id}/solve`: which value of one parameter or input gives a wanted output."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.api.dependencies import ExpensiveSteps, TheSolving, TheThreads, Units
from app.api.responses import LATER, Threads, accepted, patience, written
from app.designs.questions import A, Asked, Questions
from app.designs.routes.designs import Id, Prefer
from app.designs.schemas.solution import DesignSolution
from app.designs.solution import SolveDesignIn
from app.http.access import TheClient, needs
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(
    prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)


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
    threads: TheThreads,
    client: TheClient,
    request: Request,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Find every value of one parameter or input that gives a wanted output; nothing is saved."""
    asked = Asked(id, body.model_dump_json(exclude_unset=True, by_alias=True), units=units)
    return await answer_asked(solving, asked, threads, request, client, prefer)


async def answer_asked(
    questions: Questions[Asked, A],
    asked: Asked,
    threads: Threads,
    request: Request,
    client: str,
    prefer: str | None,
) -> Response:
    """Return the answer to a question about a design; 202 with its job where that takes too long."""
    seconds = patience(prefer, questions.steps.deadline)
    answer, job = await threads.run_within(seconds, request, questions.answer, asked, client)
    return accepted(job) if answer is None else written(answer)
