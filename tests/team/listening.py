"""The event handling of a server on a shared database, without the rest of the server."""

import asyncio
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from app.jobs.events import Event, Events
from app.storage.clock import now
from app.storage.database import Database
from app.storage.errors import StorageError
from app.storage.notices import Notices
from app.storage.tables import DesignRow

NEVER = 3600.0  # a poll that does not come within a test [s]
DEADLINE = 120.0  # for what hangs [s]


@dataclass(frozen=True)
class Side:
    """The database, and the events, of one server."""

    database: Database
    events: Events

    def note(self, topic, *names, **data):
        """Write events in a unit of their own."""
        news = [Event(topic, name, data) for name in names]
        self.database.write(lambda session: self.events.note(session, *news))


@contextmanager
def side(url, poll=NEVER):
    """A server; it looks at the rows without a hint every so often [s]."""
    database = Database(url)
    events = Events(database)
    notices = Notices(url, poll, events.look)
    events.tell = notices.send
    notices.start()
    try:
        yield Side(database, events)
    finally:
        notices.stop()
        database.close()


def designs(side, *ids):
    """New designs; their topics."""
    side.database.write(
        lambda session: session.add_all(DesignRow(id=id, name=id, created=now(), head=0) for id in ids)
    )
    return [f"design:{id}" for id in ids]


async def followed(side, topic, count, on_event=lambda received: None):
    """The first events of a topic, as a client gets them: when the stream breaks off it resumes."""
    received = []
    async with asyncio.timeout(DEADLINE):
        while len(received) < count:
            with suppress(StorageError):  # a connection that is lost while rows are read
                async with side.events.subscribe(topic) as subscription:
                    subscription.resume(len(received))
                    async for event in subscription:
                        received.append(event)
                        on_event(received)
                        if len(received) == count:
                            break
    return received
