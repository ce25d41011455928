"""Back up a data folder while the service runs: first a snapshot of the database, then the files it names.

The bytes of an artifact are synced before the row that names it is committed. So every file of the snapshot
exists, unless it is damaged or the service has deleted it together with its row in the meantime.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import sqlite3
import tarfile
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import NotRequired, TypedDict

from app.maintenance.archive import DATABASES, END, FORMAT, MANIFEST, artifact_entry, is_compressed
from app.maintenance.check import Say, is_still_named
from app.maintenance.errors import CannotRun
from app.maintenance.files import fault_of
from app.maintenance.folder import database_file, reading, refuse_other_schema
from app.maintenance.rows import NamedFile, named_files
from app.storage.clock import now
from app.storage.integrity import faults

EVERY = 500  # artifacts between two progress messages


@dataclass
class Contents:
    """The contents of a backup: the number of artifacts, the bytes, and files that could not be included."""

    artifacts: int = 0
    size: int = 0  # bytes
    damaged: dict[str, str] = field(default_factory=dict)  # fault, by hash
    deleted: list[str] = field(default_factory=list)  # hashes, deleted with their rows after the snapshot


def back_up(data: Path, url: str | None, target: Path, say: Say) -> Contents:
    """Write a backup; the archive receives its final name once it is complete and synced.

    Raises
    ------
    CannotRun
        If there is no SQLite database, it is damaged, or the target exists.
    OSError
        If the archive cannot be written.
    """
    source = database_file(data, url)
    refuse_target(target)
    with temporary(target, "database") as snapshot, temporary(target, "archive") as archive:
        schema = _snapshot(source, snapshot)
        say(f"database: {snapshot.stat().st_size / 2**20:.1f} MiB, schema {schema}")
        contents = _write(archive, snapshot, schema, source, data, is_compressed(target), say)
        publish(archive, target)
    return contents


def refuse_target(target: Path) -> None:
    """Raise CannotRun if a backup cannot be written there."""
    if target.exists():
        raise CannotRun(f"{target} exists: a backup never replaces another; choose a new name.")
    if not target.absolute().parent.is_dir():
        raise CannotRun(f"There is no folder {target.absolute().parent} for the backup.")


def _snapshot(source: Path, snapshot: Path) -> str:
    """Copy a consistent snapshot of the database into a single file, and return its schema."""
    try:
        with reading(source) as connection, closing(sqlite3.connect(snapshot)) as copy:
            schema = refuse_other_schema(connection, older_too=False)
            connection.backup(copy)  # copies all pages in one step; later writes are not included
            copy.execute("PRAGMA journal_mode = delete")
    except sqlite3.DatabaseError as error:
        raise CannotRun(f"The database cannot be read: {error}. Run `crankwright check`.") from error
    if damage := faults(snapshot):
        raise CannotRun(f"The database is damaged, so it is not backed up: {'; '.join(damage)}.")
    return schema


def _write(
    archive: Path, snapshot: Path, schema: str, source: Path, data: Path, compressed: bool, say: Say
) -> Contents:
    with reading(snapshot) as connection:
        rows = {row.sha: row for row in named_files(connection)}
    about = manifest(FORMAT, snapshot, schema, len(rows))

    def add(tar: tarfile.TarFile, row: NamedFile, contents: Contents) -> None:
        _add_artifact(tar, row, source, data, contents)

    return write_archive(archive, compressed, about, snapshot, rows, add, say)


class DatabaseFile(TypedDict):
    """The database in a backup: its hash and its size [bytes]."""

    sha256: str
    size: int


class Manifest(TypedDict):
    """The manifest, which describes the backup."""

    format: int
    program: str
    created: str
    schema: str
    database: DatabaseFile
    artifacts: int
    files: NotRequired[bool]  # whether the archive holds the files; absent in older backups


def write_archive(
    archive: Path,
    compressed: bool,
    about: Manifest,
    database: Path,
    rows: Mapping[str, NamedFile],
    add: Callable[[tarfile.TarFile, NamedFile, Contents], None],
    say: Say,
) -> Contents:
    """Write the manifest, the database and the named files into an archive, and sync it.

    `add` writes each file.
    """
    contents = Contents()
    with archive.open("wb") as file:
        with tarfile.open(fileobj=file, mode="w:gz" if compressed else "w") as tar:
            _add(tar, MANIFEST, _json(about))
            tar.add(database, DATABASES[about["format"]], filter=_plain)
            for number, row in enumerate(rows.values(), 1):
                add(tar, row, contents)
                if number % EVERY == 0:
                    say(f"artifacts: {number} of {len(rows)}")
            _add(tar, END, _json({"artifacts": contents.artifacts, "missing": _missing(contents)}))
        file.flush()
        os.fsync(file.fileno())
    return contents


def _add_artifact(tar: tarfile.TarFile, row: NamedFile, source: Path, data: Path, contents: Contents) -> None:
    """Add one artifact, if the bytes written have its hash."""
    path = data / artifact_entry(row.sha)
    try:
        read = path.read_bytes()
    except OSError:
        read = b""
    if hashlib.sha256(read).hexdigest() == row.sha:
        add_file(tar, row.sha, read, contents)
    elif is_still_named(source, row):
        contents.damaged[row.sha] = fault_of(path, row) or "the file was replaced while it was read"
    else:
        contents.deleted.append(row.sha)


def manifest(form: int, snapshot: Path, schema: str, artifacts: int) -> Manifest:
    """Return the manifest of a backup: its format, time and program, and the hash of the database."""
    with snapshot.open("rb") as file:
        sha = hashlib.file_digest(file, "sha256").hexdigest()
    size = snapshot.stat().st_size
    return {
        "format": form,
        "program": version("crankwright"),
        "created": now(),
        "schema": schema,
        "database": {"sha256": sha, "size": size},
        "artifacts": artifacts,
    }


def _missing(contents: Contents) -> list[str]:
    return sorted([*contents.damaged, *contents.deleted])


def _json(value: object) -> bytes:
    return json.dumps(value, indent=1).encode()


def add_file(tar: tarfile.TarFile, sha: str, data: bytes, contents: Contents) -> None:
    """Add the bytes of an artifact to the archive."""
    _add(tar, artifact_entry(sha), data)
    contents.artifacts += 1
    contents.size += len(data)


def _add(tar: tarfile.TarFile, name: str, data: bytes) -> None:
    entry = tarfile.TarInfo(name)
    entry.size, entry.mode = len(data), 0o644
    tar.addfile(entry, io.BytesIO(data))


def _plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    """Return the entry of an archive without the owner and the mode of the file."""
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = ""
    entry.mode = 0o644
    return entry


@contextmanager
def temporary(target: Path, what: str) -> Iterator[Path]:
    """Create a file in the folder of the target; finally delete it unless it was renamed to the target."""
    folder = target.absolute().parent
    descriptor, name = tempfile.mkstemp(dir=folder, prefix=f".{target.name}.", suffix=f".{what}")
    os.close(descriptor)
    try:
        yield Path(name)
    finally:
        for suffix in ("", "-wal", "-shm", "-journal"):
            Path(f"{name}{suffix}").unlink(missing_ok=True)


def publish(archive: Path, target: Path) -> None:
    """Rename a complete archive to its final name; raises CannotRun."""
    if target.exists():
        raise CannotRun(f"{target} was created in the meantime: a backup never replaces another.")
    os.rename(archive, target)
    descriptor = os.open(target.absolute().parent, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
