"""Remember which files have been hashed, by their inode, size and times in the file system."""

from __future__ import annotations

import os
import threading
import time
from collections import OrderedDict
from dataclasses import dataclass
from io import BufferedReader
from typing import Generic, TypeVar

REMEMBERED = 20_000  # largest number of remembered files, about 200 bytes each
_RACY = 1_000_000_000  # two changes within this time may leave the same times [ns]


@dataclass(frozen=True)
class Stamp:
    """The properties that change with a file: inode, size [bytes], times of contents and of inode [ns]."""

    inode: int
    size: int
    modified: int
    changed: int


@dataclass(frozen=True)
class OpenFile:
    """An open file, and the stamp that it had when its bytes were verified."""

    file: BufferedReader
    stamp: Stamp

    def is_unchanged(self) -> bool:
        """Return whether the file still has the stamp of the verification."""
        return stamp_of(self.file) == self.stamp

    def __enter__(self) -> OpenFile:
        """Keep the file open."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Close the file."""
        self.file.close()


def stamp_of(file: BufferedReader) -> Stamp:
    """Return the stamp of an open file."""
    seen = os.fstat(file.fileno())
    return Stamp(seen.st_ino, seen.st_size, seen.st_mtime_ns, seen.st_ctime_ns)


T = TypeVar("T")


class Newest(Generic[T]):
    """The latest entries by name, for a bounded number of names."""

    def __init__(self, most: int = REMEMBERED) -> None:
        self._most = most
        self._noted: OrderedDict[str, T] = OrderedDict()
        self._lock = threading.Lock()

    def knows(self, sha: str) -> bool:
        """Return whether there is an entry for this name."""
        with self._lock:
            return sha in self._noted

    def has(self, sha: str, noted: T) -> bool:
        """Return whether the entry for a name equals a given one."""
        with self._lock:
            if self._noted.get(sha) != noted:
                return False
            self._noted.move_to_end(sha)
            return True

    def add(self, sha: str, noted: T) -> None:
        """Store an entry for a name in place of any other."""
        with self._lock:
            self._noted[sha] = noted
            while len(self._noted) > self._most:
                self._noted.popitem(last=False)

    def forget(self, sha: str) -> None:
        """Remove the entry of a name."""
        with self._lock:
            self._noted.pop(sha, None)


class VerifiedStamps(Newest[Stamp]):
    """The newest verified stamps by name."""

    def add(self, sha: str, noted: Stamp) -> None:
        """Remember a verified file, unless it is so young that a change might not change its times."""
        if abs(time.time_ns() - noted.changed) >= _RACY:
            super().add(sha, noted)
