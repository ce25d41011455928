"""Notifications between the servers of a team: PostgreSQL's NOTIFY, sent after the commit.

A hint is a short text, such as the topic of an event or `queue:regenerate`. Rows are authoritative: a lost
hint only delays an event until the next poll of the database. NOTIFY within a transaction would hold a lock
of the whole database until its commit is done: see docs/decisions/050-events-are-rows.md.
"""

from __future__ import annotations

import json
import logging
import queue
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing

import psycopg
from sqlalchemy import make_url

logger = logging.getLogger(__name__)

CHANNEL = "crankwright"
MOST_BYTES = 7900  # largest size of a notification; PostgreSQL refuses 8000
SHORTEST, LONGEST = 0.1, 2.0  # pauses before a lost connection is opened again [s]
GLANCE = 0.2  # interval at which a thread checks whether it must end [s]
PATIENCE = {
    "connect_timeout": "5", "keepalives_idle": "10", "keepalives_interval": "5", "keepalives_count": "3"
}  # fmt: skip
"""Time limits that detect a database server which no longer answers [s]."""

Hear = Callable[[list[str] | None], object]
"""Called with the hints of other servers, or with None if hints may have been lost."""


class Notices:
    """Sends hints of this server, and receives those of others on its own connection.

    `hear` is called in one thread, with None after every connection and every `poll_seconds`. The connection
    must lead directly to PostgreSQL, because a connection pooler in between does not keep subscriptions.
    """

    def __init__(self, url: str, poll_seconds: float, hear: Hear) -> None:
        address = make_url(url).set(drivername="postgresql").update_query_dict(PATIENCE)
        self._address = address.render_as_string(hide_password=False)
        self._poll = poll_seconds
        self._hear = hear
        self._waiting: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._stopping = threading.Event()
        self._sender_pid: int | None = None  # process id of the database server behind the sending connection
        self._threads = [
            threading.Thread(target=work, name=f"notices-{work.__name__.strip('_')}", daemon=True)
            for work in (self._send, self._listen)
        ]

    def start(self) -> None:
        """Start to send and to listen."""
        for thread in self._threads:
            thread.start()

    def stop(self) -> None:
        """Send the waiting hints, and stop; a second call does nothing."""
        self._stopping.set()
        self._waiting.put(None)
        for thread in self._threads:
            if thread.is_alive():
                thread.join(LONGEST)

    def send(self, hints: Iterable[str]) -> None:
        """Queue hints for the other servers; never blocks."""
        for hint in hints:
            self._waiting.put(hint)

    def _send(self) -> None:
        connection = None
        while (hints := self._next_hints()) is not None:
            try:
                connection = self._sent(connection, hints)
            except Exception:  # most likely the connection was lost since the last hint
                try:
                    connection = self._sent(None, hints)
                except Exception as error:  # after any error, the next hints are sent on a new connection
                    connection = None
                    logger.warning("hints to other servers are lost; they will poll the database: %s", error)
        if connection is not None:
            connection.close()

    def _next_hints(self) -> list[str] | None:
        """Wait for a hint; return all waiting hints without duplicates. None at the end."""
        hints = {self._waiting.get(): None}
        while not self._waiting.empty():
            hints[self._waiting.get()] = None
        texts = [hint for hint in hints if hint is not None]
        if len(texts) < len(hints):
            self._waiting.put(None)  # the end mark is read again after these are sent
        return texts or None

    def _sent(self, connection: psycopg.Connection | None, hints: list[str]) -> psycopg.Connection:
        """Send hints and return the connection that was used."""
        if connection is None:
            connection = self._connected()
            self._sender_pid = connection.info.backend_pid
        connection.execute("SELECT pg_notify(%s, unnest(%s::text[]))", (CHANNEL, list(payloads(hints))))
        return connection

    def _listen(self) -> None:
        pause, looked = SHORTEST, -self._poll
        while not self._stopping.is_set():
            try:
                with closing(self._connected()) as connection:
                    connection.execute(f"LISTEN {CHANNEL}")
                    pause = SHORTEST
                    self._attend(connection)
            except Exception as error:  # after any error, this thread listens again
                logger.warning("the connection that receives hints of other servers is lost: %s", error)
            if time.monotonic() - looked >= self._poll:  # even if no notification arrives
                looked = time.monotonic()
                self._look()
            self._stopping.wait(pause)
            pause = min(2 * pause, LONGEST)

    def _attend(self, connection: psycopg.Connection) -> None:
        """Receive notifications until the connection is lost."""
        looked = -self._poll
        while not self._stopping.is_set():
            if time.monotonic() - looked >= self._poll:
                looked = time.monotonic()
                self._look()
            heard = dict[str, None]()
            for notice in connection.notifies(timeout=GLANCE, stop_after=1):
                if notice.pid != self._sender_pid:
                    heard.update(dict.fromkeys(hints_of(notice.payload)))
            if heard:
                self._look(list(heard))

    def _look(self, hints: list[str] | None = None) -> None:
        try:
            self._hear(hints)
        except Exception as error:  # for example, the database is restarting
            logger.warning("the changes of other servers cannot be read; trying again: %s", error)

    def _connected(self) -> psycopg.Connection:
        return psycopg.connect(self._address, autocommit=True)


def payloads(hints: Iterable[str]) -> Iterator[str]:
    """Yield hints as JSON lists, each short enough for one notification."""
    part, size = list[str](), 2
    for hint in hints:
        length = len(json.dumps(hint)) + 2  # ASCII only: characters are bytes
        if part and size + length > MOST_BYTES:
            yield json.dumps(part)
            part, size = [], 2
        part.append(hint)
        size += length
    if part:
        yield json.dumps(part)


def hints_of(payload: str) -> list[str]:
    """Return the hints of a notification; empty for a notification of another program."""
    try:
        hints = json.loads(payload)
    except ValueError:
        return []
    return [hint for hint in hints if isinstance(hint, str)] if isinstance(hints, list) else []
