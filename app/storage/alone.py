"""Work that one server of a team does at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import func, select

from app.storage.database import Database


@contextmanager
def alone(database: Database, work: str) -> Iterator[bool]:
    """Yield whether no other server does this work while the block runs; a server's death ends its turn."""
    if not database.is_shared:
        yield True
        return
    with database.read() as session:
        yield bool(session.scalar(select(func.pg_try_advisory_xact_lock(func.hashtextextended(work, 0)))))
