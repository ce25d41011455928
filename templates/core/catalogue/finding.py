"""Finds every `<id>_v<version>.py` in a list of folders: one file adds a template, nothing is registered."""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import sys
import traceback
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Generic, TypeVar

from templates.core.errors import UnknownTemplate, UnusableFile, plain
from templates.core.language.template import VERSIONED, Template

T = TypeVar("T", bound=Template)

OUTSIDE = "_outside"
"""The package to which files belong that are in none."""


@dataclass(frozen=True)
class Catalogue(Generic[T]):
    """All versions of all templates (or models) in the folders; `kind` names them in messages."""

    versions: dict[tuple[str, int], type[T]]
    kind: str = "template"

    @cached_property
    def ids(self) -> tuple[str, ...]:
        """Every id, sorted."""
        return tuple(sorted({id for id, _ in self.versions}))

    def of(self, id: str) -> dict[int, type[T]]:
        """The versions of one id, ascending.

        Raises
        ------
        UnknownTemplate
            If there is none.
        """
        classes = {version: cls for (name, version), cls in sorted(self.versions.items()) if name == id}
        if not classes:
            raise UnknownTemplate(
                id, f"there is no {self.kind} {plain(id)!r}; there are {', '.join(self.ids)}"
            )
        return classes

    def get(self, id: str, version: int) -> type[T]:
        """One version of one id.

        Raises
        ------
        UnknownTemplate
            If there is none.
        """
        if (version_class := self.versions.get((id, version))) is None:
            listing = ", ".join(map(str, self.of(id)))
            raise UnknownTemplate(id, f"{self.kind} {id} has no version {version}; it has {listing}")
        return version_class

    def latest(self, id: str) -> type[T]:
        """The newest version that is not withdrawn, else the newest."""
        versions = list(self.of(id).values())
        return next((cls for cls in reversed(versions) if not cls.withdrawn), versions[-1])

    def __iter__(self) -> Iterator[type[T]]:
        return iter(self.versions.values())


def find(folders: Iterable[Path], base: type[T], kind: str = "template") -> Catalogue[T]:
    """Import every versioned file below the folders and collect what it declares, if that is a `base`.

    Raises
    ------
    UnusableFile
        If a file cannot be imported, declares none or several, or claims another file's version.
    """
    versions: dict[tuple[str, int], type[T]] = {}
    for path in sorted(file for folder in folders for file in folder.rglob("*_v*.py")):
        if not VERSIONED.match(path.stem):
            continue
        cls = _declared_in(_usable(path), path)
        if not issubclass(cls, base):
            continue  # a calculation beside models
        if (cls.id, cls.version) in versions:
            raise UnusableFile(str(path), f"{cls.id} version {cls.version} stands in another file already")
        versions[cls.id, cls.version] = cls
    return Catalogue(dict(sorted(versions.items())), kind)


def declared_in_file(path: Path) -> type[Template]:
    """The template, or model, that one versioned file declares.

    Raises
    ------
    UnusableFile
        If it cannot be imported, or declares none or several.
    """
    return _declared_in(_usable(path), path)


def _imported(path: Path) -> ModuleType:
    """The module of a file: by its package's name where it has one, else by its path."""
    package = _package(path.parent)
    if package:
        return importlib.import_module(f"{package}.{path.stem}")
    path = path.resolve()
    sys.modules.setdefault(OUTSIDE, ModuleType(OUTSIDE))  # else nothing of such a file could be pickled
    name = f"{OUTSIDE}.{hashlib.sha256(bytes(path.parent)).hexdigest()[:12]}.{path.stem}"
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} cannot be imported")
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _package(folder: Path) -> str:
    if not (folder / "__init__.py").exists():
        return ""
    parent = _package(folder.parent)
    return f"{parent}.{folder.name}" if parent else folder.name


def _usable(path: Path) -> ModuleType:
    """The module of a file, or the line of it that fails."""
    try:
        return _imported(path)
    except Exception as error:
        lines = [
            frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)
        ]
        if isinstance(error, SyntaxError):
            lines.append(error.lineno)
        where = f"line {lines[-1]}: " if lines else ""
        raise UnusableFile(str(path), f"{where}{type(error).__name__}: {error}") from error


def _declared_in(module: ModuleType, path: Path) -> type[Template]:
    classes = [
        value
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Template) and value.__module__ == module.__name__
    ]
    if len(classes) != 1:
        raise UnusableFile(str(path), f"it declares {len(classes)} templates; it must declare one")
    return classes[0]
