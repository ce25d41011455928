"""Events of designs and jobs: rows, written in the transaction of the change and sent to subscribers.

The topics are `design:<id>` and `job:<id>`; the numbers of events within a topic have no gaps. An event gets
its number under the lock of its design's or job's row, in the unit of work that makes the change. So a reader
who sees a number also sees all lower ones. A database sequence does not guarantee that, because it assigns
numbers before the commit.

The rows are authoritative. A subscriber receives a hint together with the event; see `Subscription`.
"""

from __future__ import annotations

import asyncio
import threading
from collections import Counter
from collections.abc import AsyncIterator, Callable, Iterable, Mapping
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from operator import attrgetter

from sqlalchemy import Table, bindparam, insert, select, update
from sqlalchemy.orm import Session

from app.storage.clock import NAME, now
from app.storage.database import Database, after_commit
from app.storage.tables import Base, CounterRow, EventRow
from app.storage.units import Statement

Data = Mapping[str, object]

PAGE = 500  # events read in one query
_EVENTS = Base.metadata.tables["event"]
_OWNERS: dict[str, Table] = {kind: Base.metadata.tables[kind] for kind in ("design", "job")}
_OPERATED = select(CounterRow.value).where(CounterRow.name == NAME).scalar_subquery()
_RAISED = {
    kind: Statement(
        update(owner)
        .where(owner.c.id == bindparam("of"))
        .values(event=owner.c.event + bindparam("more"))
        .returning(owner.c.event),
        "of",
        "more",
    )
    for kind, owner in _OWNERS.items()
}
_NOTED = Statement(insert(_EVENTS).values(operated=_OPERATED), "topic", "number", "name", "data", "created")


@dataclass(frozen=True)
class Event:
    """An event of a topic; an event without a number, such as progress, is not stored."""

    topic: str
    name: str
    data: Data
    number: int | None = None

    @property
    def message(self) -> dict[str, object]:
        """Return the event as readers receive it: a JSON object with its name."""
        return {"event": self.name, **self.data}


TOPIC: Callable[[Event], str] = attrgetter("topic")


def note_events(session: Session, *events: Event) -> list[Event]:
    """Write events in the unit of work of the change, and return them with their numbers.

    This informs no listener; services use `app.jobs.events.Events.note` instead. The rows of jobs are locked
    before those of designs, as everywhere.
    """
    counts = Counter(map(TOPIC, events))
    numbers = dict[str, int]()
    session.flush()  # write the rows that these events are about
    for topic in sorted(counts, reverse=True):
        kind, _, id = topic.partition(":")
        (raised,) = _RAISED[kind].run(session, {"of": id, "more": counts[topic]})
        numbers[topic] = raised[0] - counts[topic]
    created, noted, rows = now(), list[Event](), list[dict[str, object]]()
    for event in events:
        numbers[event.topic] += 1
        number = numbers[event.topic]
        noted.append(Event(event.topic, event.name, event.data, number))
        rows.append(
            {
                "topic": event.topic, "number": number, "name": event.name,
                "data": event.data, "created": created,
            }
        )  # fmt: skip
    _NOTED.run_many(session, rows)
    return noted


def newest_numbers(session: Session, topics: Iterable[str]) -> dict[str, int]:
    """Return the number of the newest event of each topic whose design or job exists; 0 if it has none."""
    ids: dict[str, list[str]] = {kind: [] for kind in _OWNERS}
    for topic in topics:
        kind, _, id = topic.partition(":")
        ids[kind].append(id)
    return {
        f"{kind}:{id}": number
        for kind, owner in _OWNERS.items()
        if ids[kind]
        for id, number in session.execute(select(owner.c.id, owner.c.event).where(owner.c.id.in_(ids[kind])))
    }


def events_above(session: Session, topic: str, number: int, most: int = PAGE) -> list[Event]:
    """Return the events of a topic above a number, in order, at most `most`."""
    row = EventRow
    later = select(row.name, row.data, row.number).where(row.topic == topic, row.number > number)
    rows = session.execute(later.order_by(row.number).limit(most))
    return [Event(topic, name, data, its) for name, data, its in rows]


def are_events_kept(session: Session, topic: str, number: int, newest: int) -> bool:
    """Return whether all events of a topic after a number are still stored.

    The result is False if the topic has not reached the number yet.
    """
    if number >= newest:
        return number == newest
    return session.get(EventRow, (topic, number + 1)) is not None


__all__ = ["Event", "Events", "Subscription"]


@dataclass
class _Topic:
    """The subscribers of a topic, and the newest number that was sent to them."""

    subscribers: set[Subscription] = field(default_factory=set)
    newest: int | None = None


class Events:
    """Topics and their subscribers. A new subscriber first reads the state, or continues from a number."""

    def __init__(self, database: Database) -> None:
        self.tell: Callable[[Iterable[str]], object] = list
        """Tells other servers, if there are any, what to read again, such as a topic."""
        self._database = database
        self._lock = threading.Lock()
        self._topics: dict[str, _Topic] = {}
        self._closed = False

    def note(self, session: Session, *events: Event) -> None:
        """Write events in the unit of work of the change, and send them once they are durable."""
        noted = note_events(session, *events)
        after_commit(session, partial(self._share, noted))

    def publish(self, *events: Event) -> None:
        """Send events to all listeners in this process without blocking."""
        for event in events:
            with self._lock:
                if (topic := self._topics.get(event.topic)) is None:
                    continue
                if event.number is not None:
                    topic.newest = max(event.number, topic.newest or 0)
                listeners = tuple(topic.subscribers)
            for subscriber in listeners:
                subscriber.send(event)

    def look(self, topics: Iterable[str] | None = None) -> None:
        """Send events of other servers, for topics with listeners among these or among all topics.

        The newest page of rows is enough, because subscribers read earlier missing events themselves.
        """
        with self._lock:
            heard = {topic: its.newest for topic, its in self._topics.items()}
        wanted = heard.keys() if topics is None else heard.keys() & set(topics)
        if not wanted:
            return
        with self._database.read() as session:
            for topic, newest in newest_numbers(session, wanted).items():
                sent = heard[topic]
                start = newest - 1 if sent is None else max(sent, newest - PAGE)
                if newest > start:
                    self.publish(*events_above(session, topic, start))

    def heard(self, topics: Iterable[str] | None = None) -> set[str]:
        """Return the topics with listeners on this server, among the given ones or among all."""
        with self._lock:
            return set(self._topics) if topics is None else self._topics.keys() & set(topics)

    @asynccontextmanager
    async def subscribe(self, topic: str) -> AsyncIterator[Subscription]:
        """Return a subscription to a topic from now on; it ends when the server closes."""
        subscriber = Subscription(topic, self._above)
        self._add(topic, subscriber)
        try:
            yield subscriber
        finally:
            self._remove(topic, subscriber)

    def close(self) -> None:
        """End all present and future subscriptions."""
        with self._lock:
            self._closed = True
            everyone = [subscriber for topic in self._topics.values() for subscriber in topic.subscribers]
        for subscriber in everyone:
            subscriber.send(None)

    def _share(self, noted: list[Event]) -> None:
        """Send events that this server has written to its listeners, and notify other servers."""
        self.publish(*noted)
        self.tell(map(TOPIC, noted))

    def _above(self, topic: str, number: int) -> list[Event]:
        with self._database.read() as session:
            return events_above(session, topic, number)

    def _add(self, topic: str, subscriber: Subscription) -> None:
        with self._lock:
            self._topics.setdefault(topic, _Topic()).subscribers.add(subscriber)
            if self._closed:
                subscriber.send(None)

    def _remove(self, topic: str, subscriber: Subscription) -> None:
        with self._lock:
            subscribers = self._topics[topic].subscribers
            subscribers.discard(subscriber)
            if not subscribers:
                del self._topics[topic]


Read = Callable[[str, int], list[Event]]
"""Reads one page of a topic's events above a number."""

_ROOM = 100  # events queued for a slow reader before the oldest are dropped


class Subscription:
    """The events of a topic in the order of their numbers, each exactly once.

    They arrive through a queue in the event loop of the reader; None marks the end. On the way to the queue
    events may get lost, overtake each other or arrive twice. The number after `number` is the next one; if
    it is missing, it is read from the rows. Events without a number are passed on as they arrive.
    """

    def __init__(self, topic: str, read: Read) -> None:
        self.number: int | None = None
        """Number of the newest event that the reader has; None if it takes events as they arrive."""
        self._topic, self._read = topic, read
        self._is_behind = False  # whether events above `number` have arrived but are not in the queue
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[Event | None] = asyncio.Queue(_ROOM)

    def resume(self, number: int) -> None:
        """Continue after the reader's last event, with all later events."""
        self.number, self._is_behind = number, True

    def send(self, event: Event | None) -> None:
        """Deliver an event; this may be called from any thread and never blocks."""
        with suppress(RuntimeError):  # the event loop and the reader have ended
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
            self._is_behind = False  # true again if more events are dropped
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
