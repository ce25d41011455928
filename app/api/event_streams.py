"""Event streams that resume where the client left off, by `id` and `Last-Event-ID` of the HTML standard.

Browsers send `Last-Event-ID` automatically when they reconnect.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Header
from fastapi.sse import ServerSentEvent
from starlette.concurrency import run_in_threadpool

from app.jobs.events import Event, Events, Subscription
from app.schemas.answers import Answer
from app.storage.errors import DatabaseUnavailable


async def last_event(
    last_event_id: Annotated[
        str | None,
        Header(
            pattern="^[0-9]{0,18}$",
            description="the `id` of the last event that the client got: the stream goes on after it",
        ),
    ] = None,
) -> int | None:
    """Return the number of the last event that the client received; None if it received none."""
    return int(last_event_id) if last_event_id else None


LastEvent = Annotated[int | None, Depends(last_event)]


Still = Callable[[], Awaitable[bool]]
"""Function that checks whether the client may still listen: its key may have been revoked."""


async def always() -> bool:
    """Return True at once: if the service requires no keys, every stream may continue."""
    return True


async def allowed(events: Subscription, still: Still) -> AsyncIterator[Event]:
    """Yield events as they arrive, as long as the listener may receive them."""
    async for event in events:
        if not await still():
            return
        yield event


@asynccontextmanager
async def listening(events: Events, topic: str) -> AsyncIterator[Subscription]:
    """Listen to a topic; if the database becomes unavailable, the stream ends and the client reconnects."""
    with suppress(DatabaseUnavailable):
        async with events.subscribe(topic) as subscription:
            yield subscription


def identity(number: int | None) -> str | None:
    """Return the `id` of an event.

    An event that is not stored has no id, so the client keeps the previous one.
    """
    return None if number is None else str(number)


@dataclass(frozen=True)
class Whole:
    """The complete content that a stream sends with every event, and the number of that event."""

    number: int
    state: str
    data: Answer
    has_ended: bool

    @property
    def event(self) -> ServerSentEvent:
        """Return the content as an event."""
        return ServerSentEvent(id=identity(self.number), event=self.state, data=self.data)


async def as_it_stands(
    events: Subscription, still: Still, read: Callable[[], Whole], last: int | None, **more: str
) -> AsyncIterator[ServerSentEvent]:
    """Yield the content whenever it changes, with its progress by `more`, until the work has ended.

    A client that already has the current state receives only later changes.
    """
    now = await run_in_threadpool(read)
    events.number = now.number
    if now.number != last:
        yield now.event
    if now.has_ended:
        return
    async for event in allowed(events, still):
        if event.number is None:
            yield ServerSentEvent(event=event.name, data={**event.message, **more})
            continue
        now = await run_in_threadpool(read)
        events.number = now.number
        yield now.event
        if now.has_ended:
            return
