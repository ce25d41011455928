"""Where a process finds a template: by the file that declares it, as it was when the server read it."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from templates.core.catalogue.finding import declared_in_file
from templates.core.errors import UnusableFile
from templates.core.language.template import Template

BUILT_IN = "templates."


@dataclass(frozen=True)
class Source:
    """The file of a template; a built-in one is part of the program, and `state` is empty."""

    path: str
    state: tuple[int, int] | None  # time of change [ns] and size [bytes]


def source_of(cls: type[Template]) -> Source:
    """The source of a template that has just been read."""
    path = Path(inspect.getfile(cls))
    return Source(str(path), None if cls.__module__.startswith(BUILT_IN) else _state(path))


@lru_cache(maxsize=1024)
def loaded(source: Source) -> type[Template]:
    """The template in this process.

    Raises
    ------
    UnusableFile
        If its file is no longer the one that the server read.
    """
    path = Path(source.path)
    if source.state is not None and source.state != _state(path):
        raise UnusableFile(source.path, "it has changed since the server read it; start the server again")
    return declared_in_file(path)


def _state(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
