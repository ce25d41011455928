"""Results that are kept to be used again, all together within a limit of memory."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from operator import attrgetter
from threading import Lock
from typing import Any

from cachetools import LRUCache

from app.calculations.sizes import size_of

USUAL = 256  # MiB, unless the settings say otherwise


@dataclass(frozen=True)
class _Sized:
    value: object
    size: int  # bytes


def _kept(megabytes: int) -> LRUCache[Hashable, _Sized]:
    return LRUCache(megabytes * 2**20, getsizeof=attrgetter("size"))


class Cache:
    """The values that were used last, as many as fit.

    Keys should be short, such as a digest of what the value follows from: they do not count.
    """

    def __init__(self, megabytes: int) -> None:
        self._lock = Lock()
        self._kept = _kept(megabytes)

    @property
    def size(self) -> int:
        """Return the memory of all values [bytes]."""
        return int(self._kept.currsize)

    def get(self, key: Hashable) -> Any:  # whoever keeps a value knows its type
        """Return the value kept under a key, or None."""
        with self._lock:
            kept = self._kept.get(key)
        return None if kept is None else kept.value

    def keep(self, key: Hashable, value: object, size: int | None = None) -> None:
        """Keep a value, also in place of one that has grown; one larger than the whole cache is not kept.

        To measure a value takes a while; who knows its size roughly may say it [bytes].
        """
        size = size_of(value) if size is None else size
        with self._lock:
            self._kept.pop(key, None)
            if size <= self._kept.maxsize:
                self._kept[key] = _Sized(value, size)

    def limit(self, megabytes: int) -> None:
        """Begin again, empty, with another limit [MiB]."""
        with self._lock:
            self._kept = _kept(megabytes)


results = Cache(USUAL)
"""The cache of the process: evaluations of steps and formulas written out."""
