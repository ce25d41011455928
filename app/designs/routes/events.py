"""`/designs/{id}/events`: the stream of a design's new revisions and regenerations (server-sent events)."""

from __future__ import annotations

from collections.abc import AsyncIterator

from fastapi import APIRouter, Depends
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import OneStream, TheDatabase, TheDesigns, TheJobs
from app.api.event_streams import LastEvent, allowed, identity, listening
from app.designs.repository import RegenerationState, can_resume, standing
from app.designs.routes.designs import Id
from app.http.strict_requests import StrictRoute
from app.storage.database import Database

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

# Names that a design's stream gives to the events of its job.
NAMES = {"queued": "regenerating", "running": "regenerating", "done": "current", "cancelled": "failed"}


def existing(id: Id, designs: TheDesigns) -> None:
    """Refuse the stream of a design that does not exist.

    Raises
    ------
    NotFound
        If there is no such design.
    """
    designs.show(id)


@router.get("/{id}/events", response_class=EventSourceResponse, dependencies=[Depends(existing)])
async def watch_design(
    id: Id, database: TheDatabase, jobs: TheJobs, place: OneStream, last: LastEvent
) -> AsyncIterator[ServerSentEvent]:
    """Stream the state of a design, then its events.

    The events are `revision`, `regenerating`, `progress`, `current` and `failed`. A client that reconnects
    gets the events after its last one instead of the state, if they are still stored.
    """
    async with listening(jobs.events, f"design:{id}") as events:
        now = await run_in_threadpool(_start, database, id, last)
        if now is None:
            events.resume(last or 0)
        else:
            events.number = now.number
            data = {"revision": now.revision, "state": now.state, "problem": now.problem}
            yield ServerSentEvent(id=identity(now.number), event=now.state, data=data)
        async for event in allowed(events, place):
            name = NAMES.get(event.name, event.name)
            yield ServerSentEvent(id=identity(event.number), event=name, data=event.message)


def _start(database: Database, id: str, last: int | None) -> RegenerationState | None:
    """Return the state of a design; None if the client can continue after the last event it received."""
    with database.read() as session:
        return None if can_resume(session, id, last) else standing(session, id)
