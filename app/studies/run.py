"""The job of a study: calculate its chunks in the pool, store and record them, then conclude the method.

A chunk's bytes are stored before its database row is written, in one transaction. So after a crash the rows
show which chunks are missing, and these are recalculated to the same bytes.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import wait
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs import repository as designs
from app.designs.document import Document
from app.jobs.service import Completion, Job, JobContext, JobFailed, JobRests, Jobs
from app.plain import JsonObject
from app.pool.pool import Calculation, CalculationPool
from app.pool.steps import Steps
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing, CannotRebuild
from app.storage.tables import StudyChunkRow, StudyRow
from app.studies import repository
from app.studies.archive import Archive
from app.studies.chunks import Chunk, PendingSolids, calculated, explored
from app.studies.front import MOST_FRONT
from app.studies.plan import Plan
from app.studies.row_columns import StoredRows
from app.studies.schemas import StudyResult
from app.studies.solid_count import MOST_SOLIDS, NEEDS_SOLIDS
from app.studies.solids import SolidPool, StudySolids
from app.studies.task import Task
from app.studies.variant import document_of
from app.workers.errors import DeadlineExceeded, JobCancelled, MemoryExceeded
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs, TemplateError

logger = logging.getLogger(__name__)

STUDY = "study"
"""The kind of the jobs of studies, and their lane."""
LANES = {STUDY: 4}
"""Number of threads that wait for chunks, which is the number of studies that take turns in the pool."""
GLANCE = 0.05  # interval at which a thread checks whether its study was cancelled [s]
SHIFT = 5.0  # time slice after which a study lets waiting studies go first [s]
MOST_HEALED = 3  # largest number of times that a running study recalculates lost rows
FAILURES = (
    TemplateError,
    DeadlineExceeded,
    MemoryExceeded,
    CannotRebuild,
    ArtifactMissing,
    ArtifactDamaged,
)
"""Errors that the study itself causes, and rows that were lost while it ran."""

Started = Callable[[int], Calculation]
"""Submits the chunk with a given number."""


@dataclass(frozen=True)
class StudyServices:
    """The services that a run uses."""

    database: Database
    store: Artifacts
    catalogues: Catalogues
    pool: CalculationPool
    jobs: Jobs
    steps: Steps
    solids: SolidPool


class Run:
    """A study that a job is calculating."""

    def __init__(
        self,
        services: StudyServices,
        row: StudyRow,
        task: Task,
        solids: StudySolids,
        job: Job,
        context: JobContext,
    ) -> None:
        self.services, self.row, self.task, self.solids = services, row, task, solids
        self.plan = Plan.of(row.plan)
        self.job, self.context = job, context
        self._since = time.monotonic()

    @property
    def criteria(self) -> tuple[str, ...]:
        """Return the criteria to judge."""
        return tuple(self.plan.criteria)

    def chunks(self, until: int | None = None) -> list[StudyChunkRow]:
        """Return the calculated chunks with numbers below `until`."""
        with self.services.database.read() as session:
            chunks = repository.chunks(session, self.row.id)
        return chunks if until is None else [chunk for chunk in chunks if chunk.number < until]

    def stored(self, until: int | None = None) -> StoredRows:
        """Return the rows of the chunks with numbers below `until`."""
        return StoredRows(self.services.store, self.chunks(until))

    def submit(self, function: Callable[..., object], *args: object) -> Calculation:
        """Submit a calculation for this study to the pool."""
        return self.services.pool.submit(f"study:{self.row.id}", function, *args, lane="jobs")

    def result_of(self, calculation: Calculation) -> object:
        """Return the result of a calculation; raise JobCancelled if the study is cancelled."""
        while not wait([calculation.future], GLANCE).done:
            if self.context.is_cancelled:
                self.services.pool.cancel(calculation)
        result: object = calculation.future.result()
        return result

    def explore(self) -> None:
        """Calculate all rows that the method fixes in advance."""
        given = self._given()

        def started(number: int) -> Calculation:
            first = number * self.plan.chunk
            last = min(first + self.plan.chunk, self.plan.rows)
            levels, criteria, solids = self.plan.levels, self.criteria, self.solids.measured
            if given is not None:
                return self.submit(calculated, self.task, given[first:last], levels, criteria, solids)
            return self.submit(explored, self.task, first, last, levels, criteria, solids)

        self._all(range(self.plan.chunks), started)

    def confirm(self, rows: Array) -> None:
        """Recalculate rows at the levels of `confirm`, in chunks that follow those of the exploration."""
        levels, size = self.plan.confirm or self.plan.levels, self.plan.confirm_chunk

        def started(number: int) -> Calculation:
            first = (number - self.plan.chunks) * size
            part, solids = rows[first : first + size], self.solids.measured
            return self.submit(calculated, self.task, part, levels, self.criteria, solids)

        self._all(range(self.plan.chunks, self.plan.chunks - (-len(rows) // size)), started)

    def _all(self, numbers: Iterable[int], started: Started) -> None:
        """Calculate missing chunks, several at a time, and store each when it is finished."""
        there = {chunk.number for chunk in self.chunks()}
        waiting: deque[tuple[int, Calculation]] = deque()
        try:
            for number in numbers:
                if number in there:
                    continue
                waiting.append((number, started(number)))
                if len(waiting) > self.services.pool.most_jobs:
                    self._keep_first(waiting, started)
                    self._rest(waiting, started)
            while waiting:
                self._keep_first(waiting, started)
        finally:
            for _, calculation in waiting:
                self.services.pool.cancel(calculation)

    def _keep_first(self, waiting: deque[tuple[int, Calculation]], started: Started) -> None:
        """Store the first chunk, after building the solids of its rows."""
        number, calculation = waiting[0]
        while isinstance(answer := self.result_of(calculation), PendingSolids):
            self._build(answer)
            calculation = started(number)
            waiting[0] = number, calculation
        waiting.popleft()
        assert isinstance(answer, Chunk)
        self.keep(number, answer)

    def _build(self, lacking: PendingSolids) -> None:
        """Build the solids that rows need, one by one.

        Raises
        ------
        InvalidInputs
            If there are more than were counted, because rows confirmed at finer levels have other solids.
        """
        for wanting in lacking.solids:
            if self.solids.is_known(wanting):
                continue
            if len(self.solids.measured) >= MOST_SOLIDS + MOST_FRONT:
                detail = f"confirmed rows need further solids, in total more than {MOST_FRONT}"
                raise InvalidInputs([Fault("confirm", NEEDS_SOLIDS, detail)])
            self._report()
            self.rest_if_due()
            self.solids.make(wanting)
        self._report()

    def keep(self, number: int, chunk: Chunk) -> None:
        """Store a chunk, then record it.

        Raises
        ------
        JobCancelled
            If the study no longer runs.
        """
        row = StudyChunkRow(
            study_id=self.row.id,
            number=number,
            state="done",
            attempt=self.job.attempt,
            rows=chunk.rows,
            refused=chunk.refused,
            sha256=self.services.store.put(*chunk.content),
        )
        size = len(chunk.content)
        if not self.services.database.write(lambda session: repository.keep_chunk(session, row, size)):
            raise JobCancelled
        self._report()

    def _report(self) -> None:
        with self.services.database.read() as session:
            done = repository.done(session, self.row.id, self.plan.chunks).rows
        solids = len(self.solids.measured)
        words = f"solids {solids} of {max(solids, self.plan.solids)}, " if self.plan.solids else ""
        self.context.progress(self.plan.share(done, solids), f"{words}{done} rows are calculated")

    def _rest(self, waiting: deque[tuple[int, Calculation]], started: Started) -> None:
        """Store the running calculations, then let other studies go first if the time slice is over."""
        if self._is_due():
            while waiting:
                self._keep_first(waiting, started)
            raise JobRests

    def rest_if_due(self) -> None:
        """Raise JobRests if the time slice is over and another study waits."""
        if self._is_due():
            raise JobRests

    def _is_due(self) -> bool:
        return time.monotonic() - self._since > SHIFT and self.services.jobs.others_wait(STUDY)

    def _given(self) -> Array | None:
        """Return the rows [SI] of a table that the user gave, else None."""
        if self.row.table_sha256 is None:
            return None
        try:
            with Archive(self.services.store.open(self.row.table_sha256).file) as archive:
                return archive["rows"].astype(np.float64)
        except (ArtifactMissing, ArtifactDamaged) as error:
            detail = "the rows of the table were lost; start the study again"
            raise CannotRebuild("answer_lost", detail) from error


R = TypeVar("R", bound=Run)
Conclude = Callable[[Run], StudyResult]
"""Calculates the rows of a study and returns the result of its method."""
Heal = Callable[[str, Job, JobContext], None]
"""Recalculates the lost chunks of a study."""


class StudyRunner:
    """Handles the jobs of studies."""

    def __init__(self, services: StudyServices, conclude: Conclude, heal: Heal) -> None:
        self.services, self._conclude, self._heal = services, conclude, heal

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Calculate the remaining rows of a study, and conclude it.

        Raises
        ------
        JobFailed
            If the study itself causes an error; the failure contains the problem.
        JobRests
            If another study waits for the thread.
        """
        id: str = job.payload["study"]
        if not self.services.database.write(lambda session: repository.begin(session, id)):
            raise JobCancelled
        try:
            result = self._concluded(id, job, context).plain()
        except FAILURES as error:
            raise JobFailed(error) from error

        def completion(session: Session) -> str:
            repository.end(session, id, "done", result, None)
            return f"/api/v1/studies/{id}"

        return completion

    def _concluded(self, id: str, job: Job, context: JobContext) -> StudyResult:
        """Return the result; if chunks turn out to be lost or damaged, recalculate them first."""
        for _ in range(MOST_HEALED):
            try:
                return self._conclude(run_of(self.services, id, job, context, Run))
            except (ArtifactMissing, ArtifactDamaged) as error:
                logger.warning("study %s calculates its lost rows again: %s", id, error)
                self._heal(id, job, context)
        return self._conclude(run_of(self.services, id, job, context, Run))

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """Record why a study failed, or that it was cancelled, in the transaction that ends its job."""
        cancelled = str(problem.get("type", "")).endswith("/cancelled")
        state = "cancelled" if cancelled else "failed"
        repository.end(session, job.payload["study"], state, None, problem)


def run_of(services: StudyServices, id: str, job: Job, context: JobContext, kind: type[R]) -> R:
    """Return the run of a stored study for a job."""
    with services.database.read() as session:
        row = repository.get(session, id)
        whole = designs.document(session, row.design_id, row.revision)
    document = document_of(whole, row.body.get("variant"))
    plan = Plan.of(row.plan)
    task = Task.of(document, row.body, plan.places, plan.measured, services.catalogues)
    solids = services.solids.of(Document.model_validate(document), services.catalogues, context)
    return kind(services, row, task, solids, job, context)
