"""Subscribe to the events of a topic: new ones as they come, missed ones from the rows."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import suppress

from app.storage.event_log import PAGE, Event

Read = Callable[[str, int], list[Event]]
"""Reads the events of a topic above a number: a page of them."""

_ROOM = 100  # events that may wait for a slow reader before the oldest are dropped


class Subscription:
    """The events of a topic in the order of their numbers, none twice and none missing.

    They come through a queue in the event loop of the reader; None in it is the end. Events may get lost on
    the way there, overtake each other or come twice: the number after `number` is the next one, and what
    lies between is read from the rows. Events without a number are handed over as they come.
    """

    def __init__(self, topic: str, read: Read) -> None:
        self.number: int | None = None
        """The newest event that the reader has; None: take them as they come."""
        self._topic, self._read = topic, read
        self._is_behind = False  # events above `number` came, and are not in the queue
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[Event | None] = asyncio.Queue(_ROOM)

    def resume(self, number: int) -> None:
        """Go on after an event that the reader got earlier, with what happened since."""
        self.number, self._is_behind = number, True

    def send(self, event: Event | None) -> None:
        """Hand an event over; from any thread, never blocks."""
        with suppress(RuntimeError):  # the loop has ended, and the reader with it
            self._loop.call_soon_threadsafe(self._put, event)

    async def __aiter__(self) -> AsyncIterator[Event]:
        while True:
            async for event in self._missed():
                yield event
            next_one = await self._queue.get()
            if next_one is None:
                return
            if next_one.number is None:
                yield next_one
                continue
            self._is_behind |= self.number is not None and next_one.number > self.number + 1
            async for event in self._missed():
                yield event
            if self.number is None or next_one.number > self.number:
                self.number = next_one.number
                yield next_one

    async def _missed(self) -> AsyncIterator[Event]:
        """Yield the events above `number`, page by page, if some are missing."""
        while self._is_behind and self.number is not None:
            self._is_behind = False  # unless more is dropped from now on
            page = await asyncio.to_thread(self._read, self._topic, self.number)
            self._is_behind |= len(page) == PAGE
            for event in page:
                if event.number is not None and event.number > self.number:
                    self.number = event.number
                    yield event

    def _put(self, event: Event | None) -> None:
        if self._queue.full():
            dropped = self._queue.get_nowait()
            self._is_behind |= dropped is not None and dropped.number is not None
        self._queue.put_nowait(event)
