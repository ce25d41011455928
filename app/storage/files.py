"""Write files whole and durably: no reader sees a partial file, and no file is lost if the machine crashes.

Two locks separate the removal of a file from its creation, within one process and among several.
"""

from __future__ import annotations

import fcntl
import os
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


class OwnLock:
    """A lock for the threads of one process; only one thread holds it at a time."""

    def __init__(self) -> None:
        self._lock = threading.Lock()

    @contextmanager
    def putting(self) -> Iterator[None]:
        """Hold the lock while a file is put or renewed."""
        with self._lock:
            yield

    removing = putting


class SharedLock:
    """A lock for the processes of several servers: many may put files at the same time, or one removes files.

    The lock file is in the shared folder. A lock belongs to an open file, so it also separates threads, and
    it ends when its process is killed.
    """

    def __init__(self, path: Path) -> None:
        self._path = path

    @contextmanager
    def putting(self) -> Iterator[None]:
        """Hold the lock while a file is put or renewed."""
        with self._held(fcntl.LOCK_SH):
            yield

    @contextmanager
    def removing(self) -> Iterator[None]:
        """Hold the lock while a file is examined and then deleted or set aside."""
        with self._held(fcntl.LOCK_EX):
            yield

    @contextmanager
    def _held(self, how: int) -> Iterator[None]:
        descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(descriptor, how)
            yield
        finally:
            os.close(descriptor)


TEMPORARY = ".tmp-"
"""Prefix of the name of a file that is still being written."""


def write_whole(
    target: Path, parts: Iterable[bytes | memoryview], clear: Callable[[Path], None], *, is_durable: bool
) -> None:
    """Write a temporary file, sync it, then rename it, so that the target is never partial.

    Syncing takes long. So `clear` removes an object that a rename cannot replace only after that.
    """
    descriptor, temporary = tempfile.mkstemp(dir=target.parent, prefix=TEMPORARY)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.writelines(parts)
            file.flush()
            if is_durable:
                os.fsync(file.fileno())
        clear(target)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise


def sync_folder(folder: Path) -> None:
    """Sync a folder, so that the names in it are durable."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
