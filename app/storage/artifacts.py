"""Store files under the SHA-256 of their bytes: written whole or not at all, verified when read."""

from __future__ import annotations

import errno
import hashlib
import math
import os
import re
import stat
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from io import BufferedReader
from pathlib import Path
from typing import Protocol

from app.storage.errors import ArtifactDamaged, ArtifactMissing, ArtifactsUnreachable
from app.storage.files import TEMPORARY, OwnLock, SharedLock, sync_folder, write_whole
from app.storage.verification import OpenFile, Stamp, VerifiedStamps, stamp_of

QUARANTINE = "quarantine"
SHA256 = re.compile(r"[0-9a-f]{64}")
OWNER = "database"  # name under which a shared store has the identity of its database
LOCK = "crankwright.lock"  # name of the lock file in a folder that several servers share
ABANDONED = 3600.0  # age from which a temporary file counts as abandoned [s]
_FAILING_DISK = {errno.EIO, errno.EBADMSG, getattr(errno, "EUCLEAN", errno.EIO)}


@dataclass(frozen=True)
class StoredFile:
    """A file in the store: its name, its size [bytes] and when it was last put [s since 1970].

    A discarded file is in a bucket's `discarded/` and is restored if it is requested.
    """

    sha: str
    size: int
    modified: float
    is_discarded: bool = False


class Artifacts(Protocol):
    """The interface of an artifact store.

    A store that cannot be reached raises ArtifactsUnreachable; it never reports a missing file instead.
    """

    @property
    def is_shared(self) -> bool:
        """Return whether several servers may share the store."""
        ...

    def put(self, *parts: bytes | memoryview) -> str:
        """Store bytes, whole or in parts, and return their SHA-256; they are durable when it returns.

        If the bytes are stored already, their age is renewed, so that no sweep deletes them before their row
        is written.
        """
        ...

    def fetch(self, sha: str) -> Path:
        """Return the path of the verified bytes; raise ArtifactMissing or ArtifactDamaged otherwise."""
        ...

    def read(self, sha: str) -> bytes:
        """Return the verified bytes; raise the same errors as `fetch`."""
        ...

    def open(self, sha: str) -> OpenFile:
        """Open the verified bytes for reading, even if the file is deleted later; raise as `fetch` does."""
        ...

    def exists(self, sha: str) -> bool:
        """Return whether the bytes exist and are good."""
        ...

    def delete(self, sha: str) -> None:
        """Delete the bytes if they exist."""
        ...

    def delete_unchanged(self, seen: StoredFile) -> bool:
        """Delete a file unless it was put again since it was listed; return whether it was deleted."""
        ...

    def list(self) -> Iterator[StoredFile]:
        """Return every file in the store, verified or not."""
        ...

    def claim(self, owner: str) -> str:
        """Claim the store for an owner if it has none; return its owner."""
        ...

    def read_note(self, name: str) -> str | None:
        """Return the note with this name, which is not a hash; None if there is none."""
        ...

    def write_note(self, name: str, text: str) -> None:
        """Write a note under a name, and replace any earlier one."""
        ...

    def probe(self) -> None:
        """Check that the store answers; raise ArtifactsUnreachable if not."""
        ...


class ArtifactStore:
    """Artifacts in a folder, spread over 256 folders by the first two digits of their names.

    Unless `is_shared`, only one process writes at a time (see `DataFolder`), so temporary files present at
    the start are left-overs. In a folder that several servers share, only old temporary files are. A file
    whose bytes no longer match its hash is moved to the folder `quarantine` and never served. Files that need
    not be durable, because they are copies, are not synced.
    """

    def __init__(self, folder: Path, *, is_shared: bool = False, is_durable: bool = True) -> None:
        self.folder, self.is_shared = folder, is_shared
        self._is_durable = is_durable
        self._verified = VerifiedStamps()
        folder.mkdir(parents=True, exist_ok=True)
        # The lock prevents that a file is deleted or set aside while it is put.
        self._changing = SharedLock(folder / LOCK) if is_shared else OwnLock()
        oldest = time.time() - ABANDONED if is_shared else math.inf
        with self._changing.putting():  # also verifies that the folder can be written
            for stale in folder.glob(f"*/{TEMPORARY}*"):
                with suppress(FileNotFoundError):  # another server has just renamed or deleted it
                    if stale.stat().st_mtime < oldest:
                        stale.unlink()

    def put(self, *parts: bytes | memoryview) -> str:
        """Store bytes durably, whole or in parts, and return their SHA-256; equal bytes are stored once.

        An existing file is kept if its bytes are good, and its age is renewed.
        """
        sha = hashed(parts)
        target = self._location(sha)
        if not (self.exists(sha) and self._renewed(target)):
            with self._changing.putting():
                target.parent.mkdir(exist_ok=True)
                write_whole(target, parts, self._clear, is_durable=self._is_durable)
        # Even for a file that exists: the writer that renamed it may not have synced its folder yet.
        if self._is_durable:
            sync_folder(target.parent)
            sync_folder(self.folder)
        return sha

    def fetch(self, sha: str) -> Path:
        """Return the path of a verified artifact.

        Raises
        ------
        ArtifactMissing
            If nothing is stored under this name, or the name is not a SHA-256.
        ArtifactDamaged
            If the bytes had another hash; the file has been set aside.
        """
        with self.open(sha):
            return self._location(sha)

    def read(self, sha: str) -> bytes:
        """Return the verified bytes of an artifact; raise the same errors as `fetch`."""
        with self._opened(sha) as file:
            try:
                data = file.read()
            except OSError as error:
                raise self._unreadable(sha, file, error) from error
            if hashlib.sha256(data).hexdigest() != sha:
                raise self._set_aside(sha, stamp_of(file), f"its {len(data)} bytes do not match the hash")
        return data

    def open(self, sha: str) -> OpenFile:
        """Open a verified artifact for reading; raise the same errors as `fetch`.

        The open file stays the verified one even if another file replaces it. Its bytes are hashed once for
        every combination of inode, size and times.
        """
        file = self._opened(sha)
        try:
            return OpenFile(file, self._verify(sha, file))
        except BaseException:
            file.close()
            raise

    def exists(self, sha: str) -> bool:
        """Return whether the artifact exists and its bytes still match its hash.

        A damaged artifact is set aside.
        """
        try:
            self.open(sha).file.close()
        except (ArtifactMissing, ArtifactDamaged):
            return False
        return True

    def delete(self, sha: str) -> None:
        """Delete an artifact if it exists."""
        with self._changing.removing():
            self._location(sha).unlink(missing_ok=True)
        self._verified.forget(sha)

    def delete_unchanged(self, seen: StoredFile) -> bool:
        """Delete a file unless it was put again since it was listed; return whether it was deleted."""
        location = self._location(seen.sha)
        with self._changing.removing(), suppress(FileNotFoundError):
            if location.stat().st_mtime == seen.modified:
                location.unlink()
                self._verified.forget(seen.sha)
                return True
        return False

    def list(self) -> Iterator[StoredFile]:
        """Yield every artifact in the folder, verified or not, except those that were set aside."""
        for path in self.folder.glob("[0-9a-f][0-9a-f]/*"):
            if SHA256.fullmatch(path.name):
                with suppress(FileNotFoundError):  # deleted in the meantime
                    seen = path.lstat()
                    yield StoredFile(path.name, seen.st_size, seen.st_mtime)

    def claim(self, owner: str) -> str:
        """Claim the folder for an owner if it has none; return its owner."""
        descriptor, temporary = tempfile.mkstemp(dir=self.folder, prefix=TEMPORARY)
        try:
            with os.fdopen(descriptor, "w") as file:
                file.write(owner)
                file.flush()
                os.fsync(descriptor)
            with suppress(FileExistsError):  # another server may have claimed it at the same time
                os.link(temporary, self.folder / OWNER)
        finally:
            os.unlink(temporary)
        return (self.read_note(OWNER) or "").strip()

    def read_note(self, name: str) -> str | None:
        """Return the note with this name; None if there is none."""
        try:
            return (self.folder / name).read_text(errors="replace")
        except FileNotFoundError:
            return None

    def write_note(self, name: str, text: str) -> None:
        """Write a note under a name in the folder, durably."""
        with self._changing.putting():
            write_whole(self.folder / name, [text.encode()], self._clear, is_durable=self._is_durable)
        sync_folder(self.folder)

    def probe(self) -> None:
        """Check that the folder can be read; raise ArtifactsUnreachable if not."""
        try:
            self.folder.stat()
        except OSError as error:
            raise ArtifactsUnreachable(f"its folder cannot be read ({error.strerror})") from error

    def _verify(self, sha: str, file: BufferedReader) -> Stamp:
        stamp = stamp_of(file)
        if self._verified.has(sha, stamp):
            return stamp
        try:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        except OSError as error:
            raise self._unreadable(sha, file, error) from error
        if digest != sha:
            raise self._set_aside(sha, stamp, f"its {stamp.size} bytes do not match the hash")
        file.seek(0)
        self._verified.add(sha, stamp)
        return stamp

    def _opened(self, sha: str) -> BufferedReader:
        location = self._location(sha)
        try:
            if not stat.S_ISREG(location.lstat().st_mode):  # a pipe, a link, a folder
                raise ArtifactMissing(sha)
            return location.open("rb")
        except (FileNotFoundError, IsADirectoryError):  # removed or replaced in the meantime
            raise ArtifactMissing(sha) from None

    def _clear(self, target: Path) -> None:
        """Set aside an object that has the name of a file but is not a file, such as a folder."""
        if target.is_dir() and not target.is_symlink():
            aside = self.folder / QUARANTINE / f"{target.name}.folder-{_moment()}"
            aside.parent.mkdir(exist_ok=True)
            os.replace(target, aside)

    def _unreadable(self, sha: str, file: BufferedReader, error: OSError) -> Exception:
        """Return ArtifactDamaged if the disk cannot read the bytes; return any other error unchanged."""
        if error.errno not in _FAILING_DISK:
            return error
        return self._set_aside(sha, stamp_of(file), f"the disk cannot read it ({error.strerror})")

    def _set_aside(self, sha: str, stamp: Stamp, reason: str) -> ArtifactDamaged:
        """Move the damaged file away, unless good bytes have replaced it in the meantime."""
        self._verified.forget(sha)
        location, aside = self._location(sha), self.folder / QUARANTINE / f"{sha}.damaged-{_moment()}"
        with self._changing.removing(), suppress(FileNotFoundError):
            seen = location.stat()
            if seen.st_ino == stamp.inode:
                aside.parent.mkdir(exist_ok=True)
                os.replace(location, aside)
        return ArtifactDamaged(sha, reason)

    def _renewed(self, path: Path) -> bool:
        """Renew the age of a file, for `delete_unchanged`; return whether the file still exists."""
        with self._changing.putting(), suppress(FileNotFoundError):
            os.utime(path)
            return True
        return False

    def _location(self, sha: str) -> Path:
        require_name(sha)
        return self.folder / sha[:2] / sha


def require_name(sha: str) -> None:
    """Check that a name is a hash: names come from URLs, and any other name could lead out of the store.

    Raises
    ------
    ArtifactMissing
        If it is not a hash.
    """
    if not SHA256.fullmatch(sha):
        raise ArtifactMissing(sha)


def hashed(parts: Iterable[bytes | memoryview]) -> str:
    """Return the SHA-256 of bytes that are given in parts."""
    total = hashlib.sha256()
    for part in parts:
        total.update(part)
    return total.hexdigest()


def _moment() -> str:
    return datetime.now(UTC).strftime("%Y%m%dT%H%M%S.%f")
