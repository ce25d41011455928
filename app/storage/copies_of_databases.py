"""Detect a copy of the database that shares the file store, because each would delete files of the other.

A backup and a clone have the same identity, by which a store knows its database (`app.storage.ownership`), so
the identity does not distinguish copies. A random number does: each collection writes one to the database and
to the store. If a database finds an unknown number there, a copy of it collects files too.
"""

from __future__ import annotations

import json
import secrets
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.storage.artifacts import Artifacts
from app.storage.clock import now
from app.storage.database import Database
from app.storage.errors import StorageError
from app.storage.tables import CounterRow
from app.storage.units import upsert

NOTE = "sweeps"  # note in the store: the number of the last collection, and whether there are copies
LAST, NEXT = (
    "sweep",
    "sweep_next",
)  # rows of `counter`; the store has one of the two numbers, even after a crash


class DatabaseCopied(StorageError):
    """Another copy of this database uses, or has used, the same store."""

    def __init__(self, since: str) -> None:
        super().__init__(since)
        self.since = since

    def __str__(self) -> str:
        return (
            "Unused files are kept: a copy of this database, such as a restored "
            f"backup or a clone, has used the same file store (noticed {self.since}), and each would delete "
            "files of the other. Give one of them a bucket, prefix or folder of its own with a copy of the "
            f"files (CRANKWRIGHT_ARTIFACTS_URL). Once it is the only one again, delete `{NOTE}` in the store."
        )


@dataclass(frozen=True)
class _Mark:
    """The mark in the store: the number of the last collection, and when copies were first noticed."""

    number: int
    copied: str | None = None


def require_only_copy(database: Database, store: Artifacts) -> None:
    """Check that this database may collect files now, and mark the collection; one server at a time.

    Raises
    ------
    DatabaseCopied
        If another copy has collected files since this one did, or has noticed this one. The mark then
        records it, so that the other copy stops as well.
    ArtifactsUnreachable
        If the store does not answer.
    """
    mark = _mark(store)
    if mark is not None and mark.copied:
        raise DatabaseCopied(mark.copied)
    number = secrets.randbits(63)
    if not database.write(lambda session: _chosen(session, mark, number)):
        since = now()
        store.write_note(NOTE, json.dumps({"sweep": number, "copied": since}))
        raise DatabaseCopied(since)
    store.write_note(NOTE, json.dumps({"sweep": number, "copied": None}))


def _chosen(session: Session, mark: _Mark | None, number: int) -> bool:
    """Record the number for the next collection; return False if the mark is not from this database."""
    if mark is not None:
        query = select(CounterRow.value).where(CounterRow.name.in_((LAST, NEXT)))
        if mark.number not in set(session.scalars(query)):
            return False
        upsert(session, CounterRow(name=LAST, value=mark.number))
    upsert(session, CounterRow(name=NEXT, value=number))
    return True


def _mark(store: Artifacts) -> _Mark | None:
    """Return the mark in the store, or None; an unreadable mark counts as the mark of a copy."""
    text = store.read_note(NOTE)
    if text is None:
        return None
    try:
        said = json.loads(text)
        copied = said["copied"]
        return _Mark(int(said["sweep"]), None if copied is None else str(copied)[:40])
    except (ValueError, KeyError, TypeError):
        return _Mark(-1)
