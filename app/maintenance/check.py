"""Check a data folder: the database, the files that its rows name, and the files that no row names.

It only reads, so it may run beside the service.
"""

from __future__ import annotations

import hashlib
import sqlite3
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from app.maintenance.errors import CannotRun
from app.maintenance.folder import database_file, reading, refuse_other_schema
from app.maintenance.rows import Named, broken_references, broken_worksheets, named_files
from app.storage.artifacts import QUARANTINE, SHA256
from app.storage.integrity import faults, is_damage, marker_of

YOUNG = 60.0  # a file of a running service may be this old before the row that names it is committed [s]
# by kind of file; of a build else
OWNERS = {"surface": "analysis", "body": "job", "answer": "job", "rows": "study", "import": "worksheet"}
MOST = 100  # faults of the database that are listed

Say = Callable[[str], None]


@dataclass
class Findings:
    """What is wrong in a data folder; `damaged` and `unnamed` can be repaired."""

    database: list[str] = field(default_factory=list)
    references: list[str] = field(default_factory=list)
    worksheets: list[str] = field(default_factory=list)
    damaged: dict[Named, str] = field(default_factory=dict)  # by row, what is wrong with its file
    unnamed: list[Path] = field(default_factory=list)
    files: int = 0
    size: int = 0  # of the good files [bytes]
    quarantined: int = 0

    @property
    def count(self) -> int:
        """How many faults there are."""
        return sum(map(len, (self.database, self.references, self.worksheets, self.damaged, self.unnamed)))

    def lines(self) -> Iterable[str]:
        """The faults, one a line, then what was counted."""
        yield from (f"database: {text}" for text in self.database)
        yield from (f"reference: {text}" for text in self.references)
        yield from (f"worksheet: {text}" for text in self.worksheets)
        for row, text in self.damaged.items():
            owner = OWNERS.get(row.kind, "build")
            yield f"artifact {row.sha}, {row.kind} of {owner} {row.owner}: {text}"
        yield from (f"file {path}: no row names it" for path in self.unnamed)
        yield f"{self.files} good artifacts, {self.size / 2**20:.1f} MiB; {self.quarantined} in quarantine"
        yield f"{self.count} fault{'' if self.count == 1 else 's'}"


def check(data: Path, url: str | None, *, in_use: bool) -> Findings:
    """What is wrong in a data folder; `in_use` if a service runs on it, whose newest files may lack rows.

    Raises
    ------
    CannotRun
        There is no database, or one of another schema.
    """
    path, findings = database_file(data, url), Findings()
    artifacts = data / "artifacts"
    findings.quarantined = sum(1 for _ in artifacts.glob(f"{QUARANTINE}/*"))
    # Files before rows: a row that comes meanwhile has its file already, and is among the rows.
    files = [file for file in artifacts.glob("[0-9a-f][0-9a-f]/*") if SHA256.fullmatch(file.name)]
    if (marker := marker_of(path)).exists():
        findings.database.append(f"damage showed while a service used it, see {marker.name}")
    try:
        findings.database += faults(path, MOST, mode="ro" if marker.exists() else "rw")
        with reading(path) as connection:
            refuse_other_schema(connection, older_too=True)
            findings.references += broken_references(connection)
            findings.worksheets += broken_worksheets(connection)
            rows = list(named_files(connection))
    except (sqlite3.DatabaseError, ValueError) as error:
        if not (is_damage(error) or findings.database):
            raise CannotRun(f"The database cannot be read: {error}") from error
        findings.database = findings.database or [str(error)]
        return findings
    _check_files(artifacts, rows, findings, path)
    named = {row.sha for row in rows}
    findings.unnamed += (f for f in files if f.name not in named and not (in_use and _is_young(f)))
    return findings


def _check_files(artifacts: Path, rows: Iterable[Named], findings: Findings, database: Path) -> None:
    seen: dict[str, str | None] = {}
    for row in rows:
        if row.sha not in seen:
            seen[row.sha] = fault_of(artifacts / row.sha[:2] / row.sha, row)
            findings.files += seen[row.sha] is None
            findings.size += _size(artifacts, row) if seen[row.sha] is None else 0
        text = seen[row.sha]
        if text and is_still_named(database, row):
            findings.damaged[row] = text


def _size(artifacts: Path, row: Named) -> int:
    return (artifacts / row.sha[:2] / row.sha).stat().st_size if row.size is None else row.size


def fault_of(path: Path, row: Named) -> str | None:
    """What is wrong with the file of a row, if anything is; its size is in bytes."""
    try:
        size = path.stat().st_size
        if row.size is not None and size != row.size:
            return f"the file has {size} bytes instead of {row.size}"
        with path.open("rb") as file:
            if hashlib.file_digest(file, "sha256").hexdigest() != row.sha:
                return "the bytes have another hash"
    except FileNotFoundError:
        return "the file is missing"
    except OSError as error:
        return f"the file cannot be read: {error.strerror}"
    return None


def is_still_named(database: Path, row: Named) -> bool:
    """Whether the row of a file is still there: a running service may delete both."""
    with reading(database) as connection:
        return any(other == row for other in named_files_of(connection, row))


def named_files_of(connection: sqlite3.Connection, row: Named) -> Iterable[Named]:
    """The row as it stands now, if it does."""
    if row.kind in OWNERS:
        return (other for other in named_files(connection) if other.kind == row.kind)
    query = "SELECT sha256, size, build_key, kind FROM artifact WHERE build_key = ? AND kind = ?"
    return (Named(*fields) for fields in connection.execute(query, (row.owner, row.kind)))


def _is_young(path: Path) -> bool:
    try:
        return time.time() - path.stat().st_mtime < YOUNG
    except FileNotFoundError:  # deleted meanwhile
        return True
