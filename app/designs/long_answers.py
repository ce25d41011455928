"""Long answers: a job goes on when the caller stops waiting, and stores the answer."""

from __future__ import annotations

from abc import ABC, abstractmethod

from pydantic_core import from_json, to_json
from sqlalchemy.orm import Session

from app.calculations.jobs import place_of_answer
from app.calculations.steps import Steps, begun_steps, calling
from app.catalogue.catalogues import Catalogues
from app.designs.errors import DesignError
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.plain import Json, JsonObject
from app.schemas.answers import Answer
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import NotFound
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from templates.core.errors import TemplateError

FAILURES = (TemplateError, DesignError, NotFound, DeadlineExceeded, MemoryExceeded)
"""What the request itself brings about."""


class LongAnswers(ABC):
    """Makes jobs of one kind, and is the handler of such jobs."""

    kind: str

    def __init__(
        self, database: Database, catalogues: Catalogues, store: Artifacts, jobs: Jobs, steps: Steps
    ) -> None:
        self.database, self.catalogues, self.store = database, catalogues, store
        self.jobs, self.steps = jobs, steps

    @abstractmethod
    def calculated(self, payload: JsonObject, body: Json) -> Answer:
        """Return the whole answer to what a job holds."""

    def queued(self, payload: JsonObject, body: object, client: str) -> str:
        """Return the id of a new job; it takes over the steps that this request has begun."""
        whole = {**payload, "body": self.store.put(to_json(body))}
        begun = begun_steps()

        def unit_of_work(session: Session) -> str:
            id = self.jobs.enqueue(session, self.kind, whole, client=client)
            if begun is not None:
                begun.leave_to(id)
            return id

        job = self.database.write(unit_of_work)
        self.jobs.wake()
        return job

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Calculate the whole answer, and keep it.

        Raises
        ------
        JobFailed
            With the problem, for anything that the request itself brings about.
        """
        payload = dict(job.payload)
        body = from_json(self.store.read(payload.pop("body")))
        try:
            with calling(self.steps, job, context, f"job:{job.id}", "jobs"):
                answer = self.calculated(payload, body)
        except FAILURES as error:
            raise JobFailed(error) from error
        content = answer.model_dump_json(by_alias=True, exclude_unset=True).encode()
        place = place_of_answer(job.id, self.store.put(content))
        return lambda session: place

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """End what was left to a job that was cancelled before it began."""
        self.steps.drop(job.id)
