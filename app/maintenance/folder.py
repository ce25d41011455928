"""Read a data folder for maintenance, without writing to it, because a running service may be using it."""

from __future__ import annotations

import fcntl
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from app.maintenance.errors import CannotRun
from app.storage.engines import sqlite_file
from app.storage.errors import DatabaseLost, StorageError
from app.storage.folder import DATABASE, LOCK
from app.storage.integrity import is_damage, marker_of
from app.storage.migrations import known_schemas, refuse_unknown
from app.storage.record import fault_of, opened_file

NOT_SQLITE = (
    "The database is not SQLite, so lost files are not repaired here: the servers rebuild them when a client "
    "requests them."
)


def database_file(data: Path, url: str | None) -> Path:
    """Return the SQLite file of a data folder.

    Raises
    ------
    CannotRun
        If there is none.
    """
    path = sqlite_file(url) if url else data / DATABASE
    if path is None:
        raise CannotRun(NOT_SQLITE)
    if not path.is_file():
        if marker_of(path).exists():
            raise CannotRun(
                f"The database {path.absolute()} is missing, and {marker_of(path).name} notes that it was "
                "lost while a service used it: restore the last backup into a new folder."
            )
        if fault := fault_of(path):
            raise CannotRun(str(DatabaseLost(path, fault, is_gone=True)))
        raise CannotRun(f"There is no database {path.absolute()}: name the data folder with --data.")
    return path


def is_in_use(data: Path) -> bool:
    """Return whether a service uses the folder; unlike `DataFolder`, this creates and locks nothing."""
    try:
        with (data / LOCK).open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


@contextmanager
def reading(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a read-only connection to one snapshot; a service may use the file at the same time."""
    with opened_file(path, isolation_level=None) as connection:
        for pragma in ("busy_timeout = 10000", "query_only = on"):
            connection.execute(f"PRAGMA {pragma}")
        connection.execute("BEGIN")
        yield connection


def refuse_other_schema(connection: sqlite3.Connection, *, older_too: bool) -> str:
    """Return the version of the schema.

    Raises
    ------
    CannotRun
        If this program does not know the version, or it is old and old versions are refused.
    """
    try:
        rows = connection.execute("SELECT version_num FROM alembic_version").fetchall()
    except sqlite3.OperationalError as error:
        if is_damage(error):
            raise
        raise CannotRun("The file is not a database of Crankwright.") from None
    schema = str(rows[0][0]) if rows else "none"
    try:
        refuse_unknown(schema)
    except StorageError as error:
        raise CannotRun(str(error)) from None
    if older_too and schema != (newest := known_schemas()[0]):
        raise CannotRun(
            f"The database has schema {schema}, older than this program's {newest}: start the service "
            "once to upgrade it."
        )
    return schema
