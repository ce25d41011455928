"""Locks on names, for units of work that read before they write and have no row to lock."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.storage.database import Database


def lock(session: Session, name: str) -> None:
    """Serialise units of work that lock the same name, on all servers.

    The lock lasts until the end of the transaction. SQLite runs one unit at a time anyway.
    """
    if session.get_bind().dialect.name != "sqlite":
        session.execute(select(func.pg_advisory_xact_lock(func.hashtextextended(name, 0))))


@contextmanager
def alone(database: Database, work: str) -> Iterator[bool]:
    """Yield whether this server alone does some work while the block runs; the lock dies with the server."""
    if not database.is_shared:
        yield True
        return
    with database.read() as session:
        yield bool(session.scalar(select(func.pg_try_advisory_xact_lock(func.hashtextextended(work, 0)))))
