"""Restore a backup into a new data folder, which appears only after everything in it is verified.

The archive cannot decide where its bytes are written: only plain files with known names are accepted.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import os
import shutil
import sqlite3
import tarfile
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from app.maintenance.archive import ARTIFACT, DATABASE, DATABASES, END, FORMAT, FORMAT_OF_DUMP, MANIFEST
from app.maintenance.check import Say
from app.maintenance.errors import CannotRun
from app.maintenance.folder import reading, refuse_other_schema
from app.maintenance.rows import broken_references, named_files
from app.plain import JsonObject
from app.storage.integrity import faults
from app.storage.record import write_first

LARGEST_NOTE = 64 * 2**20  # limit for the manifest and the end entry, which names every missing file [bytes]
_CHUNK = 2**20
BROKEN = (tarfile.TarError, gzip.BadGzipFile, EOFError, zlib.error, ValueError, KeyError, TypeError)


OTHER_DATABASE = {
    FORMAT: "The backup is of SQLite: restore it with CRANKWRIGHT_DATABASE_URL unset.",
    FORMAT_OF_DUMP: "The backup is of PostgreSQL: name an empty database by CRANKWRIGHT_DATABASE_URL.",
}


@dataclass
class RestoreResult:
    """The result of restoring a backup."""

    form: int = FORMAT
    manifest: JsonObject = field(default_factory=dict)
    end: JsonObject | None = None
    database: str = ""  # SHA-256
    artifacts: set[str] = field(default_factory=set)


def restore(archive: Path, data: Path, say: Say) -> RestoreResult:
    """Restore a backup into an empty or missing folder.

    Raises
    ------
    CannotRun
        If the folder is in use, or the archive is damaged, incomplete, newer than this program, or not a
        backup of it.
    """
    if not archive.is_file():
        raise CannotRun(f"There is no backup {archive}.")
    _refuse_content(data)
    with _sibling(data) as folder:
        try:
            restored = unpacked(archive, folder, FORMAT)
            _verify(folder, restored)
        except BROKEN as error:
            raise CannotRun(f"{archive} is damaged or is not a backup of Crankwright: {error}.") from error
        say(f"verified: the database and {len(restored.artifacts)} artifacts")
        write_first(folder / DATABASE)
        _sync_all(folder)
        os.rename(folder, data)
        _sync(data.absolute().parent)
    return restored


def _refuse_content(data: Path) -> None:
    if data.exists() and (not data.is_dir() or any(data.iterdir())):
        raise CannotRun(
            f"{data.absolute()} is not empty, and a restore never overwrites. Name a new folder with --data, "
            f"or stop the service and move the old one aside: mv {data.absolute()} {data.absolute()}.old"
        )


@contextmanager
def _sibling(data: Path) -> Iterator[Path]:
    """Create a folder next to the target; delete it at the end, unless it was renamed to the target."""
    parent = data.absolute().parent
    parent.mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(dir=parent, prefix=f".{data.name}.restoring-"))
    folder.chmod(0o755)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def unpacked(archive: Path, folder: Path, form: int) -> RestoreResult:
    """Unpack an archive into a folder, and return its contents; raises CannotRun, or one of `BROKEN`."""
    restored = RestoreResult(form)
    with tarfile.open(archive, "r|*") as tar:
        for entry in tar:
            if restored.end is not None:
                raise CannotRun(f"The archive has extra data after its end: {entry.name[:100]!r}.")
            file = tar.extractfile(entry) if entry.isreg() else None
            if file is None:
                raise CannotRun(f"The archive holds {entry.name[:100]!r}, which is not a plain file.")
            _take(entry, file, folder, restored)
    if restored.end is None:
        raise CannotRun("The archive is not complete: its end is missing.")
    return restored


def _take(entry: tarfile.TarInfo, file: IO[bytes], folder: Path, restored: RestoreResult) -> None:
    """Unpack one entry to its place; the order of entries is part of the archive's format."""
    if not restored.manifest:
        restored.manifest = _manifest(entry, file, restored.form)
    elif entry.name == DATABASES[restored.form] and not restored.database:
        restored.database = _written(file, folder / entry.name)
    elif entry.name == END and restored.database:
        restored.end = _note(entry, file)
    elif (artifact := ARTIFACT.fullmatch(entry.name)) and restored.database:
        _take_artifact(artifact[2], file, folder / entry.name, restored)
    else:
        raise CannotRun(f"The archive holds {entry.name[:100]!r}, which a Crankwright backup never contains.")


def _take_artifact(sha: str, file: IO[bytes], place: Path, restored: RestoreResult) -> None:
    if sha in restored.artifacts:
        raise CannotRun(f"The archive contains artifact {sha} twice.")
    place.parent.mkdir(parents=True, exist_ok=True)
    if _written(file, place) != sha:
        raise CannotRun(f"Artifact {sha} in the archive is damaged: its bytes do not match the hash.")
    restored.artifacts.add(sha)


def _manifest(entry: tarfile.TarInfo, file: IO[bytes], form: int) -> JsonObject:
    if entry.name != MANIFEST:
        raise CannotRun(f"This is not a backup of Crankwright: it begins with {entry.name[:100]!r}.")
    manifest = _note(entry, file)
    if manifest["format"] != form and manifest["format"] in DATABASES:
        raise CannotRun(OTHER_DATABASE[manifest["format"]])
    if manifest["format"] != form:
        raise CannotRun(f"The backup has format {manifest['format']}; this program reads {form}: upgrade.")
    return manifest


def _note(entry: tarfile.TarInfo, file: IO[bytes]) -> JsonObject:
    if entry.size > LARGEST_NOTE:
        raise CannotRun(f"{entry.name} in the archive has {entry.size} bytes, more than any backup contains.")
    note = json.loads(file.read())
    if not isinstance(note, dict):
        raise CannotRun(f"{entry.name} in the archive was not written by this program.")
    return note


def _written(file: IO[bytes], place: Path) -> str:
    """Write and sync an entry, and return the hash of its bytes."""
    digest = hashlib.sha256()
    with place.open("xb") as out:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
            out.write(chunk)
        out.flush()
        os.fsync(out.fileno())
    return digest.hexdigest()


def require_whole(restored: RestoreResult) -> None:
    """Check the hash of the database and the number of artifacts; raises CannotRun."""
    assert restored.end is not None
    if restored.database != restored.manifest["database"]["sha256"]:
        raise CannotRun("The database in the archive is damaged: its bytes do not match the hash.")
    if restored.end["artifacts"] != len(restored.artifacts):
        raise CannotRun("The archive is not complete: artifacts are missing.")


def _verify(folder: Path, restored: RestoreResult) -> None:
    """Check the database with its hash and this program, and the artifacts with the rows."""
    require_whole(restored)
    path = folder / DATABASE
    if damage := faults(path):
        raise CannotRun(f"The database in the archive is damaged: {'; '.join(damage)}.")
    try:
        with reading(path) as connection:
            refuse_other_schema(connection, older_too=False)
            wrong = list(broken_references(connection))
            named = {row.sha for row in named_files(connection)}
    except sqlite3.DatabaseError as error:
        raise CannotRun(f"The database in the archive cannot be read: {error}.") from error
    if wrong:
        raise CannotRun(f"The database in the archive is inconsistent: {'; '.join(wrong[:5])}.")
    assert restored.end is not None
    if lacking := named - restored.artifacts - set(restored.end["missing"]):
        raise CannotRun(f"The archive lacks {len(lacking)} artifacts, such as {min(lacking)}.")


def _sync_all(folder: Path) -> None:
    for place in (folder, *(path for path in folder.rglob("*") if path.is_dir())):
        _sync(place)


def _sync(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
