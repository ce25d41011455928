"""Read the files of a service for `check`; nothing is changed, not even a damaged file."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from app.maintenance.errors import CannotRun
from app.maintenance.rows import NamedFile
from app.settings import Settings
from app.storage.artifacts import QUARANTINE, SHA256
from app.storage.errors import ArtifactsUnreachable, StoreRefused
from app.storage.stores import is_bucket, opened_bucket, shared_folder

if TYPE_CHECKING:
    from app.storage.s3 import Bucket

_DATABASE_FIRST = (
    "Back up the database before the files, by `pg_dump -Fc`, or for SQLite by "
    "`sqlite3 crankwright.sqlite '.backup FILE'`. `crankwright check` verifies every file that a row names."
)
IN_BUCKET = (
    "The files are in {url}, so the bucket has to be backed up: switch its versioning on, or copy it. "
    + _DATABASE_FIRST
)
IN_SHARED_FOLDER = "The files are in {url}, which the servers share: copy that folder. " + _DATABASE_FIRST


class Files(Protocol):
    """The interface to the files of a service."""

    def ages(self) -> dict[str, float]:
        """Return when each file was stored [s since 1970], by hash."""
        ...

    def fault(self, row: NamedFile) -> str | None:
        """Return the fault of a row's file, or None."""
        ...

    def size(self, sha: str) -> int:
        """Return the size of a good file [bytes]."""
        ...

    def place(self, sha: str) -> str:
        """Return the place of a file."""
        ...

    def quarantined(self) -> int:
        """Return the number of files that were set aside."""
        ...


def files_of(settings: Settings) -> Files:
    """Return access to the files that the settings name.

    Raises
    ------
    CannotRun
        If they name an unusable store.
    """
    try:
        if is_bucket(settings):
            return BucketFiles(opened_bucket(settings), settings.artifacts_url or "")
        return FolderFiles(shared_folder(settings) or settings.data / "artifacts")
    except StoreRefused as error:
        raise CannotRun(str(error)) from None


@dataclass(frozen=True)
class FolderFiles:
    """Files in a folder, used by one server or several."""

    folder: Path

    def path(self, sha: str) -> Path:
        """Return the path of a file, whether or not it exists."""
        return self.folder / sha[:2] / sha

    def ages(self) -> dict[str, float]:
        """Return when each file was stored [s since 1970], by hash."""
        seconds = {}
        for path in self.folder.glob("[0-9a-f][0-9a-f]/*"):
            if SHA256.fullmatch(path.name):
                try:
                    seconds[path.name] = path.stat().st_mtime
                except FileNotFoundError:  # deleted in the meantime
                    continue
        return seconds

    def fault(self, row: NamedFile) -> str | None:
        """Return the fault of a row's file, or None."""
        return fault_of(self.path(row.sha), row)

    def size(self, sha: str) -> int:
        """Return the size of a good file [bytes]."""
        return self.path(sha).stat().st_size

    def place(self, sha: str) -> str:
        """Return the place of a file."""
        return str(self.path(sha))

    def quarantined(self) -> int:
        """Return the number of files that were set aside."""
        return sum(1 for _ in self.folder.glob(f"{QUARANTINE}/*"))


class BucketFiles:
    """Files in a bucket; each is read completely to verify it."""

    def __init__(self, bucket: Bucket, url: str) -> None:
        self._bucket, self._url = bucket, url.rstrip("/")
        self._sizes: dict[str, int] = {}

    def ages(self) -> dict[str, float]:
        """Return when each file was stored [s since 1970], by hash."""
        return {key: modified for key, modified in self._listed.items() if SHA256.fullmatch(key)}

    def fault(self, row: NamedFile) -> str | None:
        """Return the fault of a row's object, or None."""
        try:
            answer = self._bucket.get(row.sha)
        except ArtifactsUnreachable as error:
            raise CannotRun(f"{self._url}: {error}") from None
        if answer is None:
            return "the object is missing"
        self._sizes[row.sha] = size = len(answer[0])
        if row.size is not None and size != row.size:
            return f"the object has {size} bytes instead of {row.size}"
        if hashlib.sha256(answer[0]).hexdigest() != row.sha:
            return "the bytes do not match the hash"
        return None

    def size(self, sha: str) -> int:
        """Return the size of a good object [bytes]."""
        return self._sizes[sha]

    def place(self, sha: str) -> str:
        """Return the place of an object."""
        return f"{self._url}/{sha}"

    def quarantined(self) -> int:
        """Return the number of objects that were set aside."""
        return sum(key.startswith(f"{QUARANTINE}/") for key in self._listed)

    @cached_property
    def _listed(self) -> dict[str, float]:
        try:
            return {key: stored.modified for key, stored in self._bucket.list()}
        except ArtifactsUnreachable as error:
            raise CannotRun(f"{self._url}: {error}") from None


def fault_of(path: Path, row: NamedFile) -> str | None:
    """Return the fault of the file that a row names, or None; `size` is in bytes."""
    try:
        size = path.stat().st_size
        if row.size is not None and size != row.size:
            return f"the file has {size} bytes instead of {row.size}"
        with path.open("rb") as file:
            if hashlib.file_digest(file, "sha256").hexdigest() != row.sha:
                return "the bytes do not match the hash"
    except FileNotFoundError:
        return "the file is missing"
    except OSError as error:
        return f"the file cannot be read: {error.strerror}"
    return None
