"""Check that a SQLite file is intact: its pages, its indexes, and the JSON in its rows.

SQLite keeps no checksums. An overwritten page appears as a broken tree, an index that disagrees with its
table, or a text that is not JSON. A changed digit inside a text cannot be detected.
"""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.storage.engines import sqlite_file
from app.storage.errors import DatabaseDamaged
from app.storage.record import opened_file
from app.storage.tables import Base, JsonText, NotWritten

MOST = 5  # largest number of faults in a message
_CORRUPT = {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB}

_sound: dict[
    Path, tuple[tuple[int, int, int], ...]
] = {}  # files that this process has examined without faults
_one_at_a_time = threading.Lock()


def refuse_damage(url: str) -> None:
    """Check that a database is intact, new, or not a SQLite file.

    The time is proportional to its size, some seconds for a gigabyte; an unchanged file is read once.

    Raises
    ------
    DatabaseDamaged
        If the database is damaged; the error names the damaged pages and tables.
    """
    path = sqlite_file(url)
    if path is not None and (marker := marker_of(path)).exists():
        raise DatabaseDamaged(str(path), [*_faults_now(path), _noted(marker)])
    if path is None or not path.is_file() or not path.stat().st_size:
        return
    with _one_at_a_time:
        seen = _seen(path)
        if _sound.get(path) == seen:
            return
        if damage := faults(path):
            raise DatabaseDamaged(str(path), damage)
        _sound[path] = seen


def marker_of(path: Path) -> Path:
    """Return the path of the note beside a SQLite file that records damage found during use."""
    return path.with_name(f"{path.name}.damaged")


def _faults_now(path: Path) -> list[str]:
    """Return the present faults of a file whose damage is already noted."""
    if not path.is_file():
        return [f"{path.name} is missing"]
    try:
        return faults(
            path, mode="ro"
        )  # the folder stays unchanged, so that data can still be recovered from it
    except sqlite3.Error as error:
        return [f"{path.name} cannot be examined ({error})"]


def _noted(marker: Path) -> str:
    text = marker.read_text(encoding="utf-8", errors="replace")[:1000]
    return (
        f"{text}. This was found while the service ran, so rows may be lost even if the file looks intact "
        f"now; check the contents, then delete {marker.name}"
    )


def faults(path: Path, most: int = MOST, mode: str = "rw") -> list[str]:
    """Return at most `most` faults of a SQLite file, one per line; with mode `ro` its log is not changed."""
    with opened_file(path, mode) as connection:
        connection.execute("PRAGMA busy_timeout = 10000")
        # If SQLite stops at a page, it drops the earlier lines, unless only one was requested.
        one = _collected(_of_pages(connection, 1), path)
        if one and most > 1:
            more = _collected(_of_pages(connection, most), path)
            return more if len(more) > 1 else one
        return one or _collected(islice(_of_texts(connection), most), path)


def is_damage(error: BaseException) -> bool:
    """Return whether an error means that the database is damaged."""
    cause = error.orig if isinstance(error, DBAPIError) else error
    if isinstance(cause, sqlite3.Error):
        code = getattr(cause, "sqlite_errorcode", 0) or 0
        wrong_text = any(words in str(cause) for words in ("Could not decode to UTF-8", "malformed JSON"))
        return code & 0xFF in _CORRUPT or wrong_text
    return isinstance(cause, (DatabaseDamaged, NotWritten))


def _seen(path: Path) -> tuple[tuple[int, int, int], ...]:
    log = path.with_name(f"{path.name}-wal")
    stats = [file.stat() for file in (path, log) if file.exists()]
    return tuple((seen.st_ino, seen.st_size, seen.st_mtime_ns) for seen in stats)


def _collected(lines: Iterator[str], path: Path) -> list[str]:
    """Return the lines; if SQLite stops at the first one, return its error."""
    collected: list[str] = []
    try:
        collected.extend(lines)
    except sqlite3.DatabaseError as error:
        if error.sqlite_errorcode & 0xFF not in _CORRUPT:
            raise
        return collected or [f"{_unreadable_schema(path)}: {error}"]
    return collected


def _unreadable_schema(path: Path) -> str:
    """Return the page that prevents SQLite from reading the schema: the first one, or one to which it refers.

    The layout is that of SQLite's file format: a tree of tables has pages of type 5 (inner) and 13 (leaf).
    """
    with path.open("rb") as file:
        first = file.read(65536)
        size = int.from_bytes(first[16:18]) if first[16:18] != b"\0\1" else 65536
        if first[:16] != b"SQLite format 3\0" or first[100] != 5:
            return "page 1, the header"
        cells = (int.from_bytes(first[112 + 2 * n :][:2]) for n in range(int.from_bytes(first[103:105])))
        for page in [
            *(int.from_bytes(first[cell : cell + 4]) for cell in cells),
            int.from_bytes(first[108:112]),
        ]:
            file.seek((page - 1) * size)
            if file.read(1) not in (b"\x05", b"\x0d"):
                return f"page {page}, of the schema"
    return f"some page, perhaps one in its log {path.name}-wal"


def _of_pages(connection: sqlite3.Connection, most: int) -> Iterator[str]:
    """Yield faults of trees, free pages and indexes in SQLite's words."""
    for (text,) in connection.execute(f"PRAGMA integrity_check({most})"):
        lines = (line.strip() for line in text.splitlines())
        yield from (line for line in lines if line not in ("", "ok", "*** in database main ***"))


def _of_texts(connection: sqlite3.Connection) -> Iterator[str]:
    """Yield the rows that contain texts which should be JSON but are not.

    A database of an older program may lack columns.
    """
    for table in Base.metadata.sorted_tables:
        there = {row[1] for row in connection.execute(f"PRAGMA table_info({table.name})")}
        for column in (c.name for c in table.columns if isinstance(c.type, JsonText) and c.name in there):
            wrong = f"SELECT rowid FROM {table.name} WHERE {column} IS NOT NULL AND NOT json_valid({column})"
            for (row,) in connection.execute(wrong):
                yield f"row {row} of table {table.name}: {column} is not JSON"
