"""Events between servers on one PostgreSQL: how soon they come, what NOTIFY costs, what a sequence loses.

`python -m benchmarks.events_shared` starts a PostgreSQL of its own (commits are synced) and prints

- the time from the commit of one server to the reader at another, in this process, of 300 events;
- changes per second of 8 and 32 writers, each with an event: with hints after the commit (as it is), with
  NOTIFY inside the transaction, and without any;
- how many of the events of 8 writers a reader of `id > last` misses if ids come from a sequence, and how many
  a reader of the numbers of a topic.

Ratios say more than times: the machine has other work.
"""

from __future__ import annotations

import asyncio
import statistics
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import text
from sqlalchemy.orm import Session

from app.jobs.events import Event, Events
from app.storage import event_log
from app.storage.database import Database
from app.storage.identity import now
from app.storage.migrations import migrate
from app.storage.notices import CHANNEL, Notices
from app.storage.tables import DesignRow
from app.team.postgres import Cluster

EVENTS, SECONDS, DESIGNS, NEVER = 300, 5.0, 8, 3600.0
POOL = 32


@dataclass(frozen=True)
class Server:
    """The part of a server that handles events."""

    database: Database
    events: Events


@contextmanager
def server(url: str) -> Iterator[Server]:
    """A server that never looks without a hint."""
    database = Database(url, pool=POOL)
    events = Events(database)
    notices = Notices(url, NEVER, events.look)
    events.tell = notices.send
    notices.start()
    try:
        yield Server(database, events)
    finally:
        notices.stop()
        database.close()


def noted(one: Server, topic: str) -> None:
    """A change with an event, as the service writes it."""
    one.database.write(lambda session: one.events.note(session, Event(topic, "revision", {"revision": 1})))


def silent(one: Server, topic: str) -> None:
    """The same, of which nobody hears."""
    one.database.write(lambda session: event_log.note(session, topic, "revision", {"revision": 1}))


def inside(one: Server, topic: str) -> None:
    """The same, with NOTIFY in the transaction."""

    def unit(session: Session) -> None:
        event_log.note(session, topic, "revision", {"revision": 1})
        session.execute(
            text("SELECT pg_notify(:channel, :topic)"), {"channel": CHANNEL, "topic": f'["{topic}"]'}
        )

    one.database.write(unit)


async def delays(here: Server, there: Server, topic: str) -> list[float]:
    """The times from the commit at one server to the reader at the other [s]."""
    taken = []
    async with here.events.subscribe(topic) as subscription:
        with here.database.read() as session:
            subscription.number = event_log.newest(session, [topic])[topic]
        reader = aiter(subscription)
        for _ in range(EVENTS):
            await asyncio.to_thread(noted, there, topic)
            start = time.perf_counter()
            await anext(reader)
            taken.append(time.perf_counter() - start)
    return taken


def rate(one: Server, change: Callable[[Server, str], None], writers: int) -> float:
    """Changes per second of so many writers, over designs of their own."""
    end = time.monotonic() + SECONDS

    def work(writer: int) -> int:
        count = 0
        while time.monotonic() < end:
            change(one, f"design:{writer}")
            count += 1
        return count

    with ThreadPoolExecutor(writers) as pool:
        return sum(pool.map(work, range(writers))) / SECONDS


def missed(one: Server, ids: str, last_of: str, rows_above: str) -> tuple[int, int]:
    """How many rows of 8 writers a reader of those above its last one misses, and how many there are."""
    ended, seen, last = threading.Event(), 0, 0

    def write(writer: int) -> None:
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            one.database.write(lambda session: session.execute(text(ids)) and None)

    with ThreadPoolExecutor(9) as pool:
        writers = [pool.submit(write, writer) for writer in range(8)]
        threading.Thread(target=lambda: [w.result() for w in writers] and ended.set()).start()
        more = True
        while more:
            more = not ended.is_set()
            with one.database.read() as session:
                numbers = list(session.scalars(text(rows_above), {"last": last}))
            seen, last = seen + len(numbers), max([last, *numbers])
    with one.database.read() as session:
        total = session.scalar(text(last_of)) or 0
    return total - seen, total


def sequence(one: Server) -> tuple[int, int]:
    """Events numbered by a sequence."""
    one.database.write(lambda session: session.execute(text("CREATE TABLE trial (id bigserial)")) and None)
    insert = """
        WITH row AS (INSERT INTO trial DEFAULT VALUES RETURNING id)
        SELECT id, pg_sleep(random() * 0.002) FROM row"""
    return missed(one, insert, "SELECT count(*) FROM trial", "SELECT id FROM trial WHERE id > :last")


def topic_numbers(one: Server) -> tuple[int, int]:
    """Events numbered under the lock of their design, all of one."""
    insert = """
        WITH raised AS (UPDATE design SET event = event + 1 WHERE id = 'trial' RETURNING event),
        row AS (INSERT INTO event SELECT 'design:trial', event, 'x', '{}', '', 0 FROM raised RETURNING number)
        SELECT number, pg_sleep(random() * 0.002) FROM row"""
    where = "FROM event WHERE topic = 'design:trial'"
    return missed(one, insert, f"SELECT count(*) {where}", f"SELECT number {where} AND number > :last")


def main() -> None:
    """Print the figures."""
    cluster = Cluster(is_durable=True)
    try:
        migrate(url := cluster.create("trial"))
        with server(url) as here, server(url) as there:
            names = [*map(str, range(POOL)), "trial"]
            there.database.write(
                lambda session: session.add_all(
                    DesignRow(id=id, name=id, created=now(), head=0) for id in names
                )
            )
            time.sleep(1.0)  # until both listen
            taken = sorted(1000 * delay for delay in asyncio.run(delays(here, there, "design:0")))
            middle, late = statistics.median(taken), taken[int(0.99 * len(taken))]
            print(f"{EVENTS} of {EVENTS} events at the other server: p50 {middle:.1f} ms, p99 {late:.1f} ms")
            for writers in (8, 32):
                rates = {change.__name__: rate(there, change, writers) for change in (silent, noted, inside)}
                print(
                    f"{writers} writers, changes per second: without hints {rates['silent']:.0f}, "
                    f"hints after the commit {rates['noted']:.0f}, NOTIFY inside {rates['inside']:.0f}"
                )
            for name, trial in (("a sequence", sequence), ("the topic", topic_numbers)):
                lost, total = trial(there)
                print(f"numbers of {name}: a reader of `number > last` misses {lost} of {total}")
    finally:
        cluster.close()


if __name__ == "__main__":
    main()
