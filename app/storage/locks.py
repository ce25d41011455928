"""Locks of names, for units of work that look before they write, where no row is there to be locked."""

from __future__ import annotations

from sqlalchemy import func, select
from sqlalchemy.orm import Session


def lock(session: Session, name: str) -> None:
    """Let units of work that lock the same name run one after another, whatever servers they run on.

    It holds until the end of the transaction. SQLite runs one unit at a time anyway.
    """
    if session.get_bind().dialect.name != "sqlite":
        session.execute(select(func.pg_advisory_xact_lock(func.hashtextextended(name, 0))))
