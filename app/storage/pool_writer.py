"""The writer of PostgreSQL: every unit of work has its own transaction and connection.

PostgreSQL groups the syncs of simultaneous commits by itself. Grouped commits were 2.4 times slower there,
and the groups of several servers could deadlock (docs/decisions/049-two-writers.md).
"""

from __future__ import annotations

import contextvars
import random
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

from sqlalchemy import Engine
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.storage.errors import CommitFailed, CommitUnknown, DatabaseClosed
from app.storage.losses import is_conflict, is_loss, translated
from app.storage.units import AFTER, REPEATABLE, T, Unit, follow

RETRIES = 5
PAUSE_CONFLICT, PAUSE_LOSS = (
    0.01,
    0.1,
)  # pause before the first repetition, doubled before each further one [s]
_IN_ERROR = 3  # PQTRANS_INERROR: a commit now is a rollback, without an error


class PooledWriter:
    """Runs units of work in the threads of their callers; `on_commit` is described in `Database`.

    A unit runs again, at most five times, after a conflict with others or a connection lost before its
    commit. So it must have no other effect than the writes of its session.
    """

    def __init__(self, engine: Engine, threads: int, on_commit: Callable[[int, float, bool], object]) -> None:
        self.engine = engine
        self._on_commit = on_commit
        self._threads = ThreadPoolExecutor(threads, thread_name_prefix="database-writer")
        self._present = threading.local()  # has an attribute while the thread runs a unit
        self._closed = False

    def write(self, unit: Unit[T]) -> T:
        """Run a unit of work in this thread and return its result once it is durable."""
        if hasattr(self._present, "unit"):
            raise RuntimeError(
                "A unit of work must not wait for another one: use the session of the running unit."
            )
        if self._closed:
            raise DatabaseClosed("The database is closed.")
        self._present.unit = unit
        start, failed = time.perf_counter(), True
        try:
            result, functions = self._stored(unit)
            failed = False
        finally:
            del self._present.unit
            self._on_commit(1, time.perf_counter() - start, failed)
        follow(functions)
        return result

    def submit(self, unit: Unit[T]) -> Future[T]:
        """Run a unit of work in a thread of the writer; its future raises the same errors as `write`."""
        try:
            return self._threads.submit(contextvars.copy_context().run, self.write, unit)
        except RuntimeError as error:
            raise DatabaseClosed("The database is closed.") from error

    def close(self) -> None:
        """Accept no more units, and wait for those that were submitted."""
        self._threads.shutdown()
        self._closed = True

    def _stored(self, unit: Unit[T]) -> tuple[T, list[Callable[[], object]]]:
        """Return the result of a durable unit, and the functions to call after it."""
        is_unknown = False  # whether an earlier run may have been stored
        for pause in (2**n for n in range(RETRIES)):
            try:
                return self._run(unit)
            except _UnknownOutcome as unknown:
                if not unknown.is_repeatable:
                    raise CommitUnknown from unknown.cause
                is_unknown, wait = True, PAUSE_LOSS
            except DBAPIError as error:
                if not is_conflict(error) and not is_loss(error):
                    raise translated(error) from error
                wait = PAUSE_CONFLICT if is_conflict(error) else PAUSE_LOSS
            time.sleep(wait * pause * random.uniform(0.5, 1.0))
        try:
            return self._run(unit)
        except _UnknownOutcome as unknown:
            raise CommitUnknown from unknown.cause
        except DBAPIError as error:
            if is_unknown and is_loss(error):
                raise CommitUnknown from error
            raise translated(error) from error

    def _run(self, unit: Unit[T]) -> tuple[T, list[Callable[[], object]]]:
        """Run a unit once, and commit it."""
        with Session(self.engine, expire_on_commit=False) as session:
            result = unit(session)
            session.flush()
            _require_sound(session)
            try:
                session.commit()
            except Exception as error:
                if isinstance(error, DBAPIError) and is_loss(error):
                    raise _UnknownOutcome(error, REPEATABLE in session.info) from error
                if isinstance(error, DBAPIError) and is_conflict(error):
                    raise
                raise CommitFailed("The changes could not be committed; nothing was stored.") from error
            return result, session.info.get(AFTER, [])


class _UnknownOutcome(Exception):
    """Raised if the connection was lost during a commit."""

    def __init__(self, cause: DBAPIError, is_repeatable: bool) -> None:
        super().__init__(cause)
        self.cause, self.is_repeatable = cause, is_repeatable


def _require_sound(session: Session) -> None:
    """Raise an error if a statement has failed and the unit has hidden its error.

    PostgreSQL would answer the commit by a rollback, and the driver would report it as a success.
    """
    if not session.in_transaction():
        return
    driver = session.connection().connection.driver_connection
    if driver is not None and driver.info.transaction_status == _IN_ERROR:
        raise CommitFailed("A statement failed, so the transaction was rolled back; nothing was stored.")
