"""Modules of files outside this program's packages, each created from its bytes.

The name of the module contains a digest of the file's content, so an edited file makes a new module and the
old module stays loaded. A running calculation keeps the code with which it began, and objects from another
process are unpickled with the code version of that process.
"""

from __future__ import annotations

import hashlib
import linecache
import sys
import traceback
from importlib.util import decode_source
from pathlib import Path
from types import ModuleType

OUTSIDE = "_outside"
"""The package name for files that belong to no package."""

WORKSHEETS = "worksheets"
"""The package name for classes created from worksheets; no such package exists."""

IMPORTED = "imported"
"""The package name for classes of models that a team has imported; no such package exists."""

_CONTENT, _DIGEST = "__content__", "__digest__"  # attributes of such a module


class _Text:
    """The loader of such a module; `inspect` and tracebacks read the compiled source from it."""

    def __init__(self, text: str) -> None:
        self.text = text

    def get_source(self, name: str) -> str:
        """Return the source of the module."""
        return self.text


def load(path: Path, content: bytes, digest: str = "") -> ModuleType:
    """Return the module that is created from the content of a file.

    It is created once for each digest, by default the digest of the content.

    Raises
    ------
    Exception
        Any error of the file: SyntaxError, ImportError, …
    """
    digest = digest or hashlib.sha256(content).hexdigest()
    name = _name(path, digest)
    if name in sys.modules:
        return sys.modules[name]
    sys.modules.setdefault(OUTSIDE, ModuleType(OUTSIDE))  # needed to pickle objects of such a file
    text = decode_source(content)
    place = f"{path}@{digest[:12]}"  # each content of a file has its own source text
    module = ModuleType(name)
    vars(module).update(
        __file__=str(path),
        __package__="",
        __spec__=None,
        __loader__=_Text(text),
        **{_CONTENT: content, _DIGEST: digest},
    )
    linecache.cache[place] = len(text), None, text.splitlines(keepends=True), place
    sys.modules[name] = module
    try:
        exec(compile(text, place, "exec", dont_inherit=True), vars(module))
    except BaseException:
        del sys.modules[name]
        raise
    return module


def origin(module: ModuleType) -> tuple[bytes, str] | None:
    """Return the content from which `load` created a module, and its digest; None for other modules."""
    parts = vars(module)
    return (parts[_CONTENT], parts[_DIGEST]) if _CONTENT in parts else None


def text_of(module: ModuleType) -> str | None:
    """Return the source from which `load` created a module."""
    return decode_source(source[0]) if (source := origin(module)) else None


def is_outside(cls: type) -> bool:
    """Return whether a class comes from outside this program's packages.

    This is true for a team's files, worksheets and imported models.
    """
    return cls.__module__.partition(".")[0] in (OUTSIDE, WORKSHEETS, IMPORTED)


def failing_line(error: BaseException, path: Path) -> int | None:
    """Return the number of the last line of a file that appears in an error's traceback."""
    if isinstance(error, SyntaxError) and _is_in(error.filename or "", path):
        return error.lineno
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno for frame in frames if _is_in(frame.filename, path)]
    return lines[-1] if lines else None


def _is_in(filename: str, path: Path) -> bool:
    return filename == str(path) or filename.startswith(f"{path}@")


def _name(path: Path, digest: str) -> str:
    folder = hashlib.sha256(bytes(path.resolve().parent)).hexdigest()[:12]
    return f"{OUTSIDE}.{folder}.{digest[:12]}.{path.stem}"
