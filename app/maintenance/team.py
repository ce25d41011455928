"""Back up and restore a team's PostgreSQL database and files, wherever the settings place them.

As with SQLite, the backup first reads the rows and then the files that they name; each file was stored before
its row. A bucket with versioning needs no copy of its files, so the backup may hold only the database.
"""

from __future__ import annotations

import hashlib
import tarfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from app.maintenance import postgres
from app.maintenance.archive import DUMP, FORMAT_OF_DUMP, artifact_entry, is_compressed
from app.maintenance.backup import (
    Contents,
    add_file,
    manifest,
    publish,
    refuse_target,
    temporary,
    write_archive,
)
from app.maintenance.check import Say
from app.maintenance.errors import CannotRun
from app.maintenance.restore import BROKEN, RestoreResult, require_whole, unpacked
from app.maintenance.rows import NamedFile, named_files
from app.settings import Settings
from app.storage.artifacts import Artifacts
from app.storage.errors import ArtifactDamaged, ArtifactMissing, ArtifactsUnreachable, StoreRefused
from app.storage.folder import DataFolder
from app.storage.migrations import known_schemas
from app.storage.stores import opened_store

NO_STORE = (
    "CRANKWRIGHT_ARTIFACTS_URL is not set: servers on PostgreSQL keep files in a bucket, or in a folder that "
    "they share"
)


def back_up(settings: Settings, url: str, target: Path, say: Say, *, with_files: bool) -> Contents:
    """Write a backup; the archive receives its final name once it is complete and synced.

    Meanwhile no server deletes files that no row names.

    Raises
    ------
    CannotRun
        If the database or the store does not answer, `pg_dump` is missing, or the target exists.
    """
    refuse_target(target)
    with (
        _store(settings) as store,
        postgres.snapshot(url) as rows,
        temporary(target, "database") as dump,
        temporary(target, "archive") as archive,
    ):
        postgres.dump(url, rows, dump)
        say(f"database: {dump.stat().st_size / 2**20:.1f} MiB")
        named = {row.sha: row for row in named_files(rows)} if with_files else {}
        about = manifest(FORMAT_OF_DUMP, dump, known_schemas()[0], len(named))
        about["files"] = with_files

        def add(tar: tarfile.TarFile, row: NamedFile, contents: Contents) -> None:
            data, fault = _read(store, row)
            if data is None:
                contents.damaged[row.sha] = fault
            else:
                add_file(tar, row.sha, data, contents)

        contents = write_archive(archive, is_compressed(target), about, dump, named, add, say)
        publish(archive, target)
    return contents


def restore(settings: Settings, url: str, archive: Path, say: Say) -> RestoreResult:
    """Restore a backup into an empty database and the file store: first the files, then all rows or none.

    Raises
    ------
    CannotRun
        If the database is not empty, or the archive is damaged, incomplete, or not a backup of Crankwright.
    """
    if not archive.is_file():
        raise CannotRun(f"There is no backup {archive}.")
    if postgres.schema_of(url):
        raise CannotRun("The database is not empty, and a restore never overwrites: create a new one.")
    with TemporaryDirectory(prefix="crankwright-restore-") as name, _store(settings) as store:
        folder = Path(name)
        try:
            restored = unpacked(archive, folder, FORMAT_OF_DUMP)
        except BROKEN as error:
            raise CannotRun(f"{archive} is damaged or is not a backup of Crankwright: {error}.") from error
        require_whole(restored)
        say(f"verified: the database and {len(restored.artifacts)} artifacts")
        for sha in restored.artifacts:
            store.put((folder / artifact_entry(sha)).read_bytes())
        postgres.load(url, folder / DUMP)
    return restored


def _read(store: Artifacts, row: NamedFile) -> tuple[bytes | None, str]:
    """Return the bytes of a file, or None with its fault."""
    try:
        data = store.read(row.sha)
    except ArtifactMissing:
        return None, "the file is missing"
    except ArtifactDamaged:
        return None, "the bytes do not match the hash"
    except ArtifactsUnreachable as error:
        raise CannotRun(f"The file store does not answer: {error}.") from None
    if hashlib.sha256(data).hexdigest() != row.sha or (row.size is not None and len(data) != row.size):
        return None, "the bytes do not match the hash or the size"
    return data, ""


@contextmanager
def _store(settings: Settings) -> Iterator[Artifacts]:
    """Yield the store of the settings; its local copies go into a temporary folder instead of a server's."""
    if settings.artifacts_url is None:
        raise CannotRun(f"{NO_STORE}.")
    with TemporaryDirectory(prefix="crankwright-copies-") as name:
        folder = DataFolder(Path(name))
        try:
            yield opened_store(settings, folder)
        except StoreRefused as error:
            raise CannotRun(str(error)) from None
        finally:
            folder.release()
