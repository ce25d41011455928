"""Local copies of a bucket's files, verified at every read; the least recently used are removed first."""

from __future__ import annotations

import shutil
import threading
import time
from contextlib import suppress
from pathlib import Path

from app.storage.artifacts import QUARANTINE, ArtifactStore, StoredFile
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.storage.verification import OpenFile

IN_USE = 60.0  # a copy that was used within this time is kept regardless of the limit [s]
_KEPT = 0.9  # share of the limit to which the size is reduced, so that this happens rarely
_SHARE = 0.125  # share of the limit that a process adds before it counts all files again


class Copies:
    """Copies in a folder that several processes of a machine may use, of `limit` bytes in total.

    Each process counts what it adds, and from time to time all files. With n processes the folder may exceed
    the limit by n/8 of it, and by the copies that were used within the last minute.
    """

    def __init__(self, folder: Path, limit: int, in_use: float = IN_USE) -> None:
        self._files = ArtifactStore(folder, is_shared=True, is_durable=False)
        self._limit, self._in_use = limit, in_use
        self._used: dict[str, float] = {}  # time of this process's last use, by name [s since 1970]
        self._size: int | None = None  # total size at the last count [bytes]
        self._added = 0  # size added since then [bytes]
        self._lock = threading.Lock()
        self._making_room = threading.Lock()

    def open(self, sha: str) -> OpenFile | None:
        """Open a good copy; return None if there is none."""
        try:
            opened = self._files.open(sha)
        except (ArtifactMissing, ArtifactDamaged):
            return None
        self._use(sha)
        return opened

    def read(self, sha: str) -> bytes | None:
        """Return the bytes of a good copy; None if there is none."""
        try:
            data = self._files.read(sha)
        except (ArtifactMissing, ArtifactDamaged):
            return None
        self._use(sha)
        return data

    def path(self, sha: str) -> Path:
        """Return the path of a good copy, which then exists for at least a minute."""
        return self._files.fetch(sha)

    def put(self, *parts: bytes | memoryview) -> None:
        """Store a copy, and make room for it.

        Raises
        ------
        OSError
            If the disk refuses it.
        """
        sha = self._files.put(*parts)
        self._use(sha)
        with self._lock:
            self._added += sum(memoryview(part).nbytes for part in parts)
            is_enough = self._size is None or self._size + self._added > self._limit
            is_due = is_enough or self._added > self._limit * _SHARE
        if is_due and self._making_room.acquire(blocking=False):
            try:
                self._make_room()
            finally:
                self._making_room.release()

    def delete(self, sha: str) -> None:
        """Delete a copy if it exists."""
        self._files.delete(sha)
        with self._lock:
            self._used.pop(sha, None)

    def _use(self, sha: str) -> None:
        with self._lock:
            self._used[sha] = time.time()

    def _make_room(self) -> None:
        """Count all copies; if they exceed the limit, delete the least recently used ones."""
        with self._lock:
            self._added = 0
        files = {file.sha: (self._last_use(file), file) for file in self._files.list()}
        size = sum(file.size for _, file in files.values())
        shutil.rmtree(self._files.folder / QUARANTINE, ignore_errors=True)  # the bucket has intact ones
        if size > self._limit:
            for used, file in sorted(files.values(), key=lambda each: each[0])[:-1]:
                if size <= self._limit * _KEPT or time.time() - used < self._in_use:
                    break
                self.delete(file.sha)
                size -= file.size
        with self._lock:
            self._size = size
            self._used = {sha: used for sha, used in self._used.items() if sha in files}

    def _last_use(self, file: StoredFile) -> float:
        """Return when this process, or another one as far as file times show, last used a copy."""
        with suppress(OSError):
            location = self._files.folder / file.sha[:2] / file.sha
            return max(location.stat().st_atime, file.modified, self._used.get(file.sha, 0.0))
        return 0.0
