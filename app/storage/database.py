"""The database of the process: reads in snapshots, and writes by units of work.

The way to write units depends on the kind of database: `app.storage.group_writer` (SQLite) and
`app.storage.pool_writer` (PostgreSQL).
"""

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager

from sqlalchemy.orm import Session

from app.storage.clock import OperationClock, SharedClock
from app.storage.engines import is_sqlite, reading_engine, sqlite_file, writing_engine
from app.storage.group_writer import GroupWriter, Watch
from app.storage.record import RecordKeeper, before_close
from app.storage.units import READS, T, Unit, Writer, after_commit, repeatable

__all__ = ["Database", "Unit", "after_commit", "repeatable"]

POOL = 16  # number of connections to PostgreSQL for writing, and the same number for reading


class Database:
    """Reads in snapshots, writes by units of work; once damage is found, it only reads.

    `on_commit` is called with each transaction's number of units, its time [s], and whether it failed. A unit
    runs in the context (`contextvars`) of its caller. On PostgreSQL it may run several times, so it must have
    no other effect than the writes of its session; actions that follow it are registered with `after_commit`.

    Rows stay readable after their session has ended; attributes that were not loaded by then cannot be loaded
    later.
    """

    def __init__(
        self, url: str, on_commit: Callable[[int, float, bool], object] | None = None, pool: int = POOL
    ) -> None:
        said = on_commit or (lambda units, seconds, failed: None)
        self.url = url
        self.is_shared = not is_sqlite(url)
        """Whether several servers may use this database at the same time."""
        self.record: RecordKeeper | None = None
        """The record beside the file, if this process keeps it."""
        self.watch = Watch(url)
        self._reader = reading_engine(url, pool)
        self._info = {} if self.is_shared else {READS: True}
        engine = writing_engine(url, pool)
        self.clock: OperationClock | SharedClock
        self._writer: Writer
        if self.is_shared:
            from app.storage.pool_writer import PooledWriter

            self._writer = PooledWriter(engine, pool, said)
            self.clock = SharedClock(self._writer)
        else:
            self.clock = OperationClock()
            self._writer = GroupWriter(engine, self.clock, self.watch, said)

    @contextmanager
    def read(self) -> Iterator[Session]:
        """Open a session on a read-only snapshot of the database.

        Raises
        ------
        DatabaseDamaged
            If the requested rows cannot be read.
        DatabaseUnavailable
            If the database server cannot be reached.
        """
        self.watch.require_file()
        try:
            with Session(self._reader, expire_on_commit=False, info=self._info) as session:
                yield session
        except BaseException as error:
            self.watch.raise_if_damage(error)
            if self.is_shared:
                _raise_if_unavailable(error)
            raise

    def write(self, unit: Unit[T]) -> T:
        """Run a unit of work and return its result once it is durable.

        Raises
        ------
        CommitFailed
            If the unit ran, but could not be committed; nothing of it is stored.
        CommitUnknown
            If the connection was lost during the commit: the unit may be stored or not.
        DatabaseUnavailable
            If the database server cannot be reached; nothing is stored.
        DatabaseClosed
            If the database has been closed.
        DatabaseDamaged
            If the database is damaged; nothing is stored.
        Exception
            The error that the unit raises; only its own changes are undone.
        """
        return self._writer.write(unit)

    def submit(self, unit: Unit[T]) -> "Future[T]":
        """Queue a unit of work for writing; its future raises the same errors as `write`."""
        return self._writer.submit(unit)

    def write_through(self, around: Callable[[Writer], Writer]) -> None:
        """Send all further units of work through a wrapper of the writer."""
        self._writer = around(self._writer)

    def close(self) -> None:
        """Commit the waiting units, then close all connections. A second call does nothing.

        Once damage is found, the connections stay open until the process ends: SQLite copies its log into the
        file when the last one is closed, and a damaged log would overwrite intact pages.
        """
        self.clock.close()
        self._writer.close()
        if self.watch.damage is None:
            self._before_close()
            self._reader.dispose()
            self._writer.engine.dispose()

    def _before_close(self) -> None:
        record, self.record = self.record, None
        if record is not None:
            record.close()
        elif (file := sqlite_file(self.url)) is not None:
            before_close(file)


def _raise_if_unavailable(error: BaseException) -> None:
    from app.storage.losses import translated

    if isinstance(error, Exception) and (meant := translated(error)) is not error:
        raise meant from error
