"""Memory that a value holds, arrays and long lists included."""

from __future__ import annotations

import sys
from functools import lru_cache
from gc import get_referents
from types import BuiltinFunctionType, FunctionType, MethodType, ModuleType

import numpy as np
import pint
from numpy.typing import NDArray

from templates.core.language.spec import Declaration, Requirement, Shared
from templates.core.units.units import Unit

_SHARED = (
    type, ModuleType, FunctionType, BuiltinFunctionType, MethodType,
    Declaration, Shared, Requirement, Unit, pint.UnitRegistry, pint.Unit,
)  # fmt: skip
"""What belongs to the program, not to the values that refer to it."""
_ATOMS = (float, int, bool, str, bytes, complex, type(None))


def size_of(value: object) -> int:
    """Return the memory of a value and of all that it refers to [bytes].

    What equal parts share may count twice.
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


def _parts(array: NDArray[np.generic]) -> list[object]:  # arrays of any kind of number
    """Return the objects in an array, and of a view the array that owns the numbers."""
    items = array.ravel().tolist() if array.dtype == object else []
    return items if array.base is None else [*items, array.base]
