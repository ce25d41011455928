"""`/evaluations/{job}`: the answer of a calculation that went on as a job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Response
from starlette.concurrency import run_in_threadpool

from app import problems
from app.calculations.answering import TheAnswering
from app.calculations.jobs import CALCULATION, CalculationJobs
from app.clients import TheClient
from app.dependencies import TheJobs, TheStore
from app.healing import UNAVAILABLE, rebuilding
from app.jobs.errors import JobNotFound
from app.jobs.job import Job
from app.jobs.service import Jobs
from app.storage.artifacts import ArtifactStore
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.waiting import LATER, accepted, finished

router = APIRouter(prefix="/api/v1/evaluations", tags=["templates"])


@router.get("/{job}", responses={**LATER, **UNAVAILABLE})
async def answer(
    job: Annotated[str, Path(max_length=64)],
    jobs: TheJobs,
    store: TheStore,
    answering: TheAnswering,
    client: TheClient,
    prefer: Annotated[str | None, Header(description="`wait=5`, for an answer that was lost")] = None,
) -> Response:
    """What `evaluate`, `solve` or `worksheet` would have answered; 202 while the job goes on.

    An answer that was lost is calculated again: the same, but for the time that it took.
    """
    row = await run_in_threadpool(_calculation, jobs, job)
    if not row.finished:
        return accepted(job)
    if row.result is None:
        return problems.answer(row.problem or problems.problem(problems.INTERNAL, "the job left no answer"))
    try:
        return await run_in_threadpool(_stored, store, row)
    except (ArtifactMissing, ArtifactDamaged) as lost:
        if unavailable := await _calculated_again(answering.jobs, row, client, prefer, lost.sha):
            return unavailable
    return await run_in_threadpool(_stored, store, await run_in_threadpool(_calculation, jobs, job))


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
    """The job, if it is one of a calculation; raises JobNotFound."""
    row = jobs.get(id)
    if row.kind != CALCULATION:
        raise JobNotFound(id)
    return row


def _stored(store: ArtifactStore, row: Job) -> Response:
    """The answer from the store; raises ArtifactMissing, ArtifactDamaged."""
    assert row.result is not None
    return Response(store.read(row.result.rpartition("sha256=")[2]), media_type="application/json")
