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

IN_USE = 60.0  # a copy that was used within this time stays, whatever the limit [s]
_KEPT = 0.9  # of the limit, after room was made: not every new copy needs room made for it
_SHARE = 0.125  # of the limit: after so many bytes of its own a process counts those of all again


class Copies:
    """Copies in a folder that several processes of a machine may use, of `limit` bytes in all.

    Each process counts what it adds, and all files from time to time. With n processes the folder may hold
    an eighth of the limit more for each, and what was used within the last minute.
    """

    def __init__(self, folder: Path, limit: int, in_use: float = IN_USE) -> None:
        self._files = ArtifactStore(folder, is_shared=True, is_durable=False)
        self._limit, self._in_use = limit, in_use
        self._used: dict[str, float] = {}  # sha -> when this process used it [s since 1970]
        self._size: int | None = None  # of all, when they were counted last [bytes]
        self._added = 0  # since then [bytes]
        self._lock = threading.Lock()
        self._making_room = threading.Lock()

    def open(self, sha: str) -> OpenFile | None:
        """Open a good copy; None if there is none."""
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
        """Return the path of a copy that was used just now; it stays there for a minute."""
        return self._files.fetch(sha)

    def put(self, *parts: bytes | memoryview) -> None:
        """Keep a copy, and make room for it.

        Raises
        ------
        OSError
            The disk does not take it.
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
        """Remove a copy, if there is one."""
        self._files.delete(sha)
        with self._lock:
            self._used.pop(sha, None)

    def _use(self, sha: str) -> None:
        with self._lock:
            self._used[sha] = time.time()

    def _make_room(self) -> None:
        """Count all copies; if they are too many, delete those that no process has used for longest."""
        with self._lock:
            self._added = 0
        files = {file.sha: (self._last_use(file), file) for file in self._files.list()}
        size = sum(file.size for _, file in files.values())
        shutil.rmtree(self._files.folder / QUARANTINE, ignore_errors=True)  # the bucket has better ones
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
        """Return when this process, or another as far as the file system records it, last used a copy."""
        with suppress(OSError):
            location = self._files.folder / file.sha[:2] / file.sha
            return max(location.stat().st_atime, file.modified, self._used.get(file.sha, 0.0))
        return 0.0
