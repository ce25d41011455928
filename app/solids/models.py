"""CAD models that are built outside a design, and the files of all builds."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.schemas.answers import Shown, Version
from app.solids import measures, rows, stated_tolerances
from app.solids.builds import Builds
from app.solids.rows import is_fresh, renew
from app.solids.schemas.models import Build, BuildUse, StepStatement, Verification
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import CannotRebuild, NotFound
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded
from cad.errors import GeometryError
from cad.export import is_derived
from cad.file_kinds import with_part
from cad.header import ONLY_PART, Header, read_header
from cad.model import CadModel
from cad.regenerate import as_text, build_key
from cad.stamp import is_copy
from cad.statements import UNITS, Value, compared, is_validated, read_statements
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import TemplateError

BUILD = "build"
VALIDATED = "validated.step"
FAILURES = (TemplateError, GeometryError, DeadlineExceeded, MemoryExceeded, CannotRebuild)
"""Errors that a model causes."""


@dataclass(frozen=True)
class File:
    """A stored file of a build."""

    kind: str
    sha256: str


class Models:
    """Provides builds outside a design, and the files of all builds."""

    def __init__(self, database: Database, store: Artifacts, jobs: Jobs, catalogues: Catalogues) -> None:
        self.database, self.store, self.jobs, self.catalogues = database, store, jobs, catalogues

    @property
    def catalogue(self) -> Catalogue[CadModel]:
        """Return the current models."""
        return self.catalogues.models

    def request(self, shape: CadModel, kinds: tuple[str, ...], client: str = "") -> str | None:
        """Return the job that creates a build and its files, or None if all exist."""
        key = build_key(shape)
        with self.database.read() as session:
            there = rows.artifacts(session, key)
            fresh = is_fresh(session, [key])
        is_there = all(kind in there and self.store.exists(there[kind]) for kind in kinds)
        if is_there and fresh:
            return None
        payload = {
            "model": shape.id,
            "version": shape.version,
            "parameters": as_text(shape),
            "kinds": [*kinds],
        }

        def unit(session: Session) -> str | None:
            if renew(session, [key]) and is_there:  # it was not deleted meanwhile
                return None
            return self.jobs.request(session, BUILD, payload, client)

        return self.jobs.commit(unit)

    def request_file(self, key: str, kind: str, client: str = "") -> str:
        """Return the job that creates a file of a finished build, whatever recipe made the build."""
        return self.request_files(key, (kind,), client)

    def request_files(self, key: str, kinds: tuple[str, ...], client: str = "") -> str:
        """Return the job that creates several files of a finished build."""
        return self._requested([key], {"build": key, "kinds": [*kinds]}, client)

    def request_files_of_all(self, keys: Sequence[str], kinds: tuple[str, ...], client: str = "") -> str:
        """Return the job that creates files of several finished builds, in as few processes as possible."""
        return self._requested(keys, {"builds": [*keys], "kinds": [*kinds]}, client)

    def _requested(self, keys: Sequence[str], payload: dict[str, str | list[str]], client: str) -> str:
        def unit(session: Session) -> str:
            renew(session, keys)
            return self.jobs.request(session, BUILD, payload, client)

        return self.jobs.commit(unit)

    def show(self, key: str) -> Build:
        """Return a build with its files and measurements.

        Raises
        ------
        NotFound
            If there is none.
        """
        with self.database.read() as session:
            row = rows.build(session, key)
            if row is None:
                raise NotFound(f"there is no build {key[:80]!r}")
            tolerances = stated_tolerances.of_build(row.measurements, row.parameters)
            return Build(
                **({"tolerances": tolerances} if tolerances else {}),
                build=key,
                model=Version(id=row.model, version=row.version),
                parameters={name: Shown.model_validate(value) for name, value in row.parameters.items()},
                artifacts=rows.artifacts(session, key),
                measurements=measures.measurements(**row.measurements),
            )

    def file(self, key: str, kind: str) -> File | None:
        """Return a file of a build, or None if it does not exist yet."""
        with self.database.read() as session:
            row = rows.artifact(session, key, kind)
        return File(kind, row.sha256) if row else None

    def verify(self, step: bytes) -> Verification:
        """Return the build of a STEP file, the revisions that use it, and whether its bytes are unchanged.

        If the file has validation properties and the build's own file has none, the file is compared with
        the stored copy that has them. The statements in the file besides its shape are read and compared;
        those in a stamp are ignored.

        Raises
        ------
        NotFound
            If the file does not name its build, or there is no such build here.
        ArtifactMissing, ArtifactDamaged
            If the file is not the stored one, and the stored one is lost, so that nothing can be compared.
        """
        header = read_header(step)
        if header is None:
            raise NotFound("this file does not state that it comes from Crankwright")
        build = self.show(header.build)
        assert build.model is not None, "a recorded build has its model"
        with self.database.read() as session:
            uses = [BuildUse.model_validate(use) for use in rows.users_of(session, header.build)]
        kind, sha = self._compared_with(step, header, build.artifacts)
        intact = self._is_intact(step, sha)
        original = step if intact else self.store.read(sha)
        about = {
            "build": header.build,
            "model": build.model,
            "revisions": uses,
            "kind": kind,
            "intact": intact,
        }
        read = statements(original, step)
        return Verification.model_validate({**about, "statements": read} if read else about)

    def _compared_with(self, step: bytes, header: Header, artifacts: Mapping[str, str]) -> tuple[str, str]:
        """Return the kind and hash of the stored file with which a STEP file is compared."""
        part = header.parameters.get(ONLY_PART)
        if part is not None and (alone := with_part("step", part)) in artifacts:
            return "step", artifacts[alone]
        copy = artifacts.get(VALIDATED)
        if copy is not None and is_validated(step) and not is_validated(self.store.read(artifacts["step"])):
            return VALIDATED, copy
        return "step", artifacts["step"]

    def _is_intact(self, step: bytes, sha: str) -> bool:
        """Return whether a file, with or without a stamp, is the artifact with this hash."""
        return hashlib.sha256(step).hexdigest() == sha or is_copy(step, self.store.read(sha))


class ModelBuild:
    """The handler of jobs of the kind `build`, which create a build and the requested files."""

    def __init__(self, builds: Builds, catalogues: Catalogues) -> None:
        self.builds, self.catalogues = builds, catalogues

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Build the model, then derive its files.

        Raises
        ------
        JobFailed
            If the model itself causes an error; the failure contains the problem.
        """
        asked = job.payload
        if "builds" in asked:
            return self._derived_of_all(asked["builds"], asked["kinds"], context)
        if "build" in asked:
            return self._derived(asked["build"], asked["kinds"], context)
        try:
            cls = self.catalogues.models.get(asked["model"], asked["version"])
            shape = cls.from_quantities(asked["parameters"])
            key = build_key(shape)
            self.builds.make(shape, context)
        except FAILURES as error:
            raise JobFailed(error) from error
        return self._derived(key, asked["kinds"], context)

    def _derived_of_all(self, keys: Sequence[str], kinds: Sequence[str], context: JobContext) -> Completion:
        """Derive the files of several builds.

        The error of one build is raised only after the files of all others exist.
        """
        failures: list[JobFailed | JobCrashed] = []
        for number, key in enumerate(keys):
            context.progress(number / len(keys), f"solid {number + 1} of {len(keys)}")
            try:
                self._derived(key, kinds, context)
            except (JobFailed, JobCrashed) as error:
                failures.append(error)
        if failures:
            raise failures[0]
        return lambda session: None

    def _derived(self, key: str, kinds: Iterable[str], context: JobContext) -> Completion:
        try:
            self.builds.restore(key, self.catalogues.models, context)
            for kind in kinds:
                if is_derived(kind):
                    self.builds.derive(key, kind, context)
        except FAILURES as error:
            raise JobFailed(error) from error
        return lambda session: f"/api/v1/builds/{key}"


LONGEST = 200
"""Largest number of letters that an answer quotes from a text, because a client may send any file."""


def statements(original: bytes, step: bytes) -> list[StepStatement]:
    """Return every statement in a build's STEP file, each with the corresponding one in another file.

    Files with equal bytes are read once.
    """
    expected = read_statements(original)
    read = expected if step is original else read_statements(step)
    return [
        StepStatement(
            kind=one.kind[:LONGEST],
            name=one.name[:LONGEST],
            unit=UNITS.get(one.kind),
            expected=_quoted(one.expected),
            stated=_quoted(one.stated),
            agrees=one.agrees,
        )
        for one in compared(expected, read)
    ]


def _quoted(values: tuple[Value, ...] | None) -> list[Value] | None:
    if values is None:
        return None
    return [value[:LONGEST] if isinstance(value, str) else value for value in values[:LONGEST]]
