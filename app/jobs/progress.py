"""Progress of running jobs for other servers: stored in the rows of the jobs.

Progress is not an event: only the latest value counts, and it costs one small write at most once a second.
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

SUBJECT = "progress"  # of the hints by which other servers look at the row of a job
GRACE = 0.15  # a job that ends sooner has no progress stored [s]
ALONE, SHARED = 0.5, 1.0  # between two writes for one job, where servers share the database or not [s]
_PATIENCE = 5.0  # for the end of the thread [s]


class ProgressKeeper:
    """Stores the latest progress of the jobs that this server runs, in a thread of its own.

    The first is stored after `GRACE` [s], what comes within `interval` [s] of it at the end of that: so the
    row is never behind for longer, however long the job's next step is silent. Other servers get a hint each
    time. Of a job that has ended by then nothing is stored: a small solid takes less, and a write costs as
    much as a tenth of it.
    """

    def __init__(self, database: Database, events: Events, interval: float | None = None) -> None:
        self._database, self._events = database, events
        self._interval = interval or (SHARED if database.is_shared else ALONE)
        self._latest: dict[str, tuple[Job, float, list[str]]] = {}
        self._lock = threading.Lock()
        self._some, self._stopping = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._work, name="progress", daemon=True)

    def start(self) -> None:
        """Begin to store."""
        self._thread.start()

    def stop(self) -> None:
        """Stop; unstored progress is lost, and a server that resumes the job starts from zero."""
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
        """Drop the unstored progress of an ended job."""
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
        """Store the progress of a job that is still held here.

        An error is ignored, since nothing depends on it.
        """
        try:
            unit = partial(repository.note_progress, job=job, progress=fraction, log=log)
            if self._database.write(unit):
                self._events.tell([f"{SUBJECT}:{job.id}:{job.design or ''}"])
        except Exception as error:
            logger.warning("The progress of job %s is not stored: %s", job.id, error)


class ProgressFollower:
    """Publishes how far jobs of other servers are, to those who listen here to them or to their designs."""

    def __init__(self, database: Database, events: Events, owner: str) -> None:
        self._database, self._events, self._owner = database, events, owner
        self._shown: dict[str, tuple[int, float, str]] = {}  # by job: attempt, progress, text

    def look(self, hints: Iterable[str] | None = None) -> None:
        """Read the rows of jobs that other servers name, or of all jobs with listeners."""
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
        if hints is None:  # of what has ended nothing comes any more
            self._shown = {job.id: self._shown[job.id] for job in running if job.id in self._shown}

    def _show(self, job: Job) -> None:
        if not job.log:  # it has just begun
            return
        stands = job.attempt, job.progress, job.log[-1]
        if self._shown.get(job.id) != stands:
            self._shown[job.id] = stands
            publish(self._events, job, job.progress, job.log[-1])


def _topics(hint: str) -> Collection[str]:
    """Return the topics to which a hint of progress belongs; none for other hints."""
    subject, _, names = hint.partition(":")
    job, _, design = names.partition(":")
    if subject != SUBJECT:
        return ()
    return (f"job:{job}", f"design:{design}") if design else (f"job:{job}",)


def _ids(topics: Iterable[str], kind: str) -> list[str]:
    parts = (topic.partition(":") for topic in topics)
    return [id for subject, _, id in parts if subject == kind]
