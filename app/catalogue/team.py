"""The files of a team: list them, load the valid ones, and report the faults of the others."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.catalogue.check import Check, loaded_or_faulty
from app.catalogue.sheets import Key, Sheets
from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue
from templates.core.checks.faults import FileFault
from templates.core.checks.golden import records
from templates.core.language.template import VERSIONED, Template

Signature = tuple[tuple[int, int, int] | None, ...]
"""Times of change [ns] and size [bytes] of a file and its companion files; None for a missing file."""

_MEANT = re.compile(r".+_[vV][0-9]+")  # a name that looks like that of a version
NAME = "name it `<id>_v<version>.py`, in small letters, such as `bush_duty_v1.py`"


@dataclass(frozen=True)
class TeamFile:
    """One file of a team: the class that it declares, if the file is usable, and its faults."""

    folder: Path
    path: Path
    signature: Signature
    digest: str
    cls: type[Template] | None
    faults: tuple[FileFault, ...]

    @property
    def key(self) -> Key | None:
        """Return the id and version that the file's name states."""
        match = VERSIONED.match(self.path.stem)
        return (match[1], int(match[2])) if match else None

    @property
    def name(self) -> str:
        """Return the path within the team's folder, as pages show it, without paths of this machine."""
        return str(Path(self.folder.name) / self.path.relative_to(self.folder))

    @property
    def is_quarantined(self) -> bool:
        """Return whether the file cannot be used."""
        return self.cls is None

    def refused(self, fault: FileFault) -> TeamFile:
        """Return the same file with an additional fault, which quarantines it."""
        return replace(self, cls=None, faults=(*self.faults, fault))


@dataclass(frozen=True)
class Snapshot:
    """All templates and models at one time, including files of teams and worksheets."""

    templates: Catalogue[Template]
    models: Catalogue[CadModel]
    files: tuple[TeamFile, ...] = ()
    sheets: Sheets = field(default_factory=Sheets)


class TeamFiles:
    """The files in a team's folders; `examine` checks the changed ones again.

    This class is not thread-safe.
    """

    def __init__(self, folders: Sequence[Path], check: Check) -> None:
        self.folders, self.check = tuple(folders), check
        self._files: dict[Path, TeamFile] = {}

    def examine(self) -> bool:
        """Check the files for changes, and return whether any file changed."""
        present = dict(_scanned(self.folders))
        old = self._files
        self._files = {path: self._current(*place, path) for path, place in present.items()}
        return {path: file.digest for path, file in old.items()} != {
            path: file.digest for path, file in self._files.items()
        }

    @classmethod
    def of_file(cls, path: Path, check: Check) -> TeamFile:
        """Return one file, checked by itself."""
        return cls((), check)._current(path.parent, _signature(path), path)

    @property
    def files(self) -> list[TeamFile]:
        """Return every file, sorted by folder and name."""
        return list(self._files.values())

    def _current(self, folder: Path, signature: Signature, path: Path) -> TeamFile:
        """Return the stored result for a file if its content is unchanged; else check and load it."""
        cached = self._files.get(path)
        if cached is not None and cached.signature == signature:
            return cached
        try:
            content = path.read_bytes() if path.is_file() else None
        except OSError as error:
            fault = FileFault(
                "unreadable", f"it cannot be read: {error.strerror}", "grant the service access"
            )
            return TeamFile(folder, path, signature, "", None, (fault,))
        if content is None:
            fault = FileFault("folder", "there is no such folder", "make it, or correct the setting")
            return TeamFile(folder, path, signature, "", None, (fault,))
        digest = _digest(path, content)
        if cached is not None and cached.digest == digest:
            return replace(cached, signature=signature)
        return self._checked(TeamFile(folder, path, signature, digest, None, ()), content)

    def _checked(self, file: TeamFile, content: bytes) -> TeamFile:
        if file.key is None:
            what = f"{file.path.name} is not a name of a version"
            return replace(file, faults=(FileFault("file_name", what, NAME),))
        faults = self.check(file.path, content)
        if any(fault.quarantines for fault in faults):
            return replace(file, faults=tuple(faults))
        cls = loaded_or_faulty(file.path, content, file.digest)
        if isinstance(cls, FileFault):
            return replace(file, faults=(*faults, cls))
        return replace(file, cls=cls, faults=tuple(faults))


def _scanned(folders: Iterable[Path]) -> Iterator[tuple[Path, tuple[Path, Signature]]]:
    """Yield every file whose name is, or resembles, the file name of a version, with its signature.

    Folders that are missing are also reported.
    """
    for folder in folders:
        if not folder.is_dir():
            yield folder, (folder.parent, (None,))
            continue
        for path in sorted(folder.rglob("*.py")):
            if (VERSIONED.match(path.stem) or _MEANT.fullmatch(path.stem)) and not path.is_dir():
                yield path, (folder, _signature(path))


def _signature(path: Path) -> Signature:
    return tuple(_state(file) for file in (path, *_beside(path)))


def _beside(path: Path) -> tuple[Path, ...]:
    """Return the files that accompany a template: measured errors, digests of its release, and results."""
    named = (path.with_name(f"{path.stem}.{kind}.json") for kind in ("accuracy", "release"))
    return (*named, *records(path))


def _state(path: Path) -> tuple[int, int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_ctime_ns, status.st_size


def _digest(path: Path, content: bytes) -> str:
    """Return the SHA-256 over a file and its accompanying files."""
    digest = hashlib.sha256(content)
    for file in _beside(path):
        if file.is_file():
            digest.update(b"\0" + file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def merged(
    templates: Catalogue[Template], models: Catalogue[CadModel], files: Iterable[TeamFile]
) -> Snapshot:
    """Return the built-in versions and those of a team; a file for an existing version is quarantined."""
    own_templates, own_models = dict(templates.versions), dict(models.versions)
    owners: dict[tuple[bool, Key], TeamFile] = {}
    settled: list[TeamFile] = []
    for file in files:
        if (cls := file.cls) is None or (key := file.key) is None:
            settled.append(file)
            continue
        is_model = issubclass(cls, CadModel)
        if key in (own_models if is_model else own_templates):
            settled.append(file.refused(_taken(key, owners.get((is_model, key)))))
            continue
        if issubclass(cls, CadModel):
            own_models[key] = cls
        else:
            own_templates[key] = cls
        owners[is_model, key] = file
        settled.append(file)
    reasons = {file.key: _reason(file) for file in settled if file.is_quarantined and file.key}
    return Snapshot(
        Catalogue(dict(sorted(own_templates.items())), templates.kind, reasons),
        Catalogue(dict(sorted(own_models.items())), models.kind, reasons),
        tuple(settled),
    )


def joined(files: Snapshot, sheets: Sheets) -> Snapshot:
    """Return the versions from files together with those from worksheets.

    A released worksheet keeps its name: a later file with the same name would change the results of designs
    that use it. A file does not replace a broken worksheet either.
    """
    released = {key: sheet.cls for key, sheet in sheets.released.items()}
    others = {key: cls for key, cls in files.templates.versions.items() if not sheets.owns(key)}
    templates = Catalogue(
        dict(sorted({**others, **released}.items())),
        files.templates.kind,
        {**files.templates.quarantined, **sheets.broken},
        sheets.unreleased,
    )
    settled = (file.refused(_worksheets(file)) if _collides(file, sheets) else file for file in files.files)
    return Snapshot(templates, files.models, tuple(settled), sheets)


def with_models(files: Snapshot, imported: Mapping[Key, type[CadModel]]) -> Snapshot:
    """Return the models from files together with those that a team has imported.

    A file does not replace an imported model.
    """
    if not imported:
        return files
    versions = dict(sorted({**files.models.versions, **imported}.items()))
    return replace(files, models=replace(files.models, versions=versions))


def _collides(file: TeamFile, sheets: Sheets) -> bool:
    """Return whether a file declares a template that has been released as a worksheet."""
    return file.cls is not None and not issubclass(file.cls, CadModel) and sheets.owns(file.key)


def _worksheets(file: TeamFile) -> FileFault:
    what = f"{file.path.stem} has been released as a worksheet"
    return FileFault("worksheet", what, "give it another id, or the next free version")


def _taken(key: Key, by: TeamFile | None) -> FileFault:
    id, version = key
    what = f"{id} version {version} is that of {by.name if by else 'this program'} already"
    return FileFault("duplicate" if by else "shipped", what, "give it another id, or the next free version")


def _reason(file: TeamFile) -> str:
    """Return one sentence that says why a file cannot be used."""
    first = next(fault for fault in file.faults if fault.quarantines)
    more = len(file.faults) - 1
    others = f", and {more} more" if more else ""
    return f"its file {file.name} has faults: {first.sentence}{others}. See /templates/faults"
