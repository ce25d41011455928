"""The sources from which a process loads a template: the file or worksheet, as the server read it."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import templates
from cad.imported_models import ImportedModel
from cad.model_classes import class_of as class_of_description
from templates.core.catalogue.discovery import declared_in, declared_in_file
from templates.core.catalogue.modules import load, origin
from templates.core.language.template import Template
from templates.core.sheets.design_names import DesignName
from templates.core.sheets.sheet import Sheet, from_text

_PROGRAM = str(Path(templates.__file__).parents[1])
"""Folder of the program's packages on this machine."""


@dataclass(frozen=True)
class FileSource:
    """The file of a template, with its content if it is a team's file.

    The path of a built-in template is relative to the program, which other machines have elsewhere.
    """

    path: str
    digest: str = ""
    content: bytes = field(default=b"", compare=False)


@dataclass(frozen=True)
class SheetSource:
    """The text of a worksheet, from which each process creates the class."""

    id: str
    version: int
    text: str
    withdrawn: str | None
    design: tuple[DesignName, ...] | None = None


@dataclass(frozen=True)
class ImportedSource:
    """The description of a model that a team has imported, from which each process creates the class."""

    id: str
    version: int
    text: str


Source = FileSource | SheetSource | ImportedSource


def source_of(cls: type[Template]) -> Source:
    """Return the source of a template, with the code that this process uses."""
    if issubclass(cls, ImportedModel):
        return ImportedSource(cls.id, cls.version, cls.imported.text)
    if isinstance(cls.sheet, Sheet):
        return SheetSource(cls.id, cls.version, cls.sheet.text, cls.withdrawn, cls.sheet.design)
    module, path = inspect.getmodule(cls), inspect.getfile(cls)
    code = origin(module) if module else None
    if code is None:
        return FileSource(path.removeprefix(f"{_PROGRAM}/"))
    return FileSource(path, code[1], code[0])


@lru_cache(maxsize=1024)
def loaded(source: Source) -> type[Template]:
    """Return the template in this process, created from the code that the server sent.

    Raises
    ------
    UnusableFile
        If a file cannot be imported here.
    SheetRefused
        If a worksheet has faults.
    """
    if isinstance(source, ImportedSource):
        return class_of_description(source.text, source.id, source.version)
    if isinstance(source, SheetSource):
        return class_of(source)
    path = Path(_PROGRAM, source.path)
    if not source.digest:
        return declared_in_file(path)
    return declared_in(load(path, source.content, source.digest), path)


def class_of(source: SheetSource) -> type[Template]:
    """Return the class of a worksheet; equal calls return the same class.

    Raises
    ------
    SheetRefused
        If its text has faults.
    """
    return from_text(source.text, source.id, source.version, source.withdrawn, source.design)
