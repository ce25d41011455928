"""Repair chunks whose artifacts are lost or damaged: a job recalculates them to the same bytes.

A separate job does this if a client reads the rows; a running study repairs its own rows within its job.

The repair repeats the study from the remaining chunks until all recorded chunks exist again, and then stops:
a cancelled study gets no new rows, and nothing is evaluated or built twice.
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
"""The kind of the jobs that recalculate lost chunks; they wait in the lane of studies."""
REMEMBERED = 1000  # number of remembered studies whose rows cannot be restored


class _Whole(Exception):
    """Raised once all recorded chunks exist."""


class _Repetition(Run):
    """A repeated run of a study that restores its lost chunks."""

    def chunks(self, until: int | None = None) -> list[StudyChunkRow]:
        """Return the chunks that exist; for a search, only those before the first lost one."""
        kept = []
        for chunk in super().chunks(until):
            if self.services.store.exists(chunk.sha256):
                kept.append(chunk)
            elif self.plan.searched:
                break
        return kept

    def keep(self, number: int, chunk: Chunk) -> None:
        """Store a recalculated chunk.

        Raises
        ------
        CannotRebuild
            If its bytes differ from the recorded ones.
        _Whole
            If it was the last lost chunk.
        """
        recorded = {row.number: row for row in super().chunks()}
        if number in recorded and self.services.store.put(*chunk.content) != recorded[number].sha256:
            detail = (
                f"rows of study {self.row.id} are lost. Their values have changed, because libraries or "
                "templates have changed since: start the study again with the same body and seed"
            )
            raise CannotRebuild("other_bytes", detail)
        self.finish_if_whole()

    def finish_if_whole(self) -> None:
        """Raise _Whole if no recorded chunk is lost."""
        if len(self.chunks()) == len(super().chunks()):
            raise _Whole


class ChunkRepair:
    """Handles the jobs that recalculate lost chunks."""

    def __init__(self, services: StudyServices, conclude: Conclude) -> None:
        self._services, self._conclude = services, conclude
        self._refused: OrderedDict[str, CannotRebuild] = OrderedDict()
        self._lock = threading.Lock()
        services.jobs.register(AGAIN, self, lane=STUDY)

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Repeat a study until all its recorded chunks exist."""
        id: str = job.payload["study"]
        try:
            self.heal(id, job, context)
        except FAILURES as error:
            self._refuse(id, error)
            raise JobFailed(error) from error
        return lambda session: f"/api/v1/studies/{id}"

    def heal(self, id: str, job: Job, context: JobContext) -> None:
        """Repeat a study until all its recorded chunks exist; raise the errors that its design causes."""
        run = run_of(self._services, id, job, context, _Repetition)
        try:
            run.finish_if_whole()
            self._conclude(run)
        except _Whole:
            pass

    def lost(self, id: str) -> Exception:
        """Return the error to raise if rows of a study are lost.

        It names the job that recalculates them, or the reason why they cannot be restored.
        """
        with self._lock:
            if refused := self._refused.get(id):
                return refused
        payload: JsonObject = {"study": id}
        jobs = self._services.jobs
        return RowsLost(id, jobs.commit(lambda session: jobs.request(session, AGAIN, payload), AGAIN))

    def _refuse(self, id: str, error: Exception) -> None:
        """Remember until the next start of the service that rows cannot be restored, and why."""
        if not isinstance(error, CannotRebuild):
            return
        with self._lock:
            self._refused[id] = error
            while len(self._refused) > REMEMBERED:
                self._refused.popitem(last=False)
