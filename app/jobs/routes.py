"""Routes that show, list, cancel and watch jobs."""

from collections.abc import AsyncIterator
from functools import partial

from fastapi import APIRouter, Depends
from fastapi.sse import EventSourceResponse, ServerSentEvent

from app.api.dependencies import OneStream, TheJobs
from app.api.event_streams import LastEvent, Whole, as_it_stands, listening
from app.http.access import TheClient, needs
from app.http.pages import Cursor, Limit, page
from app.http.strict_requests import StrictRoute
from app.jobs.repository import Job
from app.jobs.schemas import Job as JobAnswer
from app.jobs.schemas import JobList
from app.jobs.service import Jobs
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/jobs", tags=["jobs"], route_class=StrictRoute)


@router.get("", dependencies=[needs("viewer", "admin")])
def list_jobs(jobs: TheJobs, limit: Limit = 50, cursor: Cursor = None) -> JobList:
    """List jobs, newest first."""
    rows = jobs.page(limit + 1, before=cursor)
    return page(JobList, rows, limit, show=JobAnswer.model_validate, cursor=lambda job: job.id)


@router.get(
    "/{id}", responses=refusals(404), response_model=JobAnswer, dependencies=[needs("viewer", "admin")]
)
def show_job(id: str, jobs: TheJobs) -> Job:
    """Show a job."""
    return jobs.get(id)


@router.delete(
    "/{id}",
    responses=refusals(403, 404, 409),
    response_model=JobAnswer,
    dependencies=[needs("viewer", "admin")],
)
def cancel_job(id: str, jobs: TheJobs, client: TheClient) -> Job:
    """Cancel a queued or running job; a job that another client also requested continues."""
    return jobs.cancel(id, client)


@router.get(
    "/{id}/events",
    response_class=EventSourceResponse,
    dependencies=[Depends(show_job), needs("viewer", "admin")],
    responses=refusals(404, 429),
)
async def watch_job(
    id: str, jobs: TheJobs, place: OneStream, last: LastEvent
) -> AsyncIterator[ServerSentEvent]:
    """Stream the events of a job until it has ended: its state with the whole job, and its progress."""
    async with listening(jobs.events, f"job:{id}") as events:
        async for event in as_it_stands(events, place, partial(_whole, jobs, id), last):
            yield event


def _whole(jobs: Jobs, id: str) -> Whole:
    job = jobs.get(id)
    return Whole(job.event, job.state, JobAnswer.model_validate(job), job.finished)
