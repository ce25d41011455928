"""The database of the process: many readers, one writer thread that commits waiting units of work in groups.

SQLite takes one writer at a time and syncs the disk at every commit. One thread that runs all waiting units
in one transaction pays one sync for all of them, and nobody ever meets a locked database.
"""

import asyncio
import contextvars
import queue
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any, TypeVar

from sqlalchemy import Connection
from sqlalchemy.orm import Session

from app.storage.clock import OperationClock
from app.storage.damage import Watch
from app.storage.engines import reading_engine, writing_engine
from app.storage.errors import CommitFailed, DatabaseClosed, DatabaseDamaged

T = TypeVar("T")
Unit = Callable[[Session], T]

GROUP = 256  # units in one transaction: bounds how long the first of them waits for the last


class Database:
    """Reads in snapshots, writes by units of work; once damage has shown, it only reads.

    `on_commit` is called with each group's number of units, its time [s], and whether it failed. A unit
    runs in the context (`contextvars`) of its caller.

    Rows stay readable after their session has ended; what was not loaded by then cannot be loaded later.
    """

    def __init__(self, url: str, on_commit: Callable[[int, float, bool], object] | None = None) -> None:
        self._on_commit = on_commit or (lambda units, seconds, failed: None)
        self.watch = Watch(url)
        self._reader = reading_engine(url)
        self._writer = writing_engine(url)
        self.clock = OperationClock()
        self._waiting: queue.SimpleQueue[_Pending | None] = queue.SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._thread = threading.Thread(target=self._serve, name="database-writer", daemon=True)
        self._thread.start()

    @contextmanager
    def read(self) -> Iterator[Session]:
        """Open a session on a snapshot of the database; it cannot write.

        Raises
        ------
        DatabaseDamaged
            What was to be read cannot be read.
        """
        self.watch.require_file()
        try:
            with Session(self._reader, expire_on_commit=False) as session:
                yield session
        except BaseException as error:
            self.watch.raise_if_damage(error)
            raise

    def write(self, unit: Unit[T]) -> T:
        """Run a unit of work in the writer thread and return its result once that is durable.

        Raises
        ------
        CommitFailed
            The unit ran, but its group could not be committed; nothing of it is stored.
        DatabaseClosed
            The database has been closed.
        DatabaseDamaged
            The database is damaged; nothing is stored.
        Exception
            Whatever the unit raises; its changes, and no others, are undone.
        """
        if threading.current_thread() is self._thread:
            raise RuntimeError("A unit of work may not wait for another: use its session.")
        return self.submit(unit).result()

    async def awrite(self, unit: Unit[T]) -> T:
        """Like `write`, for a caller in an event loop."""
        return await asyncio.wrap_future(self.submit(unit))

    def close(self) -> None:
        """Commit what waits, then close all connections. A second call does nothing.

        Once damage has shown, the connections stay open until the process ends: SQLite copies its log into
        the file when the last one is closed, and a damaged log would overwrite pages that are whole.
        """
        with self._closing:
            if not self._closed:
                self._waiting.put(None)
            self._closed = True
        self._thread.join()
        if self.watch.damage is None:
            self._reader.dispose()
            self._writer.dispose()

    def submit(self, unit: Unit[T]) -> "Future[T]":
        """Queue a unit of work; its future raises as `write` does."""
        if self.watch.damage is not None:  # whether the file is still there shows when the group begins
            self.watch.refuse()
        pending = _Pending(unit)
        with self._closing:  # nothing may enter the queue behind its end
            if self._closed:
                raise DatabaseClosed("The database is closed.")
            self._waiting.put(pending)
        return pending.future

    def _serve(self) -> None:
        more = True
        while more:
            group, more = self._next_group()
            wanted = [pending for pending in group if pending.future.set_running_or_notify_cancel()]
            if wanted:
                self._commit(wanted)
        if self.clock.elapsed:
            self._commit([])

    def _next_group(self) -> "tuple[list[_Pending], bool]":
        """Wait for a unit, then take those that came meanwhile; also return whether more may come."""
        group: list[_Pending] = []
        while not group or (len(group) < GROUP and not self._waiting.empty()):
            pending = self._waiting.get()
            if pending is None:
                return group, False
            group.append(pending)
        return group, True

    def _commit(self, group: "list[_Pending]") -> None:
        start = time.perf_counter()
        try:
            with self._writer.begin() as connection:
                self.watch.refuse()  # damage may have shown while the group was waiting
                seconds = self.clock.advance(connection)
                for pending in group:
                    pending.run(connection)
                    if pending.error is not None:
                        self.watch.raise_if_damage(pending.error)
            self.watch.refuse()  # a file that was deleted meanwhile has taken the commit along
        except Exception as error:
            self._on_commit(len(group), time.perf_counter() - start, True)
            cause = self.watch.translated(error)
            for pending in group:
                pending.refuse(cause)
        else:
            self._on_commit(len(group), time.perf_counter() - start, False)
            self.clock.commit(seconds)
            for pending in group:
                pending.settle()


class _Pending:
    """A unit of work on its way through the writer thread."""

    # `Any`: one queue holds units of every type; `submit` returns the future under the type of its unit.
    def __init__(self, unit: Unit[Any]) -> None:
        self.future: Future[Any] = Future()
        self._unit = unit
        self._context = contextvars.copy_context()
        self._result: Any = None
        self.error: BaseException | None = None

    def run(self, connection: Connection) -> None:
        """Run the unit in a savepoint of its own; what it raises is kept for its caller."""
        session = Session(connection, join_transaction_mode="create_savepoint", expire_on_commit=False)
        try:
            with session:
                self._result = self._context.run(self._unit, session)
                session.commit()  # releases the savepoint; raises if the unit has hidden a failed statement
        except BaseException as error:  # even SystemExit belongs to the caller, not to the writer thread
            self.error = error

    def settle(self) -> None:
        """Hand the outcome to the caller: the group is durable."""
        if self.error is None:
            self.future.set_result(self._result)
        else:
            self.future.set_exception(self.error)

    def refuse(self, cause: Exception) -> None:
        """Tell the caller that the group is lost."""
        if isinstance(cause, DatabaseDamaged):
            self.future.set_exception(cause)
            return
        lost = CommitFailed("The changes could not be committed; nothing was stored.")
        lost.__cause__ = cause
        self.future.set_exception(self.error or lost)
