"""Write files whole and durably: no reader sees half of one, and a crash of the machine loses none.

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
    """For the threads of one process, which does everything in turn."""

    def __init__(self) -> None:
        self._lock = threading.Lock()

    @contextmanager
    def putting(self) -> Iterator[None]:
        """Hold the lock while a file is put or renewed."""
        with self._lock:
            yield

    removing = putting


class SharedLock:
    """For the processes of several servers: many may put at the same time, or one removes.

    The file lies in the folder that they share. A lock belongs to an open file, so it also keeps threads
    apart, and a process that is killed leaves none.
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
"""Beginning of the name of a file that is still being written."""


def write_whole(
    target: Path, parts: Iterable[bytes | memoryview], clear: Callable[[Path], None], *, is_durable: bool
) -> None:
    """Write beside the target, sync, then rename, so that the target never shows half its bytes.

    To sync takes long: `clear` removes what cannot be replaced from the target's place only after that.
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
    """Make the names in a folder durable."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
