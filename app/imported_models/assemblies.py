"""Build the description of an assembly from its manifest: find, fix and pack each fixed part.

The package holds the STEP file of every fixed part, so an assembly can be rebuilt even if the models and
designs of its parts no longer exist.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.imported_models import repository
from app.imported_models.assembly_manifest import Base, FixedPart, read
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing, NotFound
from app.storage.tables import ArtifactRow, DesignRow, RevisionModelRow
from cad.assemblies import AssemblyDescription, Component, base_of, described
from cad.errors import GeometryError, UnreadableModel
from cad.imported_models import Description, ProgramResult
from cad.model import CadModel
from cad.model_classes import description_of
from templates.core.catalogue.modules import is_outside
from templates.core.errors import UnknownTemplate

LARGEST = 128 * 2**20
"""Largest size of the STEP files of all fixed parts together [bytes]."""
_BEGINNING_OF_TIME = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class _Source:
    """The source of a fixed part: its file, its origin in words, and its component models.

    The file is stored, or belongs to an imported model, whose program draws it.
    """

    sha: str
    origin: str
    holds: tuple[str, ...]
    drawn: tuple[str, Description] | None = None  # id and description of the imported model


Build = Callable[[str, Description], bytes]
"""Return the STEP file of an imported model of an id, with the values of its own file."""


def described_assembly(
    content: bytes,
    id: str,
    file_name: str,
    database: Database,
    store: Artifacts,
    catalogues: Catalogues,
    build: Build,
) -> AssemblyDescription:
    """Return the description of an assembly, and store the package of its fixed parts.

    Raises
    ------
    UnreadableModel
        If the manifest is wrong, or names a missing part.
    ArtifactMissing, ArtifactDamaged
        If the file of a part is lost.
    GeometryError
        If an imported model cannot be drawn.
    """
    manifest = read(content)
    base = _base(manifest.base, catalogues)
    components: dict[Component, dict[str, float]] = {}
    files: dict[str, bytes] = {}
    with database.read() as session:
        sources = [(one, _source(session, one)) for one in manifest.components]
    for fixed, there in sources:
        if id in there.holds:
            raise UnreadableModel(
                "cycle", f"{fixed.name}: {there.origin} contains {id} itself; choose another part"
            )
        if there.drawn:
            step = build(*there.drawn)
            there = replace(there, sha=hashlib.sha256(step).hexdigest())
            files[there.sha] = step
        elif there.sha not in files:
            files[there.sha] = store.read(there.sha)
        if sum(map(len, files.values())) > LARGEST:
            detail = f"the STEP files of the components are together larger than {LARGEST // 2**20} MiB"
            raise UnreadableModel("too_large", detail)
        components[_component(fixed, there)] = fixed.place()
    _require_distinct(base, components)
    sha = store.put(_packed(files))
    pinned = (base.id, base.version) if base else None
    return described(manifest.title.rstrip(". "), sha, file_name, pinned, components)


class AssemblyFiles:
    """Provides an assembly with the STEP files of its fixed parts."""

    def __init__(self, store: Artifacts) -> None:
        self._store = store

    def draw(self, described: Description, values: Mapping[str, float], cancelled: object) -> ProgramResult:
        """Return the files by hash; see `Drawing.draw`."""
        try:
            packed = self._store.read(described.file)
        except (ArtifactMissing, ArtifactDamaged):
            detail = (
                f"the fixed parts of {described.title} are lost: restore file {described.file} from a backup"
            )
            raise GeometryError("component_lost", detail) from None
        with zipfile.ZipFile(io.BytesIO(packed)) as package:
            return ProgramResult(fixed={name: package.read(name) for name in package.namelist()})


def _packed(files: Mapping[str, bytes]) -> bytes:
    """Return one package of files, named by their hashes; equal files give equal bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as package:
        for sha in sorted(files):
            package.writestr(zipfile.ZipInfo(sha, _BEGINNING_OF_TIME), files[sha], zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def _base(base: Base | None, catalogues: Catalogues) -> type[CadModel] | None:
    """Return the class of the base model of an assembly."""
    if base is None:
        return None
    try:
        version = base.version or catalogues.models.latest(base.model).version
        cls = catalogues.models.get(base.model, version)
    except UnknownTemplate as error:
        raise UnreadableModel("base", f"base: {error}") from None
    if is_outside(cls):
        detail = (
            f"base: {base.model} is not a model of this program, so it cannot be the base. Name it as a "
            "component: a STEP file by `model`, any other model by a design that has it"
        )
        raise UnreadableModel("base", detail)
    assert base_of((cls.id, cls.version)) is cls, "the models of this program are those of every process"
    return cls


def _source(session: Session, fixed: FixedPart) -> _Source:
    """Return the file of a fixed part.

    Raises
    ------
    UnreadableModel
        If there is none.
    """
    return _of_model(session, fixed) if fixed.model else _of_design(session, fixed)


def _of_model(session: Session, fixed: FixedPart) -> _Source:
    id = fixed.model or ""
    numbers = repository.numbers(session, id)
    number = fixed.version or max(numbers, default=0)
    if number not in numbers:
        there_is = f"version {number}; it has versions {', '.join(map(str, numbers[-10:]))}"
        nothing = "that was imported as a file"
        detail = f"{fixed.name}: there is no model {id} {there_is if numbers else nothing}"
        raise UnreadableModel("component", detail)
    about = description_of(repository.version(session, id, number).description)
    origin, holds = f"model {id} version {number}", (id, *_held(session, id, number))
    if about.program == "step":
        return _Source(about.file, origin, holds)
    if isinstance(about, AssemblyDescription) and about.base:
        detail = (
            f"{fixed.name}: a design sets the sizes of {id}, which are those of {about.base[0]}; put {id} "
            "into a design, and name that design and its revision"
        )
        raise UnreadableModel("component", detail)
    return _Source("", origin, holds, (id, about))


def _of_design(session: Session, fixed: FixedPart) -> _Source:
    """Return the STEP file of a model in a design, at one revision or at the newest that has a solid."""
    design, row = fixed.design or "", RevisionModelRow
    there = session.get(DesignRow, design)
    if there is None or there.deleted:
        raise UnreadableModel("component", f"{fixed.name}: there is no design {design!r}")
    query = (
        select(row, ArtifactRow.sha256)
        .join(ArtifactRow, (ArtifactRow.build_key == row.build_key) & (ArtifactRow.kind == "step"))
        .where(row.design_id == design, ~row.name.contains("."))
    )
    if fixed.revision:
        query = query.where(row.number == fixed.revision)
    if fixed.part:
        query = query.where(row.name == fixed.part)
    good = session.execute(query.order_by(row.number.desc(), row.name).limit(50)).all()
    newest = [(model, sha) for model, sha in good if model.number == good[0][0].number]
    if not newest:
        which = f"revision {fixed.revision}" if fixed.revision else "any revision"
        part = f" of {fixed.part}" if fixed.part else ""
        raise UnreadableModel(
            "component", f"{fixed.name}: design {design} has no finished solid{part} in {which}"
        )
    if len(newest) > 1:
        names = ", ".join(model.name for model, _ in newest)
        raise UnreadableModel("component", f"{fixed.name}: design {design} has {names}; name one as `part`")
    model, sha = newest[0]
    origin = f"design {design} revision {model.number}, {model.name}"
    return _Source(sha, origin, (model.model, *_held(session, model.model, model.model_version)))


def _held(session: Session, id: str, number: int) -> tuple[str, ...]:
    """Return the ids of the models that an assembly contains; empty for other models."""
    try:
        about = description_of(repository.version(session, id, number).description)
    except NotFound:
        return ()
    if not isinstance(about, AssemblyDescription):
        return ()
    return tuple(sorted({held for one in about.components for held in one.holds}))


def _component(fixed: FixedPart, source: _Source) -> Component:
    return Component(
        name=fixed.name,
        file=source.sha,
        origin=source.origin,
        datum=fixed.datum,
        may_overlap=tuple(fixed.may_overlap),
        density=fixed.density_si(),
        material=fixed.material.strip(),
        holds=source.holds,
    )


def _require_distinct(
    base: type[CadModel] | None, components: Mapping[Component, Mapping[str, float]]
) -> None:
    """Refuse components whose parameters would have the same names, such as `wall` with `wall_x`."""
    taken = {*base.inputs, *base.formulas} if base else set[str]()
    for one in components:
        names = {parameter.name for parameter in one.parameters({})}
        if clash := sorted(names & taken):
            raise UnreadableModel(
                "name", f"{one.name}: {clash[0]} is already a parameter; choose another name"
            )
        taken |= names
