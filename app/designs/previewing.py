"""Previews of changes: answered whole, or as far as they are known while a job calculates the rest."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic_core import from_json, to_json
from sqlalchemy.orm import Session

from app.calculations.begun import Begun
from app.calculations.jobs import PREVIEW, place_of_answer
from app.calculations.steps import Steps, begun_steps, calling
from app.catalogue.catalogues import Catalogues
from app.designs.errors import DesignError
from app.designs.preview import preview
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.plain import JsonObject
from app.presentation.units import System
from app.schemas.designs import Preview
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.storage.errors import NotFound
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from templates.core.errors import TemplateError

FAILURES = (TemplateError, DesignError, NotFound, DeadlineExceeded, MemoryExceeded)
"""What the change itself brings about."""


@dataclass(frozen=True)
class Change:
    """A change that is to be previewed, and how."""

    design: str
    patch: JsonObject
    worksheet: bool
    system: System


class Previews:
    """Makes previews, and jobs of those that take long, and is the handler of such jobs."""

    def __init__(
        self, database: Database, catalogues: Catalogues, store: ArtifactStore, jobs: Jobs, steps: Steps
    ) -> None:
        self.database, self.catalogues, self.store = database, catalogues, store
        self.jobs, self.steps = jobs, steps

    def known(self, change: Change) -> Preview:
        """The preview as far as its caller waits for it."""
        return preview(self.database, self.catalogues, **vars(change)).content

    def answer(self, change: Change, client: str) -> tuple[Preview, str | None]:
        """The preview as far as its caller waits for it, and the job that calculates the rest, if any.

        Raises
        ------
        InvalidInputs
            With everything that is wrong as far as it is known.
        QueueFull
            Too many calculations, or jobs, are waiting.
        """
        previewed = preview(self.database, self.catalogues, **vars(change))
        if previewed.is_whole:
            return previewed.content, None
        payload = {
            "design": change.design,
            "revision": previewed.content.revision,
            "worksheet": change.worksheet,
            "system": change.system,
            "body": self.store.put(to_json(change.patch)),
        }
        return previewed.content, self._queued(payload, client, begun_steps())

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Make the whole preview, and keep it.

        Raises
        ------
        JobFailed
            With the problem, for anything that the change itself brings about.
        """
        asked = dict(job.payload)
        asked["patch"] = from_json(self.store.read(asked.pop("body")))
        try:
            with calling(self.steps, job, context, f"job:{job.id}", "jobs"):
                previewed = preview(self.database, self.catalogues, **asked)
        except FAILURES as error:
            raise JobFailed(error) from error
        place = place_of_answer(
            job.id,
            self.store.put(previewed.content.model_dump_json(by_alias=True, exclude_unset=True).encode()),
        )
        return lambda session: place

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """End what was left to a job that was cancelled before it began."""
        self.steps.drop(job.id)

    def _queued(self, payload: JsonObject, client: str, begun: Begun | None) -> str:
        def unit(session: Session) -> str:
            id = self.jobs.enqueue(session, PREVIEW, payload, client=client)
            if begun is not None:
                begun.leave_to(id)
            return id

        job = self.database.write(unit)
        self.jobs.wake()
        return job
