"""Idempotent requests: a repeated Idempotency-Key makes one change only.

The key is stored in the transaction of the change itself, so that after a crash a repeated request finds
either the change or nothing. If several servers share a database, the key is inserted before anything else:
the second of two simultaneous requests then waits for the first.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import bindparam, select
from sqlalchemy.orm import Session

from app.plain import JsonObject
from app.storage.clock import now, operated
from app.storage.database import Database
from app.storage.errors import KeyReused
from app.storage.tables import Base, IdempotencyRow
from app.storage.units import DRIVER, Statement, Values, insert_new_values, repeatable, upsert_values

_ROWS = Base.metadata.tables[IdempotencyRow.__tablename__]
_KEPT = Statement(
    select(_ROWS.c.fingerprint, _ROWS.c.location).where(
        _ROWS.c.key == bindparam("of"),
        _ROWS.c.scope == bindparam("within"),
        _ROWS.c.client == bindparam("by"),
    ),
    "of",
    "within",
    "by",
)


@dataclass(frozen=True)
class Once:
    """A request that must be carried out once; without a key every request is a new one."""

    key: str | None
    scope: str  # method and path
    fingerprint: str  # SHA-256 of the body
    client: str = ""  # two clients may choose the same key

    def find(self, session: Session) -> JsonObject | None:
        """Return the stored answer of an equal earlier request; None if there was none.

        Raises
        ------
        KeyReused
            If the key came with another body.
        """
        if not self.key:
            return None
        asked = {"of": self.key, "within": self.scope, "by": self.client}
        kept = next(iter(_KEPT.run(session, asked)), None)
        return self._answer(*kept) if kept else None

    def find_in(self, database: Database) -> JsonObject | None:
        """Return what `find` does, in a transaction of its own, before a request causes any work."""
        if not self.key:
            return None
        with database.read() as session:
            return self.find(session)

    def begin(self, session: Session) -> JsonObject | None:
        """Return the stored answer of an equal earlier request; else reserve the key and return None.

        Call this first in a unit of work, and `keep` later. While another server carries out the same
        request, the call waits.

        Raises
        ------
        KeyReused
            If the key came with another body.
        """
        if not self.key:
            return None
        if DRIVER in session.info:  # SQLite runs units one by one: no other carries it out meanwhile
            return self.find(session)
        repeatable(session)
        mine = self._new(operated(session), status=0, location={})
        if insert_new_values(session, _ROWS, mine):
            return None
        return self.find(session)

    def keep(self, session: Session, status: int, location: JsonObject) -> None:
        """Store the answer of this request."""
        if self.key:
            upsert_values(session, _ROWS, self._new(operated(session), status, location))

    def _new(self, operated: int, status: int, location: JsonObject) -> Values:
        return {
            "key": self.key,
            "scope": self.scope,
            "client": self.client,
            "fingerprint": self.fingerprint,
            "status": status,
            "location": location,
            "created": now(),
            "operated": operated,
        }

    def _answer(self, fingerprint: str, location: JsonObject) -> JsonObject:
        if fingerprint != self.fingerprint:
            raise KeyReused(self.key or "")
        return location
