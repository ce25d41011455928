"""Cache parsed units and grammars next to Python's bytecode.

Python keeps the bytecode of a module in `__pycache__`, or below `sys.pycache_prefix`. Parsed definitions are
cached there too. Each cache file records its source and program versions, and is replaced if they differ.
If Python may not write bytecode, nothing is cached and each start parses the definitions again.
"""

from __future__ import annotations

import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from importlib.util import cache_from_source
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

_UNREADABLE = (
    OSError, EOFError, ImportError, AttributeError, LookupError, TypeError, ValueError,
    pickle.UnpicklingError,
)  # fmt: skip
"""Errors that reading may raise for damaged pickles, or for those of other programs."""


def place(name: str) -> Path:
    """Return the path at which an object of this name is cached."""
    return Path(cache_from_source(__file__)).parent / name


def may_write() -> bool:
    """Return whether Python would write bytecode to this folder."""
    return not sys.dont_write_bytecode and os.access(place(""), os.W_OK)


def file(name: str) -> str | bool:
    """Return the path of Lark's cache file, which Lark validates, or False if no cache can be used."""
    kept = place(name)
    return str(kept) if may_write() or kept.is_file() else False


def from_folder(name: str, make: Callable[[Path | None], T]) -> T:
    """Create an object from a folder of prepared files, or without a folder if none can be written.

    A folder is filled under a temporary name and then renamed, so that it is always complete.

    Parameters
    ----------
    name
        The name of the folder, with the versions of all packages on which its files depend.
    make
        Creates the object from the files in the given folder, and writes those that are missing.
    """
    kept = place(name)
    if kept.is_dir():
        with suppress(*_UNREADABLE):
            return make(kept)
        shutil.rmtree(kept, ignore_errors=True)  # the next start creates it again
    elif may_write():
        with suppress(*_UNREADABLE), tempfile.TemporaryDirectory(dir=kept.parent, prefix=name) as folder:
            filled = Path(folder, "filled")
            made = make(filled)
            with suppress(OSError):  # another process was faster
                filled.rename(kept)
            return made
    return make(None)
