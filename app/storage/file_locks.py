"""Locks that keep removals of files apart from puts, in one process or among several."""

from __future__ import annotations

import fcntl
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class OwnLock:
    """For the threads of one process, which does everything in turn."""

    def __init__(self) -> None:
        self._lock = threading.Lock()

    @contextmanager
    def putting(self) -> Iterator[None]:
        """While a file is put or renewed."""
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
        """While a file is put or renewed."""
        with self._held(fcntl.LOCK_SH):
            yield

    @contextmanager
    def removing(self) -> Iterator[None]:
        """While a file is looked at and then deleted or set aside."""
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
