"""The sealer of the audit: every second it numbers and chains the rows that units of work have added.

Chaining each row in its own unit of work would make every commit wait for the previous one. If several
servers share a database, only one of them seals at a time, under a PostgreSQL lock that lasts until the end
of its transaction.
"""

from __future__ import annotations

import logging
import threading

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.identity.chain import seal
from app.storage.database import Database
from app.storage.tables import AuditRow, Base
from app.storage.units import Statement

logger = logging.getLogger(__name__)

PAUSE = 1.0  # time between two runs [s]
LOCK = 0x63775F7365616C  # number of the PostgreSQL advisory lock: "cw_seal"
_ROWS = Base.metadata.tables[AuditRow.__tablename__]
_WAITING = Statement(select(_ROWS.c.id).where(_ROWS.c.seq.is_(None)).limit(1))


class Sealer:
    """A thread that seals rows until it is stopped; before it ends, it seals the remaining rows."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._work, name="audit-sealer", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Seal the waiting rows, then stop."""
        self._stopping.set()
        self._thread.join()

    def run(self) -> int:
        """Seal all waiting rows and return their number; open no write transaction if there are none."""
        total = 0
        while self._is_wanted() and (count := self._database.write(self._unit)):
            total += count
        return total

    def _is_wanted(self) -> bool:
        with self._database.read() as session:
            return bool(_WAITING.run(session))

    def _unit(self, session: Session) -> int:
        if self._database.is_shared and not session.scalar(select(func.pg_try_advisory_xact_lock(LOCK))):
            return 0  # another server is sealing them
        return seal(session)

    def _work(self) -> None:
        more = True
        while more:
            more = not self._stopping.wait(PAUSE)
            try:
                self.run()
            except Exception:
                logger.exception("Rows of the audit could not be sealed; trying again in %g s", PAUSE)
