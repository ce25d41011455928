"""Jobs over HTTP: look, list, cancel, watch."""

import asyncio
from collections.abc import AsyncIterator

from fastapi import APIRouter, Depends
from fastapi.sse import EventSourceResponse, ServerSentEvent

from app.api.dependencies import OneStream, TheJobs
from app.api.gate.clients import TheClient
from app.api.paging import Cursor, Limit, page
from app.api.reading import StrictRoute
from app.jobs.job import Job
from app.schemas.jobs import Job as JobAnswer
from app.schemas.jobs import JobList
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/jobs", tags=["jobs"], route_class=StrictRoute)


@router.get("")
def list_jobs(jobs: TheJobs, limit: Limit = 50, cursor: Cursor = None) -> JobList:
    """List jobs, newest first."""
    rows = jobs.page(limit + 1, before=cursor)
    return page(JobList, rows, limit, show=JobAnswer.model_validate, cursor=lambda job: job.id)


@router.get("/{id}", responses=refusals(404), response_model=JobAnswer)
def show_job(id: str, jobs: TheJobs) -> Job:
    """Show a job."""
    return jobs.get(id)


@router.delete("/{id}", responses=refusals(404, 409), response_model=JobAnswer)
def cancel_job(id: str, jobs: TheJobs, client: TheClient) -> Job:
    """Cancel a job that is queued or running; one that another client asked for too goes on for that."""
    return jobs.cancel(id, client)


@router.get(
    "/{id}/events",
    response_class=EventSourceResponse,
    dependencies=[Depends(show_job)],
    responses=refusals(404, 429),
)
async def watch_job(id: str, jobs: TheJobs, place: OneStream) -> AsyncIterator[ServerSentEvent]:
    """Stream the events of a job until it has ended: its state with the whole job, and its progress."""
    async with jobs.events.subscribe(f"job:{id}") as events:
        job = await asyncio.to_thread(jobs.get, id)
        yield _state(job)
        while not job.finished and (event := await anext(events, None)):
            if event["event"] == "progress":
                yield ServerSentEvent(event="progress", data=event)
            else:
                job = await asyncio.to_thread(jobs.get, id)
                yield _state(job)


def _state(job: Job) -> ServerSentEvent:
    return ServerSentEvent(event=job.state, data=JobAnswer.model_validate(job))
