"""What the rest of the server can do with jobs."""

import asyncio
import logging
from collections.abc import Callable
from typing import Any

from sqlalchemy.orm import Session

from app import logs
from app.jobs import repository
from app.jobs.context import JobContext, publish
from app.jobs.dispatcher import Completion, Dispatcher, FailureHook, Handler, Kind, Problem
from app.jobs.errors import JobFailed, JobFinished, JobNotFound, QueueFull
from app.jobs.events import Events
from app.jobs.job import FINAL, Job, State
from app.settings import Settings
from app.storage.database import Database
from app.workers.base import Limits, Worker
from app.workers.errors import JobCancelled

__all__ = ["Completion", "Job", "JobContext", "JobFailed", "Jobs"]

logger = logging.getLogger(__name__)

RETRY_AFTER = 5  # what to advise when the queue is full [s]


def _ignore(session: Session, job: Job, problem: Problem) -> None:
    """Do nothing when a job fails."""


class Jobs:
    """The queue of jobs and those who work on it.

    `describe` turns an exception into the problem that a failed job shows.
    """

    def __init__(
        self,
        database: Database,
        worker: Worker,
        settings: Settings,
        describe: Callable[[Exception], Problem],
    ) -> None:
        self.events = Events()
        self.wait_seconds = settings.wait_seconds
        self._database = database
        self.settings = settings
        self._describe = describe
        limits = Limits(settings.job_deadline, settings.job_memory_mb)
        self._dispatcher = Dispatcher(database, worker, limits, self.events, describe)

    def register(
        self, kind: str, handler: Handler, on_failure: FailureHook = _ignore, *, is_slow: bool = False
    ) -> None:
        """Say what runs jobs of a kind; slow ones run beside the others, one at a time.

        The handler runs in a thread of the queue and returns a completion. That stores what the job has made
        and returns a link to it, in the transaction that marks the job as done. `on_failure` runs in the one
        that marks it as failed or cancelled.
        """
        self._dispatcher.kinds[kind] = Kind(handler, on_failure, is_slow)

    def start(self) -> None:
        """Queue again what a killed server left running, and begin to work. Register the kinds first."""
        self._database.write(repository.give_back_all)
        self._dispatcher.start(self.settings.workers)

    def drain(self) -> None:
        """End all subscriptions and begin no more jobs; those that run go on."""
        self.events.close()
        self._dispatcher.drain()

    def stop(self) -> None:
        """End all subscriptions and all running jobs; they stay in the queue for the next start."""
        self.events.close()
        self._dispatcher.stop(self.settings.stop_seconds / 2)

    def census(self, session: Session) -> list[tuple[str, str, int, str]]:
        """Return kind, state, number and age of the oldest of the jobs that have not ended."""
        return repository.census(session)

    def enqueue(
        self,
        session: Session,
        kind: str,
        payload: dict[str, Any],
        *,
        design: str | None = None,
        revision: int | None = None,
    ) -> str:
        """Queue a job in a unit of work and return its id; call `wake` when that is committed.

        Raises
        ------
        QueueFull
            Too many jobs are waiting.
        """
        if repository.count_queued(session) >= self.settings.queue_limit:
            raise QueueFull(RETRY_AFTER)
        id = repository.add(session, kind, payload, design, revision)
        logs.note_cause(id)
        logger.info("job %s (%s) queued", id, kind, extra={"job": id})
        return id

    def waiting(self, session: Session, kind: str, payload: dict[str, Any]) -> str | None:
        """Return the id of a job that is to do just this and has not ended."""
        return repository.find_waiting(session, kind, payload)

    def queued(self, session: Session) -> int:
        """Return how many jobs wait."""
        return repository.count_queued(session)

    def wake(self) -> None:
        """Have the queue looked at."""
        self._dispatcher.wake()

    def get(self, id: str) -> Job:
        """Return a job; raises JobNotFound."""
        with self._database.read() as session:
            return _existing(session, id)

    def problem(self, id: str | None) -> Problem | None:
        """Return why a job failed or was cancelled; None if it was not, or if there is no job at all."""
        return None if id is None else self.get(id).problem

    def page(self, limit: int, before: str | None = None) -> list[Job]:
        """Return jobs, newest first, older than `before` if given."""
        with self._database.read() as session:
            return repository.page(session, limit, before)

    def cancel(self, id: str) -> Job:
        """Cancel a job, kill its process if it has one, and return the job.

        Raises
        ------
        JobNotFound
            There is no such job.
        JobFinished
            The job has ended already.
        """
        problem = self._describe(JobCancelled())

        def unit(session: Session) -> Job:
            job = _existing(session, id)
            if job.finished:
                raise JobFinished(id, job.state)
            repository.cancel(session, job, problem)
            if kind := self._dispatcher.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            return job

        job = self._database.write(unit)
        self._dispatcher.interrupt(id)
        publish(self.events, job, "cancelled")
        return self.get(id)

    async def wait(self, id: str, seconds: float) -> State:
        """Wait for the end of a job, at most this long [s], and return its state; raises JobNotFound."""
        async with self.events.subscribe(f"job:{id}") as events:
            job = await asyncio.to_thread(self.get, id)
            if job.finished or seconds <= 0:
                return job.state
            try:
                async with asyncio.timeout(seconds):
                    async for event in events:
                        if event["event"] in FINAL:
                            break
            except TimeoutError:
                pass
        return (await asyncio.to_thread(self.get, id)).state


def _existing(session: Session, id: str) -> Job:
    job = repository.get(session, id)
    if job is None:
        raise JobNotFound(id)
    return job
