"""Which files have been hashed already, by what the file system says of them."""

from __future__ import annotations

import os
import threading
import time
from collections import OrderedDict
from dataclasses import dataclass
from io import BufferedReader

REMEMBERED = 20_000  # files; some 200 bytes each
_RACY = 1_000_000_000  # a change within this time of the last one may show the same times [ns]


@dataclass(frozen=True)
class Stamp:
    """What changes when a file is changed: inode, size [bytes], times of contents and of inode [ns]."""

    inode: int
    size: int
    modified: int
    changed: int


@dataclass(frozen=True)
class Opened:
    """An open file, and the stamp that it had when its bytes were verified."""

    file: BufferedReader
    stamp: Stamp

    def is_unchanged(self) -> bool:
        """Whether the file still has that stamp."""
        return stamp_of(self.file) == self.stamp

    def __enter__(self) -> Opened:
        """Keep it open."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Close it."""
        self.file.close()


def stamp_of(file: BufferedReader) -> Stamp:
    """The stamp of an open file."""
    seen = os.fstat(file.fileno())
    return Stamp(seen.st_ino, seen.st_size, seen.st_mtime_ns, seen.st_ctime_ns)


class Verified:
    """The newest verified stamps by name, of a bounded number of files."""

    def __init__(self, most: int = REMEMBERED) -> None:
        self._most = most
        self._stamps: OrderedDict[str, Stamp] = OrderedDict()
        self._lock = threading.Lock()

    def has(self, sha: str, stamp: Stamp) -> bool:
        """Whether the file has been hashed while it had this stamp."""
        with self._lock:
            if self._stamps.get(sha) != stamp:
                return False
            self._stamps.move_to_end(sha)
            return True

    def add(self, sha: str, stamp: Stamp) -> None:
        """Remember a verified file, unless it is so young that a further change could keep its times."""
        if abs(time.time_ns() - stamp.changed) < _RACY:
            return
        with self._lock:
            self._stamps[sha] = stamp
            while len(self._stamps) > self._most:
                self._stamps.popitem(last=False)

    def forget(self, sha: str) -> None:
        """Hash the file at the next reading, whatever its stamp."""
        with self._lock:
            self._stamps.pop(sha, None)
