"""Find every `<id>_v<version>.py` below a list of folders, so that a new file adds a template."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Generic, TypeVar

from templates.core.catalogue.modules import failing_line, load
from templates.core.errors import (
    QuarantinedTemplate,
    UnknownTemplate,
    UnreleasedTemplate,
    UnusableFile,
    plain,
)
from templates.core.language.template import VERSIONED, Template

T = TypeVar("T", bound=Template)


@dataclass(frozen=True)
class Catalogue(Generic[T]):
    """All versions of all templates (or models) in the folders; messages use `kind` to name them.

    `quarantined` gives the reason why a faulty version cannot be used, `unreleased` the reason why a draft
    worksheet cannot.
    """

    versions: dict[tuple[str, int], type[T]]
    kind: str = "template"
    quarantined: Mapping[tuple[str, int], str] = field(default_factory=dict)
    unreleased: Mapping[tuple[str, int], str] = field(default_factory=dict)

    @cached_property
    def ids(self) -> tuple[str, ...]:
        """Return every id, sorted."""
        return tuple(sorted({id for id, _ in self.versions}))

    def of(self, id: str) -> dict[int, type[T]]:
        """Return the versions of one id, in ascending order.

        Raises
        ------
        UnknownTemplate
            If the id has no version.
        """
        classes = {version: cls for (name, version), cls in sorted(self.versions.items()) if name == id}
        if not classes:
            refused = (*self.quarantined, *self.unreleased)
            self._refuse_unusable(id, max((n for name, n in refused if name == id), default=0))
            raise UnknownTemplate(
                id, f"no {self.kind} is named {plain(id)!r}; use one of {', '.join(self.ids)}"
            )
        return classes

    def get(self, id: str, version: int) -> type[T]:
        """Return one version of one id.

        Raises
        ------
        UnknownTemplate
            If the version does not exist.
        """
        if (version_class := self.versions.get((id, version))) is None:
            self._refuse_unusable(id, version)
            listing = ", ".join(map(str, self.of(id)))
            raise UnknownTemplate(
                id, f"{self.kind} {id} has no version {version}; its versions are {listing}"
            )
        return version_class

    def _refuse_unusable(self, id: str, version: int) -> None:
        """Raise an error with the reason if the version exists but cannot be used.

        Raises
        ------
        QuarantinedTemplate
            If its file has faults.
        UnreleasedTemplate
            If it is a draft worksheet.
        """
        if reason := self.unreleased.get((id, version)):
            raise UnreleasedTemplate(id, f"{self.kind} {id} version {version} is not a release: {reason}")
        if reason := self.quarantined.get((id, version)):
            raise QuarantinedTemplate(id, f"{self.kind} {id} version {version} is quarantined: {reason}")

    def latest(self, id: str) -> type[T]:
        """Return the newest version that is not withdrawn; if all are withdrawn, the newest."""
        versions = list(self.of(id).values())
        return next((cls for cls in reversed(versions) if not cls.withdrawn), versions[-1])

    def __iter__(self) -> Iterator[type[T]]:
        return iter(self.versions.values())


def find(
    folders: Iterable[Path],
    base: type[T],
    kind: str = "template",
    *,
    id: str | None = None,
    version: int | None = None,
) -> Catalogue[T]:
    """Import every versioned file below the folders and return the declared subclasses of `base`.

    If an `id` or a `version` is given, import only files with that name.

    Raises
    ------
    UnusableFile
        If a file cannot be imported, declares no template or several, or claims another file's version.
    """
    versions: dict[tuple[str, int], type[T]] = {}
    for path in sorted(file for folder in folders for file in folder.rglob("*_v*.py")):
        match = VERSIONED.match(path.stem)
        if not match or id not in (None, match[1]) or version not in (None, int(match[2])):
            continue
        cls = declared_in(_usable(path), path)
        if not issubclass(cls, base):
            continue  # a calculation stored with the models
        if (cls.id, cls.version) in versions:
            raise UnusableFile(
                str(path), f"{cls.id} version {cls.version} is already declared in another file"
            )
        versions[cls.id, cls.version] = cls
    return Catalogue(dict(sorted(versions.items())), kind)


def declared_in_file(path: Path) -> type[Template]:
    """Return the template or model that a versioned file declares.

    Raises
    ------
    UnusableFile
        If the file cannot be imported, or declares none or several.
    """
    return declared_in(_usable(path), path)


def _imported(path: Path) -> ModuleType:
    """Import a file and return its module.

    A file in a package is imported by its name, any other file from its content.
    """
    if package := package_of(path.parent):
        return importlib.import_module(f"{package}.{path.stem}")
    return load(path, path.read_bytes())


def package_of(folder: Path) -> str:
    """Return the package name of a folder; empty if it is not a package."""
    if not (folder / "__init__.py").exists():
        return ""
    parent = package_of(folder.parent)
    return f"{parent}.{folder.name}" if parent else folder.name


def _usable(path: Path) -> ModuleType:
    """Import a file and return its module; the `UnusableFile` of a faulty file names the failing line."""
    try:
        return _imported(path)
    except Exception as error:
        line = failing_line(error, path)
        where = f"line {line}: " if line else ""
        text = error.msg if isinstance(error, SyntaxError) else str(error)
        raise UnusableFile(str(path), f"{where}{type(error).__name__}: {text}") from error


def declared_in(module: ModuleType, path: Path) -> type[Template]:
    """Return the template or model that the module of a versioned file declares.

    Raises
    ------
    UnusableFile
        If the module declares none or several.
    """
    classes = [
        value
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Template) and value.__module__ == module.__name__
    ]
    if len(classes) != 1:
        raise UnusableFile(str(path), f"the file must declare one template, not {len(classes)}")
    return classes[0]
