"""News within the process: published from any thread, read in event loops.

An event is a JSON object with its name under "event". The topics are `job:<id>` and `design:<id>`.
"""

import asyncio
import threading
from collections import defaultdict
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

from app.plain import JsonObject

Event = JsonObject

_ROOM = 100  # events that may wait for a slow reader before the oldest are dropped


class Events:
    """Topics and their subscribers. Nothing is kept for those who come later: they read the state first."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._subscribers: defaultdict[str, set[_Subscriber]] = defaultdict(set)
        self._closed = False

    def publish(self, topic: str, event: Event) -> None:
        """Send an event to all who listen; never blocks."""
        with self._lock:
            listeners = tuple(self._subscribers.get(topic, ()))
        for subscriber in listeners:
            subscriber.send(event)

    @asynccontextmanager
    async def subscribe(self, topic: str) -> AsyncIterator[AsyncIterator[Event]]:
        """Listen from now on; the iterator ends when the server closes."""
        subscriber = _Subscriber()
        self._add(topic, subscriber)
        try:
            yield subscriber.events()
        finally:
            self._remove(topic, subscriber)

    def close(self) -> None:
        """End all subscriptions, present and future."""
        with self._lock:
            self._closed = True
            everyone = [subscriber for group in self._subscribers.values() for subscriber in group]
        for subscriber in everyone:
            subscriber.send(None)

    def _add(self, topic: str, subscriber: "_Subscriber") -> None:
        with self._lock:
            self._subscribers[topic].add(subscriber)
            if self._closed:
                subscriber.send(None)

    def _remove(self, topic: str, subscriber: "_Subscriber") -> None:
        with self._lock:
            self._subscribers[topic].discard(subscriber)
            if not self._subscribers[topic]:
                del self._subscribers[topic]


class _Subscriber:
    """A queue in the event loop of the reader; None in it is the end."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[Event | None] = asyncio.Queue(_ROOM)

    def send(self, event: Event | None) -> None:
        with suppress(RuntimeError):  # the loop has ended, and the reader with it
            self._loop.call_soon_threadsafe(self._put, event)

    def _put(self, event: Event | None) -> None:
        if self._queue.full():
            self._queue.get_nowait()
        self._queue.put_nowait(event)

    async def events(self) -> AsyncIterator[Event]:
        while (event := await self._queue.get()) is not None:
            yield event
