"""A cache of results, limited by the total memory that the results occupy."""

from __future__ import annotations

import sys
from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from gc import get_referents
from operator import attrgetter
from threading import Lock
from types import BuiltinFunctionType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np
import pint
from cachetools import LRUCache
from numpy.typing import NDArray

from templates.core.language.spec import Declaration, Requirement, Shared
from templates.core.units.units import Unit

USUAL = 256  # MiB, unless the settings say otherwise


@dataclass(frozen=True)
class _CacheEntry:
    value: object
    size: int  # bytes


def _kept(megabytes: int) -> LRUCache[Hashable, _CacheEntry]:
    return LRUCache(megabytes * 2**20, getsizeof=attrgetter("size"))


class Cache:
    """The most recently used values, as many as fit into the memory limit.

    Keys should be short, such as a digest of everything that determines the value: their size is not counted.
    """

    def __init__(self, megabytes: int) -> None:
        self._lock = Lock()
        self._kept = _kept(megabytes)

    @property
    def size(self) -> int:
        """Return the memory of all values [bytes]."""
        return int(self._kept.currsize)

    def get(self, key: Hashable) -> Any:  # the caller that stores a value knows its type
        """Return the value stored under a key, or None."""
        with self._lock:
            kept = self._kept.get(key)
        return None if kept is None else kept.value

    def keep(self, key: Hashable, value: object, size: int | None = None) -> None:
        """Store a value, or replace the stored value if this one is larger.

        A value larger than the whole cache is not stored. Measuring a value takes time, so a caller that
        knows the approximate size [bytes] may pass it.
        """
        size = size_of(value) if size is None else size
        with self._lock:
            self._kept.pop(key, None)
            if size <= self._kept.maxsize:
                self._kept[key] = _CacheEntry(value, size)

    def limit(self, megabytes: int) -> None:
        """Empty the cache and set another limit [MiB]."""
        with self._lock:
            self._kept = _kept(megabytes)


results = Cache(USUAL)
"""The cache of this process: evaluations of steps, and written-out formulas."""


_SHARED = (
    type, ModuleType, FunctionType, BuiltinFunctionType, MethodType,
    Declaration, Shared, Requirement, Unit, pint.UnitRegistry, pint.Unit,
)  # fmt: skip
"""Types of objects that belong to the program, and are not counted as part of a value."""
_ATOMS = (float, int, bool, str, bytes, complex, type(None))


def size_of(value: object) -> int:
    """Return the memory of a value and of all objects that it refers to [bytes].

    Shared objects may be counted twice.
    """
    total, seen, waiting = sys.getsizeof(value), {id(value)}, [value]
    while waiting:
        item = waiting.pop()
        for part in _parts(item) if isinstance(item, np.ndarray) else get_referents(item):
            if type(part) in _ATOMS:
                total += sys.getsizeof(part)
            elif id(part) not in seen and not _is_shared(type(part)):  # type: ignore[arg-type]  # a class is hashable
                seen.add(id(part))
                total += sys.getsizeof(part)
                waiting.append(part)
    return total


@lru_cache(2048)
def _is_shared(kind: type) -> bool:
    return issubclass(kind, _SHARED)


def _parts(array: NDArray[np.generic]) -> list[object]:  # arrays of any number type
    """Return the objects in an array; for a view, also the array that owns the data."""
    items = array.ravel().tolist() if array.dtype == object else []
    return items if array.base is None else [*items, array.base]
