"""Requests that may be sent again: one Idempotency-Key, one change.

The key is kept in the transaction of the change itself, so that after a crash a repeated request finds
either the change or nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.plain import JsonObject
from app.storage.clock import operated
from app.storage.errors import KeyReused
from app.storage.identity import now
from app.storage.tables import IdempotencyRow

BEFORE_CLIENTS = ""  # the client of keys that version 0.1 kept, which asked for none


@dataclass(frozen=True)
class Once:
    """A request that is to be carried out once; without a key every request is a new one."""

    key: str | None
    scope: str  # method and path
    fingerprint: str  # SHA-256 of the body
    client: str = ""  # two clients may choose the same key

    def find(self, session: Session) -> JsonObject | None:
        """What this request led to before, if it did.

        Raises
        ------
        KeyReused
            If the key came with another body.
        """
        if not self.key:
            return None
        row = self._row(session, self.client) or self._row(session, BEFORE_CLIENTS)
        if row is None:
            return None
        if row.fingerprint != self.fingerprint:
            raise KeyReused(row.key)
        return row.location

    def keep(self, session: Session, status: int, location: JsonObject) -> None:
        """Remember what this request led to."""
        if self.key:
            session.add(
                IdempotencyRow(
                    key=self.key,
                    scope=self.scope,
                    client=self.client,
                    fingerprint=self.fingerprint,
                    status=status,
                    location=location,
                    created=now(),
                    operated=operated(session),
                )
            )

    def _row(self, session: Session, client: str) -> IdempotencyRow | None:
        return session.get(IdempotencyRow, (self.key, self.scope, client))
