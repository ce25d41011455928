"""Import models by jobs: store the file by its hash, examine it, and create a version of a model from it."""

from __future__ import annotations

from functools import partial
from typing import Literal

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.imported_models import repository
from app.imported_models.assemblies import described_assembly
from app.imported_models.assembly_manifest import is_assembly
from app.imported_models.assembly_manifest import read as read_assembly
from app.imported_models.creo.manifest import read
from app.imported_models.descriptions import described_creo, described_freecad, described_step
from app.imported_models.errors import ModelIdTaken
from app.imported_models.names import require_free
from app.imported_models.programs import Programs
from app.imported_models.registry import ImportedModelRegistry
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.jobs.uploads import last_name, queue_upload
from app.storage.artifacts import Artifacts
from app.storage.database import Database, after_commit
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.storage.idempotency import Once
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded
from cad.errors import GeometryError, ProgramMissing, UnreadableModel, UnreadableStep
from cad.examination import examine
from cad.imported_models import Description
from cad.model_classes import class_of
from templates.core.errors import TemplateError

IMPORT = "model_import"
MOST_MANIFEST = 2**20  # bytes
Kind = Literal["freecad", "creo", "step", "assembly"]
FAILURES = (
    UnreadableModel, UnreadableStep, GeometryError, ModelIdTaken, TemplateError, DeadlineExceeded,
    MemoryExceeded, JobCrashed, ArtifactMissing, ArtifactDamaged,
)  # fmt: skip
"""Errors that are caused by a file."""


class ModelImports:
    """Queues imports of models, and handles the jobs that run them.

    A failed import leaves only its file, which retention deletes.
    """

    def __init__(
        self,
        database: Database,
        store: Artifacts,
        jobs: Jobs,
        catalogues: Catalogues,
        programs: Programs,
        registry: ImportedModelRegistry,
    ) -> None:
        self.database, self.store, self.jobs, self.catalogues = database, store, jobs, catalogues
        self.programs, self.registry = programs, registry

    def begin(self, content: memoryview, id: str, file: str, once: Once) -> str:
        """Queue the import of a file as a model, and return the id of the job.

        Raises
        ------
        UnreadableModel
            If the file is empty, or of an unsupported kind.
        ProgramMissing
            If the program that draws it is missing.
        ModelIdTaken, InvalidInputs
            If an imported model cannot have this id.
        QueueFull
            If too many jobs are waiting.
        """
        require_free(id, self.catalogues)
        kind = kind_of(content)
        if kind == "freecad":
            self.programs.freecad.warm.find()
        if kind == "creo":
            read(bytes(content))
        if kind == "assembly":
            read_assembly(bytes(content))
        about = {"id": id, "name": last_name(file) or "model", "kind": kind}
        return queue_upload(self.jobs, self.store, IMPORT, content, about, once)

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Import the file of a job; the job's result is the version of the model.

        Raises
        ------
        JobFailed
            If the file is refused, or the id was taken in the meantime.
        """
        id, sha, name, kind = (job.payload[key] for key in ("id", "file", "name", "kind"))
        try:
            described = self._described(kind, self.store.read(sha), id, name, context)
            class_of(described.text, id, 1)  # check that it can be published
            require_free(id, self.catalogues)
        except FAILURES as error:
            raise JobFailed(error) from error

        def completion(session: Session) -> str:
            number = repository.add(session, id, described, sha)
            after_commit(session, self.registry.look)
            return f"/api/v1/models/{id}/versions/{number}"

        return completion

    def available(self) -> tuple[str | None, str | None]:
        """Return the reason for which FreeCAD cannot draw here, or None; and the folder of FreeCAD."""
        try:
            return None, self.programs.freecad.warm.find().modules
        except ProgramMissing as error:
            return str(error), None

    def _described(self, kind: Kind, content: bytes, id: str, name: str, context: JobContext) -> Description:
        if kind == "assembly":
            about = self.database, self.store, self.catalogues
            return described_assembly(content, id, name, *about, partial(self._build, context))
        if kind == "step":
            return described_step(content, id, name, self.store, context)
        if kind == "creo":
            return described_creo(content, id, name, self.store, self.programs, context)
        return described_freecad(content, id, name, self.store, self.programs, context)

    def _build(self, context: JobContext, id: str, described: Description) -> bytes:
        """Return the STEP file of an imported model with the values of its file; raises as `examine` does."""
        context.progress(0.1, f"drawing {id}")
        drawn = self.programs.drawn(described, {}, context.cancelled)
        return context.run(examine, described.text, id, drawn).step


def kind_of(content: memoryview) -> Kind:
    """Return the kind of a file, judged by its first bytes.

    Raises
    ------
    UnreadableModel
        If the kind is not supported.
    """
    head = bytes(content[:200])
    if head.startswith(b"PK\x03\x04"):
        return "freecad"
    if head.lstrip().startswith(b"ISO-10303-21"):
        return "step"
    if head.lstrip().startswith(b"{"):
        if len(content) > MOST_MANIFEST:
            raise UnreadableModel("too_large", f"a manifest may have {MOST_MANIFEST // 2**20} MiB at most")
        return "assembly" if is_assembly(bytes(content)) else "creo"
    what = "the body is empty" if not content else "it begins as no model does"
    raise UnreadableModel(
        "not_a_model",
        f"{what}: send a FreeCAD file (.FCStd), a STEP file (ISO 10303-21), or a JSON manifest of a Creo "
        "model or an assembly",
    )
