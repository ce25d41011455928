"""Locks on names, for units of work that read before they write, where there is no row to lock."""

from __future__ import annotations

from sqlalchemy import func, select
from sqlalchemy.orm import Session


def lock(session: Session, name: str) -> None:
    """Let units of work that lock the same name run one after another, whatever servers they run on.

    It holds until the end of the transaction. SQLite runs one unit at a time anyway.
    """
    if session.get_bind().dialect.name != "sqlite":
        session.execute(select(func.pg_advisory_xact_lock(func.hashtextextended(name, 0))))
