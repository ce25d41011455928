"""The thread that deletes old data in small units of work while the service runs."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from functools import partial

from sqlalchemy.orm import Session

from app.observation import metrics
from app.retention import rows
from app.retention.files import Sweep
from app.settings import Settings
from app.storage.artifacts import Artifacts
from app.storage.clock import DAY, operated
from app.storage.copies_of_databases import DatabaseCopied
from app.storage.database import Database

logger = logging.getLogger(__name__)

PAUSE = 900.0  # time between two rounds [s]
HOUR = 3600.0  # s
GRACE = HOUR  # time between two sweeps of the files [s of run time]
SOME_ROWS = 200  # rows deleted in one unit, which delays other writes by a few milliseconds
SOME_BUILDS = 10  # builds deleted in one unit; each has artifacts and analyses


class Retention:
    """Deletes old rows and files as the settings state, at the start and then every quarter of an hour."""

    def __init__(self, database: Database, store: Artifacts, settings: Settings) -> None:
        self._database = database
        self._sweep = Sweep(database, store, settings.keep_files_hours * HOUR)
        self._swept: int | None = None  # time of the last sweep [s of run time]
        # The record of a request names its job, which must exist when the request is repeated.
        self._keys = settings.keep_keys_days * DAY
        self._events = settings.keep_events_days * DAY
        self._jobs = max(settings.keep_jobs_days, settings.keep_keys_days) * DAY
        self._builds = settings.keep_builds_days * DAY
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._work, name="retention", daemon=True)

    def start(self) -> None:
        """Start the thread; the first round begins at once."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread after the running unit of work."""
        self._stopping.set()
        self._thread.join()

    def run(self) -> dict[str, int]:
        """Delete expired data once; return the number of deleted items of each kind."""
        counts = {
            "keys": self._repeat(partial(rows.delete_keys, kept=self._keys, most=SOME_ROWS)),
            "events": self._repeat(partial(rows.delete_events, kept=self._events, most=SOME_ROWS)),
            "jobs": self._repeat(partial(rows.delete_jobs, kept=self._jobs, most=SOME_ROWS)),
            "builds": self._delete_builds(),
            "files": self._sweep_files(),
        }
        if any(counts.values()):
            logger.info("Deleted expired data: %s", counts)
        return counts

    def _work(self) -> None:
        while not self._stopping.is_set():
            try:
                self.run()
            except Exception:
                logger.exception("Old rows and files could not be deleted; trying again in %g s", PAUSE)
            self._stopping.wait(PAUSE)

    def _repeat(self, unit: Callable[[Session], int]) -> int:
        """Run a unit of work until it finds nothing more; other units can run in between."""
        total = 0
        while not self._stopping.is_set() and (count := self._database.write(unit)):
            total += count
        return total

    def _delete_builds(self) -> int:
        """Read unused builds page by page without the writer; the unit that deletes a page rechecks it."""
        total, last = 0, ""
        while not self._stopping.is_set():
            with self._database.read() as session:
                page = rows.unwanted_builds(session, self._builds, last, SOME_BUILDS)
            if not page:
                break
            total += self._database.write(partial(rows.delete_builds, keys=page, kept=self._builds))
            last = page[-1]
        return total

    def _sweep_files(self) -> int:
        with self._database.read() as session:
            present = operated(session)
        if self._swept is not None and present - self._swept < GRACE:
            return 0
        self._swept = present
        try:
            deleted = self._sweep.run(self._stopping.is_set)
        except DatabaseCopied as copied:
            metrics.COPIED.set(1)
            logger.error("%s", copied)
            return 0
        metrics.COPIED.set(0)
        return deleted
