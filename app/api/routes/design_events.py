"""`/designs/{id}/events`: a design's revisions and regenerations as they happen (server-sent events)."""

from __future__ import annotations

from collections.abc import AsyncIterator

from fastapi import APIRouter, Depends
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import OneStream, TheDesigns, TheJobs
from app.api.reading import StrictRoute
from app.api.routes.designs import Id, show_design

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

# How a design names the events of its job.
NAMES = {"queued": "regenerating", "running": "regenerating", "done": "current", "cancelled": "failed"}


@router.get("/{id}/events", response_class=EventSourceResponse, dependencies=[Depends(show_design)])
async def watch_design(
    id: Id, designs: TheDesigns, jobs: TheJobs, place: OneStream
) -> AsyncIterator[ServerSentEvent]:
    """The state first, then `revision`, `regenerating`, `progress`, `current`, `failed` as they come."""
    async with jobs.events.subscribe(f"design:{id}") as events:
        now = await run_in_threadpool(designs.state, id)
        yield ServerSentEvent(event=now["state"], data=now)
        async for event in events:
            name = event["event"]
            yield ServerSentEvent(event=NAMES.get(name, name), data=event)
