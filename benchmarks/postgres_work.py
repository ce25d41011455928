"""Work of a PostgreSQL during a block: statements, syncs of its log, and what its connections waited for."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import psycopg
from sqlalchemy import make_url

from app.team.postgres import Cluster

LOOK = 0.1  # between two looks at the connections [s]
LOCK, DISK, CORE, SERVER = "a lock of rows", "its log or an inner lock", "a core, or has it", "its server"
"""Events for which a connection within a transaction may wait."""

_WAITS = f"""
SELECT CASE WHEN state LIKE 'idle in transaction%' THEN '{SERVER}'
            WHEN wait_event_type = 'Lock' THEN '{LOCK}'
            WHEN wait_event_type IN ('IO', 'LWLock') THEN '{DISK}'
            ELSE '{CORE}' END
FROM pg_stat_activity
WHERE backend_type = 'client backend' AND pid <> pg_backend_pid() AND state <> 'idle'
"""
_COUNTS = """
SELECT (SELECT coalesce(sum(calls), 0) FROM pg_stat_statements), wal_sync, wal_sync_time FROM pg_stat_wal
"""
_FREQUENT = "SELECT calls, query FROM pg_stat_statements ORDER BY calls DESC LIMIT 40"


@dataclass
class Work:
    """Statements, those that begin and end transactions among them; syncs of the log and their time [s].

    `waits` are the connections, on average, that were within a transaction, by what they waited for.
    """

    statements: int = 0
    syncs: int = 0
    sync_seconds: float = 0.0
    waits: dict[str, float] = field(default_factory=dict)


def prepare(cluster: Cluster) -> None:
    """Have a PostgreSQL count its statements and time its syncs; it starts again for that."""
    cluster.execute("ALTER SYSTEM SET shared_preload_libraries = 'pg_stat_statements'")
    cluster.execute("ALTER SYSTEM SET track_wal_io_timing = on")
    cluster.stop()
    cluster.start()


@contextmanager
def watched(url: str) -> Iterator[Work]:
    """Yield the work of a block, complete once it has ended; `url` names a prepared database."""
    address = make_url(url).set(drivername="postgresql").render_as_string(hide_password=False)
    work, ended, waits, looks = Work(), threading.Event(), Counter[str](), 0
    with psycopg.connect(address, autocommit=True) as connection:
        connection.execute("CREATE EXTENSION IF NOT EXISTS pg_stat_statements")
        before = _counts(connection)

        def look() -> None:
            nonlocal looks
            with psycopg.connect(address, autocommit=True) as looking:
                while not ended.wait(LOOK):
                    looks += 1
                    waits.update(what for (what,) in looking.execute(_WAITS))

        thread = threading.Thread(target=look, name="waits", daemon=True)
        thread.start()
        try:
            yield work
        finally:
            ended.set()
            thread.join()
        after = _counts(connection)
        work.statements = int(after[0] - before[0]) - looks  # those of the looks are counted too
        work.syncs = int(after[1] - before[1])
        work.sync_seconds = (after[2] - before[2]) / 1000
        work.waits = {what: count / max(looks, 1) for what, count in waits.items()}


def frequent(url: str) -> list[tuple[int, str]]:
    """The statements that were executed most often since the start, and how often."""
    address = make_url(url).set(drivername="postgresql").render_as_string(hide_password=False)
    with psycopg.connect(address, autocommit=True) as connection:
        return [(calls, " ".join(query.split())) for calls, query in connection.execute(_FREQUENT)]


def _counts(connection: psycopg.Connection) -> tuple[float, float, float]:
    row = connection.execute(_COUNTS).fetchone()
    assert row is not None, "an aggregate has a row"
    return float(row[0]), float(row[1]), float(row[2])
