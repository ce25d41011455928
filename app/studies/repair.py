"""Repair chunks whose artifacts are lost or damaged: a job calculates them again, to the same bytes.

A separate job does this for rows that a client reads; a running study repairs its own rows within its job.

The repair repeats the study from the chunks that are left until all recorded chunks exist again, and then
stops: a cancelled study gets no new rows, and nothing is evaluated or built twice.
"""

from __future__ import annotations

import threading
from collections import OrderedDict

from app.jobs.errors import JobFailed
from app.jobs.service import Completion, Job, JobContext
from app.plain import JsonObject
from app.storage.errors import CannotRebuild
from app.storage.tables import StudyChunkRow
from app.studies.chunks import Chunk
from app.studies.errors import RowsLost
from app.studies.run import FAILURES, STUDY, Conclude, Run, StudyServices, run_of

AGAIN = "study-again"
"""The kind of the jobs that calculate lost chunks again; they wait in the lane of studies."""
REMEMBERED = 1000  # studies whose rows cannot be calculated again


class _Whole(Exception):
    """All recorded chunks are there."""


class _Repetition(Run):
    """A study that is repeated for the chunks that it has lost."""

    def chunks(self, until: int | None = None) -> list[StudyChunkRow]:
        """Return the chunks that are there; of a search those before the first that is lost."""
        kept = []
        for chunk in super().chunks(until):
            if self.services.store.exists(chunk.sha256):
                kept.append(chunk)
            elif self.plan.searched:
                break
        return kept

    def keep(self, number: int, chunk: Chunk) -> None:
        """Store a chunk again.

        Raises
        ------
        CannotRebuild
            It has other bytes now.
        _Whole
            It was the last that was lost.
        """
        recorded = {row.number: row for row in super().chunks()}
        if number in recorded and self.services.store.put(*chunk.content) != recorded[number].sha256:
            detail = (
                f"rows of study {self.row.id} are lost. They have other values now, because libraries or "
                "templates have changed since: start the study again with the same body and seed"
            )
            raise CannotRebuild("other_bytes", detail)
        self.finish_if_whole()

    def finish_if_whole(self) -> None:
        """Raise _Whole if no recorded chunk is lost."""
        if len(self.chunks()) == len(super().chunks()):
            raise _Whole


class ChunkRepair:
    """The handler of the jobs that calculate lost chunks again."""

    def __init__(self, services: StudyServices, conclude: Conclude) -> None:
        self._services, self._conclude = services, conclude
        self._refused: OrderedDict[str, CannotRebuild] = OrderedDict()
        self._lock = threading.Lock()
        services.jobs.register(AGAIN, self, lane=STUDY)

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Repeat a study until all its recorded chunks are there."""
        id: str = job.payload["study"]
        try:
            self.heal(id, job, context)
        except FAILURES as error:
            self._refuse(id, error)
            raise JobFailed(error) from error
        return lambda session: f"/api/v1/studies/{id}"

    def heal(self, id: str, job: Job, context: JobContext) -> None:
        """Repeat a study until all its recorded chunks are there; raises what its design brings about."""
        run = run_of(self._services, id, job, context, _Repetition)
        try:
            run.finish_if_whole()
            self._conclude(run)
        except _Whole:
            pass

    def lost(self, id: str) -> Exception:
        """Return the error to raise when rows of a study are lost.

        Where they are calculated again, or why not.
        """
        with self._lock:
            if refused := self._refused.get(id):
                return refused
        payload: JsonObject = {"study": id}
        jobs = self._services.jobs
        return RowsLost(id, jobs.commit(lambda session: jobs.request(session, AGAIN, payload), AGAIN))

    def _refuse(self, id: str, error: Exception) -> None:
        """Remember why rows cannot be calculated again: nothing but a new start of the service helps."""
        if not isinstance(error, CannotRebuild):
            return
        with self._lock:
            self._refused[id] = error
            while len(self._refused) > REMEMBERED:
                self._refused.popitem(last=False)
