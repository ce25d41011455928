"""`/evaluations/{job}`: the answer of a calculation that went on as a job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheAnswering, TheJobs, TheStore
from app.api.file_answers import UNAVAILABLE, rebuilding
from app.api.responses import LATER, accepted, finished
from app.calculations.array_files import MEDIA_TYPES
from app.calculations.jobs import ANSWERS, CalculationJobs
from app.calculations.schemas.evaluations import AnyCalculation
from app.designs.schemas.decision import Decision
from app.designs.schemas.designs import Preview
from app.designs.schemas.solution import DesignSolution
from app.designs.schemas.variants import VariantDetail
from app.http import problems
from app.http.access import TheClient
from app.http.pace import PiecesResponse
from app.http.problem_kinds import INTERNAL
from app.impact.schemas import Impact
from app.jobs.errors import JobNotFound
from app.jobs.repository import Job
from app.jobs.service import Jobs
from app.schemas.problems import refusals
from app.storage.artifacts import Artifacts
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.tolerances.schemas import ToleranceAnalysis
from app.workers.pieces import Pieces

router = APIRouter(prefix="/api/v1/evaluations", tags=["templates"])


@router.get(
    "/{job}",
    response_model=AnyCalculation
    | Preview
    | Decision
    | DesignSolution
    | ToleranceAnalysis
    | Impact
    | VariantDetail,
    responses={**LATER, **UNAVAILABLE, **refusals(404, 409, 429)},
)
async def show_evaluation(
    job: Annotated[str, Path(max_length=64)],
    jobs: TheJobs,
    store: TheStore,
    answering: TheAnswering,
    client: TheClient,
    request: Request,
    prefer: Annotated[str | None, Header(description="`wait=5`, for an answer that was lost")] = None,
) -> Response:
    """The answer of an `evaluate`, `solve`, `preview`, `impact` or the like; 202 while its job still runs.

    An answer that was lost is calculated again: the same, but for the time that it took.
    """
    row = await run_in_threadpool(_calculation, jobs, job)
    if not row.finished:
        return accepted(job)
    if row.result is None:
        return problems.answer(row.problem or problems.problem(INTERNAL, "the job left no answer"))
    try:
        stored = await run_in_threadpool(stored_answer, store, row)
    except (ArtifactMissing, ArtifactDamaged) as lost:
        if unavailable := await _calculated_again(answering.jobs, row, client, prefer, lost.sha):
            return unavailable
        row = await run_in_threadpool(_calculation, jobs, job)
        stored = await run_in_threadpool(stored_answer, store, row)
    media_type = MEDIA_TYPES[row.payload.get("form", "json")]
    return PiecesResponse(stored, request.app.state.pace, media_type)


async def _calculated_again(
    calculations: CalculationJobs, row: Job, client: str, prefer: str | None, sha: str
) -> Response | None:
    """None once the job has its answer again; else what to send in its place."""
    jobs = calculations.jobs
    again = await run_in_threadpool(calculations.request_again, row, client)
    if not await finished(jobs, again, prefer):
        return rebuilding(sha, again)
    problem = await run_in_threadpool(jobs.problem, again)
    return problems.answer(problem) if problem else None


def _calculation(jobs: Jobs, id: str) -> Job:
    """Return the job, if its result is an answer; raises JobNotFound."""
    row = jobs.get(id)
    if row.kind not in ANSWERS:
        raise JobNotFound(id)
    return row


def stored_answer(store: Artifacts, row: Job) -> Pieces:
    """Return the answer from the store; raises ArtifactMissing, ArtifactDamaged."""
    assert row.result is not None
    return Pieces.of(store.read(row.result.rpartition("sha256=")[2]))
