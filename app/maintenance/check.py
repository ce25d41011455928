"""Check a data folder: the database, the files that its rows name, and the files that no row names.

The check only reads, so it can run while the service runs.
"""

from __future__ import annotations

import math
import sqlite3
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from app.maintenance.errors import CannotRun
from app.maintenance.files import Files, FolderFiles
from app.maintenance.folder import database_file, reading, refuse_other_schema
from app.maintenance.rows import NamedFile, broken_references, broken_worksheets, named_files
from app.storage.integrity import faults, is_damage, marker_of
from app.storage.record import fault_of

YOUNG = 60.0  # longest time between storing a file and committing its row [s]
# by kind of file; of a build else
OWNERS = {
    "surface": "analysis", "body": "job", "answer": "job", "rows": "study", "import": "worksheet",
    "model": "model",
}  # fmt: skip
MOST = 100  # largest number of database faults listed

Say = Callable[[str], None]


@dataclass
class Faults:
    """The faults of a data folder; `damaged` and `unnamed` files can be repaired."""

    database: list[str] = field(default_factory=list)
    references: list[str] = field(default_factory=list)
    worksheets: list[str] = field(default_factory=list)
    damaged: dict[NamedFile, str] = field(default_factory=dict)  # fault of the file, by row
    unnamed: dict[str, str] = field(default_factory=dict)  # place of the file, by hash
    files: int = 0
    size: int = 0  # of the good files [bytes]
    quarantined: int = 0

    @property
    def count(self) -> int:
        """Return the number of faults."""
        return sum(map(len, (self.database, self.references, self.worksheets, self.damaged, self.unnamed)))

    def add_unnamed(
        self, files: Files, ages: Mapping[str, float], rows: Iterable[NamedFile], *, in_use: bool
    ) -> None:
        """Add the files that no row names, except those that a running service may have stored just now."""
        named, latest = {row.sha for row in rows}, time.time() - YOUNG if in_use else math.inf
        lying = sorted(sha for sha, age in ages.items() if sha not in named and age <= latest)
        self.unnamed |= {sha: files.place(sha) for sha in lying}

    def lines(self) -> Iterable[str]:
        """Yield the faults, one per line, then the counts."""
        yield from (f"database: {text}" for text in self.database)
        yield from (f"reference: {text}" for text in self.references)
        yield from (f"worksheet: {text}" for text in self.worksheets)
        for row, text in self.damaged.items():
            owner = OWNERS.get(row.kind, "build")
            yield f"artifact {row.sha}, {row.kind} of {owner} {row.owner}: {text}"
        yield from (f"file {place}: no row names it" for place in self.unnamed.values())
        yield f"{self.files} good artifacts, {self.size / 2**20:.1f} MiB; {self.quarantined} in quarantine"
        yield f"{self.count} fault{'' if self.count == 1 else 's'}"


def check(data: Path, url: str | None, *, in_use: bool, files: Files | None = None) -> Faults:
    """Find the faults of a data folder; if a service uses it (`in_use`), the newest files may lack rows.

    `files` are by default those in the folder.

    Raises
    ------
    CannotRun
        If there is no database, or it has another schema.
    """
    path, findings = database_file(data, url), Faults()
    files = files or FolderFiles(data / "artifacts")
    findings.quarantined = files.quarantined()
    # Read files before rows: a row added meanwhile already has its file, and is among the rows.
    ages = files.ages()
    if (marker := marker_of(path)).exists():
        findings.database.append(f"damage occurred while a service used it, see {marker.name}")
    try:
        findings.database += faults(path, MOST, mode="ro" if marker.exists() else "rw")
        if not findings.database and (loss := fault_of(path)):
            findings.database.append(f"{loss}; restore a backup, or run `crankwright accept`")
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
    check_files(files, rows, findings)
    findings.damaged = {row: text for row, text in findings.damaged.items() if is_still_named(path, row)}
    findings.add_unnamed(files, ages, rows, in_use=in_use)
    return findings


def check_files(files: Files, rows: Iterable[NamedFile], findings: Faults) -> None:
    """Verify every file that a row names, once."""
    seen: dict[str, str | None] = {}
    for row in rows:
        if row.sha not in seen:
            seen[row.sha] = files.fault(row)
            findings.files += seen[row.sha] is None
            findings.size += _size(files, row) if seen[row.sha] is None else 0
        if text := seen[row.sha]:
            findings.damaged[row] = text


def _size(files: Files, row: NamedFile) -> int:
    return files.size(row.sha) if row.size is None else row.size


def is_still_named(database: Path, row: NamedFile) -> bool:
    """Return whether the row of a file still exists: a running service may delete both."""
    with reading(database) as connection:
        return any(other == row for other in named_files_of(connection, row))


def named_files_of(connection: sqlite3.Connection, row: NamedFile) -> Iterable[NamedFile]:
    """Return the present rows of the same kind of file; the given row is among them if it still exists."""
    if row.kind in OWNERS:
        return (other for other in named_files(connection) if other.kind == row.kind)
    query = "SELECT sha256, size, build_key, kind FROM artifact WHERE build_key = ? AND kind = ?"
    return (NamedFile(*fields) for fields in connection.execute(query, (row.owner, row.kind)))
