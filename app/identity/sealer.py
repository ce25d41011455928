"""The sealer of the audit: every second it numbers and chains the rows that units of work have added.

Chaining each row in its own unit of work would make every commit wait for the previous one. If several
servers share a database, only one of them seals at a time, under a PostgreSQL lock that lasts until the end
of its transaction.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.identity.chain import head, seal
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
        self._fault = ""  # error of the last run; a fault that lasts is logged once
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
        self._attempt(self._record_head)
        more = True
        while more:
            more = not self._stopping.wait(PAUSE)
            self._attempt(self._seal_and_record)

    def _seal_and_record(self) -> None:
        if self.run():
            self._record_head()

    def _record_head(self) -> None:
        """Write the newest sealed row beside the database, if it is a file in a data folder."""
        if (record := self._database.record) is None:
            return
        with self._database.read() as session:
            newest = head(session)
        if newest.hash is not None:
            record.note(newest.seq, newest.hash)

    def _attempt(self, act: Callable[[], object]) -> None:
        try:
            act()
        except Exception as error:
            if self._fault != (fault := f"{type(error).__name__}: {error}"):
                logger.exception("Rows of the audit cannot be sealed; trying again every %g s", PAUSE)
            self._fault = fault
        else:
            if self._fault:
                logger.warning("Rows of the audit are sealed again")
            self._fault = ""
