"""Usage of principals: one row per day, updated in the unit of work that causes it. LOCAL has no limits."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import func, select, text
from sqlalchemy.orm import Session

from app.identity.limits import LimitReached, Limits, limits_of, seconds_to_midnight, today
from app.identity.principal import ACTING, BUILT_IN, LOCAL, acting_as, client_of
from app.identity.rows import asked_by
from app.settings import Settings
from app.storage.database import Database
from app.storage.tables import JobRow, PrincipalRow, StorageRow, UsageRow

MIB = 2**20
_RAISE = text(
    'INSERT INTO "usage" (principal_id, day, requests, jobs, seconds, bytes) '
    "VALUES (:principal, :day, :requests, :jobs, :seconds, :bytes) "
    "ON CONFLICT (principal_id, day) DO UPDATE SET "
    'requests = "usage".requests + excluded.requests, jobs = "usage".jobs + excluded.jobs, '
    'seconds = "usage".seconds + excluded.seconds, bytes = "usage".bytes + excluded.bytes'
)


@dataclass(frozen=True)
class PrincipalUsage:
    """The usage of a principal: calculation today (UTC), stored bytes, and waiting jobs."""

    requests: int
    jobs: int
    seconds: float
    bytes: int
    queued: int = 0


def note(
    session: Session,
    principal: str,
    *,
    requests: int = 0,
    jobs: int = 0,
    seconds: float = 0.0,
    bytes: int = 0,
) -> None:
    """Add to today's usage of a principal; built-in principals have no usage."""
    if principal not in BUILT_IN:
        day = {"principal": principal, "day": today()}
        session.execute(
            _RAISE, {**day, "requests": requests, "jobs": jobs, "seconds": seconds, "bytes": bytes}
        )


def note_bytes(session: Session, size: int) -> None:
    """Count bytes that the acting principal is the first to store."""
    if (principal := ACTING.get().id) not in BUILT_IN:
        note(session, principal, bytes=size)


def used(session: Session, principal: str) -> PrincipalUsage:
    """Return the usage of a principal."""
    row = session.get(UsageRow, (principal, today()), populate_existing=True)
    total = select(StorageRow.bytes).where(StorageRow.principal_id == principal)
    waiting = select(func.count()).where(JobRow.client == client_of(principal), JobRow.state == "queued")
    stored, queued = session.scalar(total) or 0, session.scalar(waiting) or 0
    if row is None:
        return PrincipalUsage(0, 0, 0.0, stored, queued)
    return PrincipalUsage(row.requests, row.jobs, row.seconds, stored, queued)


def own_limits(session: Session, settings: Settings) -> Limits | None:
    """Return the limits of the acting principal; None if it has no limits."""
    who = ACTING.get()
    if who.id in BUILT_IN:
        return None
    own = session.scalar(select(PrincipalRow.limits).where(PrincipalRow.id == who.id))
    return limits_of(settings, own)


def admit(session: Session, limits: Limits) -> None:
    """Let the acting principal queue one more job, and count it.

    Raises
    ------
    LimitReached
        If the principal has used up its calculation time of today or its storage.
    """
    who = ACTING.get()
    check(limits, used(session, who.id), who.name)
    note(session, who.id, jobs=1)


def require_room(session: Session, settings: Settings, size: int) -> None:
    """Check that a file fits into the storage of the acting principal [bytes].

    Raises
    ------
    LimitReached
        If it does not.
    """
    if limits := own_limits(session, settings):
        who = ACTING.get()
        check(limits, used(session, who.id), who.name, size)


def check(limits: Limits, used: PrincipalUsage, name: str, size: int = 0) -> None:
    """Refuse a principal that has used up a limit, or has no room for a file of some size [bytes].

    Raises
    ------
    LimitReached
        If a limit is used up.
    """
    if used.seconds >= limits.calculation_seconds:
        amounts = f"{used.seconds:.0f} s of {limits.calculation_seconds:.0f} s of calculation today (UTC)"
        raise LimitReached(f"{name} has used {amounts}", seconds_to_midnight())
    if used.bytes + max(1, size) > limits.storage_mb * MIB:
        amounts = f"{used.bytes / MIB:.0f} MiB of {limits.storage_mb:.0f} MiB of storage"
        amounts += f", and this file has {size / MIB:.1f} MiB" if size else ""
        raise LimitReached(f"{name} has used {amounts}; neither waiting nor deleting files frees it", None)


@contextmanager
def working_for(database: Database, principal: str | None) -> Iterator[None]:
    """Act for a principal by its id, or for LOCAL, and add the elapsed time to its usage."""
    if principal is None or principal in BUILT_IN:
        with acting_as(LOCAL):
            yield
        return
    with database.read() as session:
        who = asked_by(session, principal)
    start = time.monotonic()
    try:
        with acting_as(who):
            yield
    finally:
        seconds = time.monotonic() - start
        database.write(lambda session: note(session, who.id, seconds=seconds))
