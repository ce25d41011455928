"""The record beside the SQLite database of a data folder, which shows at a start that the database was lost.

The file names the database, a sealed row of its audit, and whether a process has it open. It is written after
the row is durable, so it may lag the database and never leads it. Without it, a deleted database would look
like a new service, and an older copy like the present state.
"""

from __future__ import annotations

import json
import logging
import os
import secrets
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.storage.errors import DatabaseLost, DataFolderInUse
from app.storage.folder import DataFolder
from app.storage.tables import CounterRow
from app.storage.units import insert_new, repeatable

logger = logging.getLogger(__name__)

NAME = "database"  # name of the counter with the identity


@dataclass(frozen=True)
class DatabaseRecord:
    """What the file contains; `seq` and `hash` are of a sealed row of the audit, 0 and None before any."""

    database: str
    seq: int = 0
    hash: str | None = None
    is_open: bool = False


def identity(session: Session) -> str:
    """Return the identity of a database, created at random at the first request; backups share it."""
    repeatable(session)
    insert_new(session, CounterRow(name=NAME, value=secrets.randbits(63)))
    return _text(session.scalars(select(CounterRow.value).where(CounterRow.name == NAME)).one())


def record_of(file: Path) -> Path:
    """Return the path of the record of a SQLite file."""
    return file.with_name(f"{file.name}.head")


def require_kept(file: Path) -> None:
    """Check that the file and its log are still there; the caller holds the data folder.

    If a killed process has left its log, the record then shows the database as closed, because the next
    connection that is closed merges the log and deletes it.

    Raises
    ------
    DatabaseLost
        If the file is missing, or its log is missing although no process has closed the database.
    """
    record = _read(file)
    if fault := record and _missing(file, record):
        raise DatabaseLost(file, fault, is_gone=not file.exists())
    if record is not None and record.is_open:
        _write(file, replace(record, is_open=False))


def require_same(file: Path) -> None:
    """Check that a sound file is the recorded database with the recorded row; raises DatabaseLost."""
    if fault := _other(file):
        raise DatabaseLost(file, fault)


def fault_of(file: Path) -> str | None:
    """Return why a start would refuse a sound or missing file; None if it would not. Nothing is changed."""
    try:
        record = _read(file)
        return (_missing(file, record) or _other(file)) if record is not None else None
    except DatabaseLost as error:
        return error.fault


def write_first(file: Path) -> None:
    """Record a closed database, such as a restored one, if it has an identity already."""
    with opened_file(file) as connection:
        name, _ = _contents(connection, 0)
    if name is not None:
        _write(file, DatabaseRecord(name))


class RecordKeeper:
    """Writes the record of the database that this process has open; the first failure is logged."""

    def __init__(self, file: Path, database: str) -> None:
        self._file, self._is_written = file, True
        self._replace(_read(file) or DatabaseRecord(database))

    def note(self, seq: int, hash: str) -> None:
        """Record a sealed row that is durable."""
        self._replace(replace(self._record, seq=seq, hash=hash))

    def close(self) -> None:
        """Record that the database is closed: call this after the last write, before connections close."""
        _write(self._file, replace(self._record, is_open=False))

    def _replace(self, record: DatabaseRecord) -> None:
        self._record = replace(record, is_open=True)
        is_written = _write(self._file, self._record)
        if self._is_written and not is_written:
            logger.warning("%s cannot be written; it keeps an older row of the audit", record_of(self._file))
        self._is_written = is_written


@contextmanager
def opened_file(
    file: Path, mode: str = "rw", isolation_level: str | None = ""
) -> Iterator[sqlite3.Connection]:
    """Open a connection to a SQLite file that a service may be using."""
    place = f"{file.absolute().as_uri()}?mode={mode}"
    connection = sqlite3.connect(place, uri=True, isolation_level=isolation_level)  # type: ignore[arg-type]
    with closing(connection):
        try:
            yield connection
        finally:
            before_close(file)


def before_close(file: Path) -> None:
    """Record that the database is closed, if the process that had it open was killed.

    SQLite merges the log and deletes it when the last connection closes. Call this before a connection closes
    that may be the last one and is not that of the server.
    """
    with suppress(DatabaseLost, DataFolderInUse, OSError):
        record = _read(file)
        if record is None or not record.is_open:
            return
        folder = DataFolder(file.parent)  # refused if that process lives, or if this one holds the folder
        try:
            _write(file, replace(record, is_open=False))
        finally:
            folder.release()


def _read(file: Path) -> DatabaseRecord | None:
    """Return the record of a file; None if there is none."""
    path = record_of(file)
    try:
        read = json.loads(path.read_bytes())
        record = DatabaseRecord(**read)
        values = record.database, record.seq, record.is_open
        if not (tuple(map(type, values)) == (str, int, bool) and isinstance(record.hash, str | None)):
            raise ValueError(read)
    except FileNotFoundError:
        return None
    except (ValueError, TypeError) as error:
        raise DatabaseLost(file, f"{path.name} is not the record of a database") from error
    return record


def _write(file: Path, record: DatabaseRecord) -> bool:
    """Replace the record and return whether that succeeded; the disk may be full.

    An older record stays, because it may lag; but one that shows a closed database as open is deleted.
    """
    path, temporary = record_of(file), record_of(file).with_name(f".{record_of(file).name}.new")
    try:
        with temporary.open("w", encoding="utf-8") as out:
            json.dump(asdict(record), out)
            out.flush()
            os.fsync(out.fileno())
        os.replace(temporary, path)
        _sync(path.parent)
    except OSError:
        for each in (temporary,) if record.is_open else (temporary, path):
            with suppress(OSError):
                each.unlink(missing_ok=True)
        return False
    return True


def _sync(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _missing(file: Path, record: DatabaseRecord) -> str | None:
    """Return which file is missing; None if none is."""
    if not file.exists():
        return f"the folder had a database, and {file.name} is missing"
    log = file.with_name(f"{file.name}-wal")
    if record.is_open and not log.exists():
        return f"the service was killed, and {log.name} with its last changes is missing"
    return None


def _other(file: Path) -> str | None:
    """Return how a file differs from its record; None if it does not, or there is no record."""
    record = _read(file)
    if record is None:
        return None
    with opened_file(file) as connection:
        name, hash = _contents(connection, record.seq)
    if name != record.database:
        return f"{file.name} is database {name or 'without a name'}, and the folder had {record.database}"
    if hash == record.hash:
        return None
    row = f"row {record.seq} of the audit"
    if hash is None:
        return f"{file.name} lacks {row}, which the folder had: it is an older copy, or rows were removed"
    return f"{file.name} has another {row} than the folder had"


def _contents(connection: sqlite3.Connection, seq: int) -> tuple[str | None, str | None]:
    """Return the identity of a database and the hash of a sealed row, each None if it has none."""
    try:
        name = connection.execute("SELECT value FROM counter WHERE name = ?", (NAME,)).fetchone()
        row = connection.execute("SELECT hash FROM audit WHERE seq = ?", (seq,)).fetchone()
    except sqlite3.OperationalError:  # it has no such tables
        return None, None
    return name and _text(name[0]), row and row[0]


def _text(number: int) -> str:
    return f"{number:016x}"
