"""Calculations as jobs: what is still running when nobody waits for it any longer, or was never waited for.

The body and the answer are artifacts; the row names them by their hashes. A calculation that runs when it
becomes a job goes on in its process, if the lane of jobs has room; else it is calculated again in its turn.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import wait

from sqlalchemy.orm import Session

from app.calculations.errors import InvalidBody, NoArray, TooManyValues
from app.calculations.operations import Question, answered
from app.catalogue.catalogues import Catalogues
from app.jobs import repository
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.plain import Json, JsonObject
from app.pool.pool import Calculation, CalculationPool
from app.pool.sources import source_of
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing, CannotRebuild
from app.workers.pieces import Pieces
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
from templates.core.language.template import Template

CALCULATION, PREVIEW, DECISION = "calculation", "preview", "decision"
TOLERANCE, SOLUTION, IMPACT, VARIANT = "tolerance", "solution", "impact", "variant"
ANSWERS = (CALCULATION, PREVIEW, DECISION, TOLERANCE, SOLUTION, IMPACT, VARIANT)
"""Kinds of jobs whose result is an answer: what a request asked for, and nobody waited for."""
GLANCE = 0.1  # how often a thread looks whether its job was cancelled [s]
AGAIN = "again"  # in a payload: the job whose lost answer is calculated again
FAILURES = (TemplateError, TooManyValues, InvalidBody, NoArray, CannotRebuild)
"""What the request itself, or the loss of it, brings about."""


def question_of(payload: Mapping[str, Json], store: Artifacts) -> Question:
    """Return the question that the row of a job names; raises ArtifactMissing, ArtifactDamaged."""
    fields = {name: part for name, part in payload.items() if name != AGAIN}
    return Question(**{**fields, "body": Pieces.of(store.read(payload["body"]))})


def _lost(job: Job) -> CannotRebuild:
    detail = f"the request of job {job.id} was lost. Send the calculation again, or restore a backup"
    return CannotRebuild("answer_lost", detail)


class CalculationJobs:
    """Makes jobs of calculations, and is the handler of such jobs."""

    def __init__(
        self,
        pool: CalculationPool,
        catalogues: Catalogues,
        database: Database,
        store: Artifacts,
        jobs: Jobs,
    ) -> None:
        self.pool, self.catalogues = pool, catalogues
        self.database, self.store, self.jobs = database, store, jobs
        self._adopted: dict[str, Calculation] = {}  # by job

    @property
    def catalogue(self) -> Catalogue[Template]:
        """Return the templates, as they are now."""
        return self.catalogues.templates

    def create(self, question: Question, client: str, running: Calculation | None = None) -> str:
        """Queue a job for a question, which adopts the calculation that runs already, if there is one.

        Raises
        ------
        QueueFull
            Too many jobs are waiting; the calculation is ended.
        """
        is_kept = running is not None and self.pool.keep(running)
        if running is not None and not is_kept:
            self.pool.cancel(running)
        payload = {**vars(question), "body": self.store.put(*question.body)}
        if question.form == "json":
            del payload["form"]  # a server of the version before takes the job as well

        def unit(session: Session) -> str:
            id = self.jobs.enqueue(session, CALCULATION, payload, client=client)
            if running is not None and is_kept:
                self._adopted[id] = running  # before the job can be claimed
            return id

        try:
            job = self.database.write(unit)
        except BaseException:
            if running is not None:
                self.pool.cancel(running)
            raise
        self.jobs.wake()
        return job

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Follow the calculation of a job to its end, and keep its answer.

        Raises
        ------
        JobFailed
            With the problem, for anything that the request itself brings about.
        """
        try:
            calculation = self._adopted.pop(job.id, None) or self._submitted(job)
            calculation.listen(context.progress)
            answer = self._outcome(calculation, context)
        except FAILURES as error:
            raise JobFailed(error) from error
        lost = job.payload.get(AGAIN)  # the job whose answer this is
        link = place_of_answer(lost or job.id, self.store.put(*answer))

        def unit(session: Session) -> str:
            if lost:
                repository.set_result(session, lost, link)
            return link

        return unit

    def request_again(self, job: Job, client: str) -> str:
        """Return the job that calculates the lost answer of another one again.

        Raises
        ------
        CannotRebuild
            The request that the job was made of is lost as well.
        QueueFull
            Too many jobs are waiting.
        """
        if job.kind != CALCULATION or not self.store.exists(job.payload["body"]):
            raise _lost(job)
        payload = {**job.payload, AGAIN: job.id}
        again = self.database.write(lambda session: self.jobs.request(session, CALCULATION, payload, client))
        self.jobs.wake()
        return again

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """End the calculation of a job that was cancelled before anybody followed it."""
        if calculation := self._adopted.pop(job.id, None):
            self.pool.cancel(calculation)

    def _submitted(self, job: Job) -> Calculation:
        """Return the calculation of a job from its row, as after a start of the server."""
        try:
            question = question_of(job.payload, self.store)
        except (ArtifactMissing, ArtifactDamaged) as error:
            raise _lost(job) from error
        cls = self.catalogues.to_try(question.template, question.version)
        return self.pool.submit(f"job:{job.id}", answered, source_of(cls), question, lane="jobs")

    def _outcome(self, calculation: Calculation, context: JobContext) -> Pieces:
        while not wait([calculation.future], GLANCE).done:
            if context.is_cancelled:
                self.pool.cancel(calculation)
        answer: Pieces = calculation.future.result()
        return answer


def place_of_answer(job: str, sha: str) -> str:
    """Return the address at which the answer of a job is read."""
    return f"/api/v1/evaluations/{job}?sha256={sha}"
