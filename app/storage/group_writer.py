"""The writer of SQLite: one thread commits all waiting units of work in one transaction.

SQLite accepts one writer at a time and syncs the disk at every commit. A single thread that runs all waiting
units in one transaction needs one sync for all of them, and never finds the database locked.

The writer watches for damage to the file, and stops writing once it has found any.
"""

from __future__ import annotations

import contextvars
import logging
import os
import queue
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from typing import Any

from sqlalchemy import Connection, Engine
from sqlalchemy.orm import Session

from app.storage.clock import OperationClock
from app.storage.engines import rolled_back, sqlite_file
from app.storage.errors import CommitFailed, DatabaseClosed, DatabaseDamaged
from app.storage.integrity import faults, is_damage, marker_of
from app.storage.units import AFTER, DRIVER, T, Unit, follow

logger = logging.getLogger(__name__)


class Watch:
    """Turns SQLite's errors about damage into DatabaseDamaged, and remembers the first one.

    It writes a note beside the file, because damage in SQLite's log may not be visible after a restart.
    """

    def __init__(self, url: str) -> None:
        self._path = sqlite_file(url)
        self._file = self._path.stat() if self._path is not None and self._path.exists() else None
        self._lock = threading.Lock()
        self.damage: DatabaseDamaged | None = None

    def refuse(self) -> None:
        """Check that no damage is known and the file is the one opened at the start.

        Raises
        ------
        DatabaseDamaged
            If damage is known, or the file was deleted or replaced.
        """
        if self.damage is not None:
            raise self._again(self.damage)
        self.require_file()

    def require_file(self) -> None:
        """Check that the file is the one opened at the start; SQLite would silently create a new one."""
        if self._path is None or self._file is None:
            return
        with suppress(OSError):
            if os.path.samestat(os.stat(self._path), self._file):
                return
        lost = "the file was deleted or replaced while the service used it"
        raise self._named(DatabaseDamaged(str(self._path), [lost]))

    def raise_if_damage(self, error: BaseException | None) -> None:
        """Raise DatabaseDamaged if an error means that the database is damaged."""
        if error is not None and is_damage(error):
            raise self._named(error) from error

    def translated(self, error: Exception) -> Exception:
        """Return DatabaseDamaged for an error that means damage; return any other error unchanged."""
        try:
            self.raise_if_damage(error)
        except DatabaseDamaged as damage:
            return damage
        return error

    def _named(self, error: BaseException) -> DatabaseDamaged:
        with self._lock:
            if self.damage is None:
                self.damage = error if isinstance(error, DatabaseDamaged) else self._diagnosed(error)
                logger.critical("%s", self.damage)
                self._note(self.damage)
            return self._again(self.damage)

    def _diagnosed(self, error: BaseException) -> DatabaseDamaged:
        """Read the whole file to find the damaged pages, because the error does not name them."""
        path = self._path
        try:
            damage = faults(path) if path else []
        except (sqlite3.Error, OSError) as failure:
            damage = [f"it cannot be examined ({failure})"]
        return DatabaseDamaged(str(path or "database"), damage or [str(getattr(error, "orig", error))])

    def _note(self, damage: DatabaseDamaged) -> None:
        if self._path is not None:
            with suppress(OSError):  # the disk may be faulty
                marker_of(self._path).write_text("; ".join(damage.faults), encoding="utf-8")

    @staticmethod
    def _again(damage: DatabaseDamaged) -> DatabaseDamaged:
        """Return a new exception, because one that several threads raise would collect their tracebacks."""
        return DatabaseDamaged(damage.database, damage.faults)


GROUP = 256  # largest number of units in one transaction, to limit the wait of the first unit


class GroupWriter:
    """Commits units of work in groups; `on_commit` is described in `Database`."""

    def __init__(
        self,
        engine: Engine,
        clock: OperationClock,
        watch: Watch,
        on_commit: Callable[[int, float, bool], object],
    ) -> None:
        self.engine = engine
        self._clock, self._watch, self._on_commit = clock, watch, on_commit
        self._waiting: queue.SimpleQueue[_PendingUnit | None] = queue.SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._connection: Connection | None = None  # connection of the writer thread
        self._thread = threading.Thread(target=self._serve, name="database-writer", daemon=True)
        self._thread.start()

    def write(self, unit: Unit[T]) -> T:
        """Run a unit of work in the writer thread and return its result once it is durable."""
        if threading.current_thread() is self._thread:
            raise RuntimeError(
                "A unit of work must not wait for another one: use the session of the running unit."
            )
        return self.submit(unit).result()

    def submit(self, unit: Unit[T]) -> Future[T]:
        """Queue a unit of work; its future raises the same errors as `write`."""
        if self._watch.damage is not None:  # the group checks later whether the file still exists
            self._watch.refuse()
        pending = _PendingUnit(unit)
        with self._closing:  # no unit may enter the queue after its end
            if self._closed:
                raise DatabaseClosed("The database is closed.")
            self._waiting.put(pending)
        return pending.future

    def close(self) -> None:
        """Commit the waiting units, then end the thread. A second call does nothing."""
        with self._closing:
            if not self._closed:
                self._waiting.put(None)
            self._closed = True
        self._thread.join()

    def _serve(self) -> None:
        more = True
        while more:
            group, more = self._next_group()
            if group:
                self._commit(group)
        if self._clock.elapsed:
            self._commit([])
        self._disconnect()

    def _disconnect(self) -> None:
        """Return the connection to the pool; the next group opens one again."""
        connection, self._connection = self._connection, None
        if connection is not None:
            connection.close()

    def _next_group(self) -> tuple[list[_PendingUnit], bool]:
        """Wait for a unit, then return it with all others that wait, and whether more may come."""
        group: list[_PendingUnit] = []
        while not group or (len(group) < GROUP and not self._waiting.empty()):
            pending = self._waiting.get()
            if pending is None:
                return group, False
            if pending.future.set_running_or_notify_cancel():
                group.append(pending)
        return group, True

    def _commit(self, group: list[_PendingUnit]) -> None:
        start = time.perf_counter()
        try:
            connection = self._connection = self._connection or self.engine.connect()
            with connection.begin():
                self._watch.refuse()  # damage may have been found while the group was waiting
                seconds = self._clock.advance(connection)
                for pending in group:
                    pending.run(connection)
                    if pending.error is not None:
                        self._watch.raise_if_damage(pending.error)
            self._watch.refuse()  # if the file was deleted in the meantime, the commit is lost
        except Exception as error:
            self._on_commit(len(group), time.perf_counter() - start, True)
            cause = self._watch.translated(error)
            for pending in group:
                pending.refuse(cause)
            self._disconnect()
        else:
            self._on_commit(len(group), time.perf_counter() - start, False)
            self._clock.commit(seconds)
            for pending in group:
                pending.settle()


@contextmanager
def _savepoint(connection: Connection) -> Iterator[sqlite3.Connection]:
    """Open a savepoint within the transaction of a group; an exception undoes the writes in it."""
    driver: sqlite3.Connection = connection.connection.driver_connection  # type: ignore[assignment]
    if not driver.in_transaction:
        raise rolled_back()
    driver.execute("SAVEPOINT unit")
    try:
        yield driver
    except BaseException:
        if driver.in_transaction:  # SQLite may have rolled back the transaction, see `rolled_back`
            driver.execute("ROLLBACK TO unit")
            driver.execute("RELEASE unit")
        raise
    driver.execute("RELEASE unit")


class _PendingUnit:
    """A unit of work that waits for the writer thread, or runs in it."""

    # `Any`: the queue has units of every type; `submit` returns the future with the type of its unit.
    def __init__(self, unit: Unit[Any]) -> None:
        self.future: Future[Any] = Future()
        self._unit = unit
        self._context = contextvars.copy_context()
        self._result: Any = None
        self._following: list[Callable[[], object]] = []
        self.error: BaseException | None = None

    def run(self, connection: Connection) -> None:
        """Run the unit in its own savepoint, and keep its result or its error for its caller.

        The savepoint is made by the driver, because SQLAlchemy's costs more than all statements of a small
        unit. A session that uses the ORM makes its own savepoint within it.
        """
        try:
            with _savepoint(connection) as driver:
                session = Session(
                    connection,
                    join_transaction_mode="create_savepoint",
                    expire_on_commit=False,
                    info={DRIVER: driver},
                )
                self._run(session)
                self._following = session.info.get(AFTER, [])
        except BaseException as error:  # even SystemExit belongs to the caller, not to the writer thread
            self.error = error

    def _run(self, session: Session) -> None:
        """Run the unit in its session. An unused session is not closed, which would cost two statements."""
        try:
            self._result = self._context.run(self._unit, session)
            if session.in_transaction():  # the ORM was used
                session.commit()  # writes pending rows; raises if the unit has hidden a failed statement
                session.close()
        except BaseException:
            session.close()
            raise

    def settle(self) -> None:
        """Deliver the outcome to the caller after the group is durable."""
        if self._following:
            self._context.run(follow, self._following)
        if self.error is None:
            self.future.set_result(self._result)
        else:
            self.future.set_exception(self.error)

    def refuse(self, cause: Exception) -> None:
        """Deliver an error to the caller, because the group is lost."""
        if isinstance(cause, DatabaseDamaged):
            self.future.set_exception(cause)
            return
        lost = CommitFailed("The changes could not be committed; nothing was stored.")
        lost.__cause__ = cause
        self.future.set_exception(self.error or lost)
