"""The context of a running job: progress, cancellation and the worker."""

import logging
import threading
from collections.abc import Callable
from functools import partial
from typing import TypeVar, TypeVarTuple

from sqlalchemy.orm import Session

from app.jobs.events import Event, Events
from app.jobs.repository import FINAL, Job
from app.observation import metrics
from app.plain import JsonObject
from app.storage.database import after_commit
from app.workers.base import Batch, Limits, Runner

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

logger = logging.getLogger(__name__)

_LINES = 200  # lines of the log that are kept


Keep = Callable[[Job, float, list[str]], object]
"""Accepts the progress [0 to 1] and the log of a claimed job, and stores them soon; it never blocks."""


class JobContext:
    """Runs functions in the worker, and reports and stores the progress of the job.

    All functions of a job share a process as long as each returns normally. So a job that builds a hundred
    solids loads the kernel's resources only once.
    """

    def __init__(
        self,
        job: Job,
        keep: Keep,
        batch: Batch,
        limits: Limits,
        events: Events,
        cancelled: threading.Event,
    ) -> None:
        self.log: list[str] = []
        self._job = job
        self._keep = keep
        self._batch = batch
        self._limits = limits
        self._events = events
        self._cancelled = cancelled

    @property
    def is_cancelled(self) -> bool:
        """Return whether the job was cancelled or the server is stopping."""
        return self._cancelled.is_set()

    @property
    def cancelled(self) -> threading.Event:
        """Return the event that is set once the job is cancelled or the server stops."""
        return self._cancelled

    def run(self, function: Callable[[*Ts], T], *args: *Ts, limits: Limits | None = None) -> T:
        """Run a function in the worker, within these limits or those of jobs.

        The function reports progress by `report`.

        Raises
        ------
        JobCancelled
            If the job was cancelled, or the server stops.
        WorkerError
            See `Worker.run`.
        """
        return self._batch.run(
            function,
            *args,
            limits=limits or self._limits,
            on_progress=self.progress,
            cancelled=self._cancelled,
        )

    def quietly(self) -> Runner:
        """Return a runner for several functions that do not report their progress; the job counts them."""
        return _Quietly(self._batch, self._limits, self._cancelled)

    def close(self) -> None:
        """End the process of the job; called when the job's handler has returned."""
        self._batch.close()

    def progress(self, fraction: float, text: str) -> None:
        """Publish and store the progress of the job [0 to 1], and a text on its next action."""
        self.log = [*self.log, text][-_LINES:]
        publish(self._events, self._job, fraction, text)
        self._keep(self._job, fraction, self.log)


class _Quietly:
    """Runs functions of a job without reporting progress; see `Runner`."""

    def __init__(self, batch: Batch, limits: Limits, cancelled: threading.Event) -> None:
        self._batch, self._limits, self._cancelled = batch, limits, cancelled

    def run(self, function: Callable[[*Ts], T], *args: *Ts, limits: Limits | None = None) -> T:
        """Run a function; see `JobContext.run`."""
        return self._batch.run(function, *args, limits=limits or self._limits, cancelled=self._cancelled)


def publish(events: Events, job: Job, fraction: float, text: str) -> None:
    """Send the progress of a job to everyone in this process who listens to the job or to its design."""
    data: JsonObject = {"job": job.id, "revision": job.revision, "progress": fraction, "text": text}
    events.publish(*map(partial(Event, name="progress", data=data), job.topics))


def note(session: Session, events: Events, job: Job, name: str, **more: object) -> None:
    """Record an event of a job, in the same unit of work, for those who listen to the job or its design."""
    after_commit(session, partial(_record, job, name))
    data = {"job": job.id, "revision": job.revision, **more}
    events.note(session, *[Event(topic, name, data) for topic in job.topics])


def _record(job: Job, name: str) -> None:
    metrics.job_event(job.id, job.kind, name)
    if name in FINAL:
        logger.info("job %s (%s) %s", job.id, job.kind, name, extra={"job": job.id})
