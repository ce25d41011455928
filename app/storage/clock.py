"""The clock of operation: for how many seconds the service has been running in its life.

Ages of stored things are differences of it. It is a counter in the database that the writer raises by the
monotonic clock of the process, so a wall clock that jumps back or forward ages nothing, nor does time without
the service. A killed server loses the time since its last write.
"""

from __future__ import annotations

import time

from sqlalchemy import Connection, select, update
from sqlalchemy.orm import Session

from app.storage.tables import CounterRow

NAME = "operation"
DAY = 86_400  # s


class OperationClock:
    """Raises the counter by the whole seconds that have passed; belongs to the writer thread."""

    def __init__(self) -> None:
        self._counted = time.monotonic()  # up to this moment the counter holds all

    @property
    def elapsed(self) -> int:
        """Whole seconds that the counter does not hold yet."""
        return int(time.monotonic() - self._counted)

    def advance(self, connection: Connection) -> int:
        """Raise the counter in the caller's transaction and return by how many seconds."""
        seconds = self.elapsed
        if seconds:
            connection.execute(
                update(CounterRow).where(CounterRow.name == NAME).values(value=CounterRow.value + seconds)
            )
        return seconds

    def commit(self, seconds: int) -> None:
        """Note that the raise is durable; if its transaction is lost, the next one makes up for it."""
        self._counted += seconds


def operated(session: Session) -> int:
    """The time of operation [s]: exact to a second in a unit of work, else that of the last write."""
    return session.scalar(select(CounterRow.value).where(CounterRow.name == NAME)) or 0
