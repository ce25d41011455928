"""Store the progress of running jobs in their rows, for other servers.

Progress is not an event: only the latest value counts, and it costs at most one small write per second.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Collection, Iterable
from functools import partial

from app.jobs import repository
from app.jobs.context import publish
from app.jobs.events import Events
from app.jobs.repository import Job
from app.storage.database import Database

logger = logging.getLogger(__name__)

SUBJECT = "progress"  # subject of hints, which make other servers read a job's row
GRACE = 0.15  # progress of a shorter job is not stored [s]
ALONE, SHARED = 0.5, 1.0  # time between two writes for a job, on an own or a shared database [s]
_PATIENCE = 5.0  # longest wait for the end of the thread [s]


class ProgressKeeper:
    """Stores the latest progress of this server's running jobs, in a separate thread.

    The first value is stored after `GRACE` [s]. Values that arrive within `interval` [s] of a write are
    stored at the end of that interval, so the row never lags by more, even if the job's next step reports
    nothing for long. Each write sends a hint to other servers. Nothing is stored for a job that has ended by
    then: a small solid takes less time than that, and a write costs a tenth of it.
    """

    def __init__(self, database: Database, events: Events, interval: float | None = None) -> None:
        self._database, self._events = database, events
        self._interval = interval or (SHARED if database.is_shared else ALONE)
        self._latest: dict[str, tuple[Job, float, list[str]]] = {}
        self._lock = threading.Lock()
        self._some, self._stopping = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._work, name="progress", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread; unstored progress is lost, and a server that resumes the job starts from zero."""
        self._stopping.set()
        self._some.set()
        if self._thread.ident is not None:
            self._thread.join(_PATIENCE)

    def keep(self, job: Job, fraction: float, log: list[str]) -> None:
        """Store the progress of a job; see `app.jobs.context.Keep`."""
        with self._lock:
            self._latest[job.id] = job, fraction, log
        self._some.set()

    def forget(self, job: Job) -> None:
        """Discard the unstored progress of an ended job."""
        with self._lock:
            self._latest.pop(job.id, None)

    def _work(self) -> None:
        while self._some.wait() and not self._stopping.wait(GRACE):
            self._some.clear()
            with self._lock:
                latest, self._latest = self._latest, {}
            for job, fraction, log in latest.values():
                self._store(job, fraction, log)
            if latest:
                self._stopping.wait(self._interval)

    def _store(self, job: Job, fraction: float, log: list[str]) -> None:
        """Store the progress of a job that this server still holds.

        An error is ignored, because nothing depends on the stored progress.
        """
        try:
            unit = partial(repository.note_progress, job=job, progress=fraction, log=log)
            if self._database.write(unit):
                self._events.tell([f"{SUBJECT}:{job.id}:{job.design or ''}"])
        except Exception as error:
            logger.warning("The progress of job %s is not stored: %s", job.id, error)


class ProgressFollower:
    """Publishes the progress of jobs on other servers to local listeners of these jobs or their designs."""

    def __init__(self, database: Database, events: Events, owner: str) -> None:
        self._database, self._events, self._owner = database, events, owner
        self._shown: dict[str, tuple[int, float, str]] = {}  # by job: attempt, progress, text

    def look(self, hints: Iterable[str] | None = None) -> None:
        """Read the rows of the jobs that other servers name, or of all jobs with listeners."""
        if hints is None:
            heard = self._events.heard()
        else:
            hinted = {topic for hint in hints for topic in _topics(hint)}
            heard = self._events.heard(hinted)
        if not heard:
            return
        with self._database.read() as session:
            running = repository.running_elsewhere(
                session, _ids(heard, "job"), _ids(heard, "design"), self._owner
            )
        for job in running:
            self._show(job)
        if hints is None:  # nothing arrives for an ended job
            self._shown = {job.id: self._shown[job.id] for job in running if job.id in self._shown}

    def _show(self, job: Job) -> None:
        if not job.log:  # the job has just begun
            return
        stands = job.attempt, job.progress, job.log[-1]
        if self._shown.get(job.id) != stands:
            self._shown[job.id] = stands
            publish(self._events, job, job.progress, job.log[-1])


def _topics(hint: str) -> Collection[str]:
    """Return the topics that a hint about progress concerns; empty for other hints."""
    subject, _, names = hint.partition(":")
    job, _, design = names.partition(":")
    if subject != SUBJECT:
        return ()
    return (f"job:{job}", f"design:{design}") if design else (f"job:{job}",)


def _ids(topics: Iterable[str], kind: str) -> list[str]:
    parts = (topic.partition(":") for topic in topics)
    return [id for subject, _, id in parts if subject == kind]
