"""Files named by the SHA-256 of their bytes: written once, whole or not at all, never changed."""

import hashlib
import os
import re
import tempfile
import threading
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from app.storage.errors import ArtifactMissing

_SHA256 = re.compile(r"[0-9a-f]{64}")
_TEMPORARY = ".tmp-"


@dataclass(frozen=True)
class Stored:
    """A file in the store: its name, its size [bytes] and when it was last put [s since 1970]."""

    sha: str
    size: int
    modified: float


class ArtifactStore:
    """Artifacts in a local folder, spread over 256 folders by the first two digits of their names.

    One process writes at a time (see `DataFolder`), so temporary files found at the start are left-overs.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._changing = threading.Lock()  # nobody deletes a file that is being put
        folder.mkdir(parents=True, exist_ok=True)
        for stale in folder.glob(f"*/{_TEMPORARY}*"):
            stale.unlink()

    def put(self, data: bytes) -> str:
        """Store the bytes durably and return their SHA-256; the same bytes are stored once."""
        sha = hashlib.sha256(data).hexdigest()
        with self._changing:
            self._store(sha, data)
        return sha

    def list(self) -> Iterator[Stored]:
        """Every file in the store, in no order."""
        for path in self._folder.glob("??/*"):
            if _SHA256.fullmatch(path.name):
                with suppress(FileNotFoundError):  # deleted meanwhile
                    seen = path.stat()
                    yield Stored(path.name, seen.st_size, seen.st_mtime)

    def delete_unchanged(self, seen: Stored) -> bool:
        """Delete a file unless it was put again since it was listed; return whether it is deleted."""
        location = self._location(seen.sha)
        with self._changing, suppress(FileNotFoundError):
            if location.stat().st_mtime == seen.modified:
                location.unlink()
                return True
        return False

    def _store(self, sha: str, data: bytes) -> None:
        target = self._location(sha)
        # A file of another size was torn by a failing disk: the good bytes in hand replace it.
        if not target.is_file() or target.stat().st_size != len(data):
            target.parent.mkdir(exist_ok=True)
            _write_whole(target, data)
        else:
            os.utime(target)  # it is wanted again, see `delete_unchanged`
        # Even for a file found: the writer that renamed it may not have synced its folder yet.
        _sync_folder(target.parent)
        _sync_folder(self._folder)

    def path(self, sha: str) -> Path:
        """Where an artifact lies.

        Raises
        ------
        ArtifactMissing
            Nothing is stored under this name, or it is no SHA-256.
        """
        location = self._location(sha)
        if not location.is_file():
            raise ArtifactMissing(sha)
        return location

    def read(self, sha: str) -> bytes:
        """Return the bytes of an artifact; raises ArtifactMissing as `path` does."""
        return self.path(sha).read_bytes()

    def check(self, sha: str) -> bool:
        """Whether the artifact exists and its bytes still have this hash."""
        try:
            return hashlib.sha256(self.read(sha)).hexdigest() == sha
        except ArtifactMissing:
            return False

    def _location(self, sha: str) -> Path:
        # A name comes from a URL: anything but a hash could lead out of the folder.
        if not _SHA256.fullmatch(sha):
            raise ArtifactMissing(sha)
        return self._folder / sha[:2] / sha


def _write_whole(target: Path, data: bytes) -> None:
    """Write beside the target, sync, then rename, so that the target never shows half its bytes."""
    descriptor, temporary = tempfile.mkstemp(dir=target.parent, prefix=_TEMPORARY)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise


def _sync_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
