"""Where a process finds a template: by the file that declares it, as it was when the server read it."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from templates.core.catalogue.finding import declared_in, declared_in_file
from templates.core.catalogue.loading import load, origin
from templates.core.language.template import Template


@dataclass(frozen=True)
class Source:
    """The file of a template; the content of a team's file goes with it, of a built-in one nothing."""

    path: str
    digest: str = ""
    content: bytes = field(default=b"", compare=False)


def source_of(cls: type[Template]) -> Source:
    """The source of a template, with the code that this process calculates by."""
    module, path = inspect.getmodule(cls), inspect.getfile(cls)
    made = origin(module) if module else None
    return Source(path, made[1], made[0]) if made else Source(path)


@lru_cache(maxsize=1024)
def loaded(source: Source) -> type[Template]:
    """The template in this process, by the code that the server sent.

    Raises
    ------
    UnusableFile
        If it cannot be imported here.
    """
    path = Path(source.path)
    if not source.digest:
        return declared_in_file(path)
    return declared_in(load(path, source.content, source.digest), path)
