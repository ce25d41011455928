"""Functions compiled to machine code by numba when they are first called.

The machine code is cached next to the module, or, if that folder is not writable, in numba's folder for the
user (`NUMBA_CACHE_DIR` sets another). If neither is writable, every process compiles it again. Numba detects
changes only in the file of the function, so functions that call each other belong in one module. Importing
numba takes a second, so a module of compiled functions is imported by the function that needs it.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pickle import UnpicklingError
from typing import ParamSpec, TypeVar

from numba import njit
from numba.core.caching import FunctionCache

P = ParamSpec("P")
R = TypeVar("R")

_REORDERED = {"contract", "reassoc", "arcp", "nsz"}
"""Permission to reorder sums and products; infinity and NaN keep their meaning."""


class _Spare(FunctionCache):
    """An optional cache of machine code on disk: if the disk is full or a file is damaged, numba compiles."""

    @contextmanager
    def _guard_against_spurious_io_errors(self) -> Iterator[None]:
        with suppress(OSError, EOFError, UnpicklingError):
            yield


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Return the function as machine code; arguments are arrays, numbers and named tuples of these."""
    result: Callable[P, R] = njit(fastmath=_REORDERED, error_model="numpy")(function)
    with suppress(RuntimeError):  # numba has no writable folder
        result._cache = _Spare(function)  # type: ignore[attr-defined, no-untyped-call]
    return result
