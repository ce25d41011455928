"""Events of designs and jobs: stored with the change itself, and sent to the subscribers of a topic.

The rows are the truth. What a subscriber is sent is a hint with its event at hand; see `Subscription`.
"""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from functools import partial

from sqlalchemy.orm import Session

from app.jobs.subscriptions import Subscription
from app.storage import event_log
from app.storage.database import Database, after_commit
from app.storage.event_log import PAGE, TOPIC, Event

__all__ = ["Event", "Events", "Subscription"]


@dataclass
class _Topic:
    """Those who listen to a topic, and the newest number that they were sent."""

    subscribers: set[Subscription] = field(default_factory=set)
    newest: int | None = None


class Events:
    """Topics and their subscribers. Who comes later reads the state first, or goes on from a number."""

    def __init__(self, database: Database) -> None:
        self.tell: Callable[[Iterable[str]], object] = list
        """Hints other servers, where there are any, at what they should look at, such as a topic."""
        self._database = database
        self._lock = threading.Lock()
        self._topics: dict[str, _Topic] = {}
        self._closed = False

    def note(self, session: Session, *events: Event) -> None:
        """Write events in the unit of work that makes them true; once it is durable, they are sent."""
        noted = event_log.note_all(session, *events)
        after_commit(session, partial(self._share, noted))

    def publish(self, *events: Event) -> None:
        """Send events to all who listen in this process; never blocks."""
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
        """Send what other servers have written of topics that somebody listens to, or of all of them.

        The newest page of rows is enough: subscribers read by themselves what they lack before it.
        """
        with self._lock:
            heard = {topic: its.newest for topic, its in self._topics.items()}
        wanted = heard.keys() if topics is None else heard.keys() & set(topics)
        if not wanted:
            return
        with self._database.read() as session:
            for topic, newest in event_log.newest(session, wanted).items():
                sent = heard[topic]
                start = newest - 1 if sent is None else max(sent, newest - PAGE)
                if newest > start:
                    self.publish(*event_log.above(session, topic, start))

    def heard(self, topics: Iterable[str] | None = None) -> set[str]:
        """Return those of these topics, or of all, to which somebody listens here."""
        with self._lock:
            return set(self._topics) if topics is None else self._topics.keys() & set(topics)

    @asynccontextmanager
    async def subscribe(self, topic: str) -> AsyncIterator[Subscription]:
        """Listen from now on; the subscription ends when the server closes."""
        subscriber = Subscription(topic, self._above)
        self._add(topic, subscriber)
        try:
            yield subscriber
        finally:
            self._remove(topic, subscriber)

    def close(self) -> None:
        """End all subscriptions, present and future."""
        with self._lock:
            self._closed = True
            everyone = [subscriber for topic in self._topics.values() for subscriber in topic.subscribers]
        for subscriber in everyone:
            subscriber.send(None)

    def _share(self, noted: list[Event]) -> None:
        """Send events that were written here, and have other servers read them."""
        self.publish(*noted)
        self.tell(map(TOPIC, noted))

    def _above(self, topic: str, number: int) -> list[Event]:
        with self._database.read() as session:
            return event_log.above(session, topic, number)

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
