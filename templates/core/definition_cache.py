"""Parsed units and grammars, cached beside Python's bytecode.

Python keeps the bytecode of a module in `__pycache__`, or below `sys.pycache_prefix`. Parsed definitions are
cached there too. Each cache file records its source and program versions, and is replaced if they differ.
Where Python may not write bytecode, nothing is cached, and each start parses the definitions.
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
"""What reading of pickles may raise that are damaged, or that others have written."""


def place(name: str) -> Path:
    """Return the path under which an object of this name is stored."""
    return Path(cache_from_source(__file__)).parent / name


def may_write() -> bool:
    """Return whether Python would write bytecode there."""
    return not sys.dont_write_bytecode and os.access(place(""), os.W_OK)


def file(name: str) -> str | bool:
    """Return the file for Lark's `cache`, which validates its content.

    The result is False if no file is possible.
    """
    kept = place(name)
    return str(kept) if may_write() or kept.is_file() else False


def from_folder(name: str, make: Callable[[Path | None], T]) -> T:
    """Create something with a folder of prepared parts; without one, if there is none.

    A folder is filled under another name and then renamed, so that it is always complete.

    Parameters
    ----------
    name
        Names the folder, with the versions of all packages on which its files depend.
    make
        Makes it from files of the folder that it is given, and writes those that are missing.
    """
    kept = place(name)
    if kept.is_dir():
        with suppress(*_UNREADABLE):
            return make(kept)
        shutil.rmtree(kept, ignore_errors=True)  # the next start makes it again
    elif may_write():
        with suppress(*_UNREADABLE), tempfile.TemporaryDirectory(dir=kept.parent, prefix=name) as folder:
            filled = Path(folder, "filled")
            made = make(filled)
            with suppress(OSError):  # another process was faster
                filled.rename(kept)
            return made
    return make(None)
