"""Create builds in a worker process, and store them with their STEP files; create other files on request.

If a file that a row names is missing or damaged, it is rebuilt. Equal rows give equal bytes, so the hash in
the row verifies the result.
"""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager

from sqlalchemy.orm import Session

from app.imported_models.programs import Programs
from app.pool.sources import FileSource, Source, loaded, source_of
from app.solids import measures, rows, stated_tolerances
from app.solids.rows import is_fresh, renew
from app.solids.shapes import built_by_another, shape_of
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import CannotRebuild
from app.workers.base import Runner, may_share
from cad.errors import AnalysisError, GeometryError, ProgramMissing
from cad.export import derive
from cad.file_kinds import DRAWINGS, plain_kind
from cad.imported_models import ImportedModel, ProgramResult, imported_description
from cad.model import CadModel
from cad.regenerate import (
    Build,
    as_quantities,
    as_text,
    build_key,
    made_by,
    regenerate,
    regenerate_class,
    regenerate_shape,
)
from cad.stamp import takes_stamp
from templates.core.catalogue.discovery import Catalogue
from templates.core.progress import report

logger = logging.getLogger(__name__)

STEP = "step"


class Builds:
    """Creates builds in a worker process, and records them with their STEP files."""

    def __init__(self, database: Database, store: Artifacts, programs: Programs | None = None) -> None:
        self.database, self.store, self.programs = database, store, programs

    def make(self, shape: CadModel, context: Runner) -> None:
        """Build a model, unless it is built already and its STEP file is valid.

        Raises
        ------
        GeometryError
            If the kernel fails, or its result differs from what was requested.
        CannotRebuild
            If the build is recorded, its file is lost, and the program now makes a different file.
        DeadlineExceeded, MemoryExceeded, JobCrashed, JobCancelled
            If the process exceeded a limit, crashed or was cancelled.
        """
        row = self._row(build_key(shape), STEP)
        if row and self.store.exists(row.sha256) and self.keep([shape]):
            return
        build = self._built(shape, context)
        if row and hashlib.sha256(build.step).hexdigest() != row.sha256:
            raise _changed(shape, row)
        sha = self.store.put(build.step)
        if row is None:
            self.database.write(lambda session: self._record(session, shape, build, sha))

    def _built(self, shape: CadModel, context: Runner) -> Build:
        """Return the build of a model; for an imported model its program draws it first."""
        source, texts = source_of(type(shape)), as_text(shape)
        if not isinstance(shape, ImportedModel):
            return context.run(build_in_worker, source, texts)
        if self.programs is None:
            raise ProgramMissing(
                "program_missing", f"{shape.id} can be drawn only by the service, not by this command"
            )
        return context.run(build_drawn_in_worker, source, texts, self.programs.draw(shape, context))

    def keep(self, shapes: Iterable[CadModel]) -> bool:
        """Protect builds from deletion while the job that needs them runs; return whether all exist."""
        keys = [build_key(shape) for shape in shapes]
        if not keys:
            return True
        with self.database.read() as session:
            if is_fresh(session, keys):
                return True
        return self.database.write(lambda session: renew(session, keys))

    def restore(self, key: str, catalogue: Catalogue[CadModel], context: Runner) -> None:
        """Restore the STEP file of a recorded build if it is lost; raises as `make` does."""
        row = self._row(key, STEP)
        if row and self.store.exists(row.sha256):
            return
        with self.database.read() as session:
            shape = shape_of(session, catalogue, key)
            if build_key(shape) != key:
                raise built_by_another(session, key, shape)
        self.make(shape, context)

    def derive(self, key: str, kind: str, context: Runner) -> None:
        """Create a file of another kind from the STEP file of a build, unless a valid one exists.

        A drawing of an older program, which has no room for a stamp, is drawn again.

        A derived file depends on libraries that the build's key does not name. If its bytes now differ, it
        is another artifact, and the row then names that one, unless a signed revision uses the build.

        Raises
        ------
        CannotRebuild
            If the bytes differ from those that were signed.
        """
        row, step = self._row(key, kind), self._row(key, STEP)
        if row and self.store.exists(row.sha256) and not self._is_outdated(row):
            return
        assert step is not None, "a build has its STEP file from its first moment"
        file = context.run(derive, self.store.read(step.sha256), kind)
        sha = self.store.put(file)
        if row and row.sha256 != sha:
            with self.database.read() as session:
                if rows.is_signed(session, key):
                    raise _signed_otherwise(row)
            logger.warning("%s of build %s: artifact %s was replaced by %s", kind, key, row.sha256, sha)
        if row is None or row.sha256 != sha:
            self.database.write(lambda session: rows.add_artifact(session, key, kind, sha, len(file)))

    def _is_outdated(self, row: rows.Artifact) -> bool:
        kind = plain_kind(row.kind)
        return kind in DRAWINGS and not takes_stamp(self.store.read(row.sha256), kind)

    def _row(self, key: str, kind: str) -> rows.Artifact | None:
        with self.database.read() as session:
            return rows.artifact(session, key, kind)

    def _record(self, session: Session, shape: CadModel, build: Build, sha: str) -> None:
        parameters = as_quantities(shape)
        units = {name: declared.meaning.unit for name, declared in shape.inputs.items()}
        dimensions = {n: {"value": value, "unit": units[n]} for n, value in build.dimensions.items()}
        measured: dict[str, object] = {
            "measures": build.measures,
            "dimensions": dimensions,
            "materials": build.materials,
            stated_tolerances.MEMBER: stated_tolerances.recorded(build.tolerances),
        }
        if described := imported_description(type(shape)):
            measured["trust"] = described.trust
        if build.clearances:
            measured["clearances"] = [measures.clearance(one).plain() for one in build.clearances]
        rows.add_build(
            session, build.key, build.model, build.version, parameters, measured, made_by(type(shape))
        )
        rows.add_artifact(session, build.key, STEP, sha, len(build.step))


def _changed(shape: CadModel, row: rows.Artifact) -> CannotRebuild:
    detail = (
        f"the STEP file of build {row.build_key} is lost, and model {shape.id} version {shape.version} now "
        "gives different bytes because its file was changed. Put the old file back, or restore artifact "
        f"{row.sha256} from a backup"
    )
    return CannotRebuild("model_changed", detail)


def _signed_otherwise(row: rows.Artifact) -> CannotRebuild:
    detail = (
        f"file {row.kind} of build {row.build_key} is lost, and a new one has other bytes: libraries have "
        f"changed since. A signed revision has artifact {row.sha256}: restore it from a backup"
    )
    return CannotRebuild("signed_otherwise", detail)


@may_share(lambda source, texts: isinstance(source, FileSource) and not source.digest)
def build_in_worker(source: Source, texts: Mapping[str, str]) -> Build:
    """Return the result of `cad.regenerate.regenerate_class`, and report progress to the job.

    This runs in the worker's process. After a built-in model the process may build for another job, but
    never after a team's own code.
    """
    cls = loaded(source)
    assert issubclass(cls, CadModel), "the source is that of a model"
    return regenerate_class(cls, texts, report=report)


def build_drawn_in_worker(source: Source, texts: Mapping[str, str], drawn: ProgramResult) -> Build:
    """Return the build of a model that a program drew, checked like any other.

    This runs in the worker's process.
    """
    shape = loaded(source).from_quantities(texts)
    assert isinstance(shape, ImportedModel), "the source is that of an imported model"
    shape.take(drawn)
    return regenerate_shape(shape, texts, report=report)


def rehearse(called: Callable[[], bool]) -> None:
    """Build a small solid in an idle worker process, because a process's first build takes twice as long.

    Raises
    ------
    InterruptedError
        Between two steps, once the process receives its job; the kernel may turn this into a GeometryError.
    """

    def give_way(_done: float, _what: str) -> None:
        if called():
            raise InterruptedError

    regenerate("ball_bearing", 1, {"inner_diameter": 0.05}, report=give_way)


@contextmanager
def failures_named(model: str, analysis: str = "") -> Iterator[None]:
    """Add the name of the design's model to errors of its geometry, and of the analysis to its errors."""
    try:
        yield
    except GeometryError as error:
        names = (f"{model}.{parameter}" for parameter in error.parameters)
        raise GeometryError(error.code, f"{model}: {error.detail}", names) from error
    except AnalysisError as error:
        name = f"{model}.{analysis}"
        raise AnalysisError(error.code, f"{name}: {error.detail}", name) from error
