"""What the rest of the server can do with jobs."""

import asyncio
import logging
from collections.abc import Callable, Mapping
from typing import cast

from sqlalchemy.orm import Session

from app.jobs import repository, turns
from app.jobs.admission import admit
from app.jobs.context import JobContext, publish
from app.jobs.dispatcher import FAST, SLOW, Completion, Dispatcher, FailureHook, Handler, Kind, Problem
from app.jobs.errors import JobFailed, JobFinished, JobNotFound, JobRests
from app.jobs.events import Events
from app.jobs.job import FINAL, Job
from app.observation import logs
from app.plain import JsonObject
from app.schemas.jobs import State
from app.settings import Settings
from app.storage.clock import operated
from app.storage.database import Database
from app.workers.base import BatchWorker, Limits
from app.workers.errors import JobCancelled

__all__ = ["Completion", "Job", "JobContext", "JobFailed", "JobRests", "Jobs"]

logger = logging.getLogger(__name__)


def _ignore(session: Session, job: Job, problem: Problem) -> None:
    """Do nothing when a job fails."""


class Jobs:
    """The queue of jobs and those who work on it.

    `describe` turns an exception into the problem that a failed job shows.
    """

    def __init__(
        self,
        database: Database,
        worker: BatchWorker,
        settings: Settings,
        describe: Callable[[Exception], Problem],
    ) -> None:
        self.events = Events()
        self.wait_seconds = settings.wait_seconds
        self._database = database
        self.settings = settings
        self._describe = describe
        limits = Limits(settings.job_deadline, settings.job_memory_mb)
        self._dispatcher = Dispatcher(database, worker, limits, self.events, describe, settings.workers)

    def register(
        self,
        kind: str,
        handler: Handler,
        on_failure: FailureHook = _ignore,
        *,
        is_slow: bool = False,
        lane: str | None = None,
    ) -> None:
        """Say what runs jobs of a kind; slow ones run beside the others, one at a time.

        A kind may have a lane of its own, whose threads `start` is asked for.

        The handler runs in a thread of the queue and returns a completion. That stores the result of the job
        and returns a link to it, in the transaction that marks the job as done. `on_failure` runs in the one
        that marks it as failed or cancelled.
        """
        self._dispatcher.kinds[kind] = Kind(handler, on_failure, lane or (SLOW if is_slow else FAST))

    def start(self, lanes: Mapping[str, int] | None = None) -> None:
        """Queue again what a killed server left running, and begin to work. Register the kinds first.

        `lanes` gives the number of threads of lanes beside the usual two.
        """
        self._database.write(repository.give_back_all)
        self._dispatcher.start(lanes or {})

    def drain(self) -> None:
        """End all subscriptions and begin no more jobs; those that run go on."""
        self.events.close()
        self._dispatcher.drain()

    def stop(self) -> None:
        """End all subscriptions and all running jobs; they stay in the queue for the next start."""
        self.events.close()
        self._dispatcher.stop(self.settings.stop_seconds / 2)

    def census(self, session: Session) -> list[tuple[str, str, int]]:
        """Return kind, state and number of the jobs that have not ended."""
        return repository.census(session)

    def enqueue(
        self,
        session: Session,
        kind: str,
        payload: JsonObject,
        *,
        design: str | None = None,
        revision: int | None = None,
        client: str = "",
    ) -> str:
        """Queue a job of a client in a unit of work and return its id; call `wake` when that is committed.

        Raises
        ------
        QueueFull
            Too many jobs are waiting, of this client or of all.
        """
        lane = self._dispatcher.lane(kind)
        threads = self._dispatcher.threads(kind)
        admit(session, client, lane, threads, self.settings, self._dispatcher.durations)
        turn = turns.next_turn(session, client, lane)
        id = repository.add(session, kind, payload, design, revision, client, turn)
        logs.note_cause(id)
        logger.info("job %s (%s) queued", id, kind, extra={"job": id})
        return id

    def request(self, session: Session, kind: str, payload: JsonObject, client: str = "") -> str:
        """Return the id of the job that is to do just this, in the earlier turn of its clients; or queue it.

        Raises
        ------
        QueueFull
            There is no such job, and too many others are waiting.
        """
        id = self.waiting(session, kind, payload)
        if id is None:
            return self.enqueue(session, kind, payload, client=client)
        turns.join(session, id, client, self._dispatcher.lane(kind), self.settings.client_queue_limit)
        return id

    def waiting(self, session: Session, kind: str, payload: JsonObject) -> str | None:
        """Return the id of a job that is to do just this and has not ended."""
        return repository.find_waiting(session, kind, payload)

    def others_wait(self, kind: str) -> bool:
        """Return whether a job waits in the lane of a kind."""
        lane = self._dispatcher.lane(kind)
        with self._database.read() as session:
            return turns.count_queued(session, lane=lane) > 0

    def usual_seconds(self, kind: str) -> float:
        """Return how long the latest jobs of a kind's lane took on average [s]."""
        return self._dispatcher.durations.mean(self._dispatcher.lane(kind))

    def queued(self, session: Session) -> int:
        """Return how many jobs wait."""
        return turns.count_queued(session)

    def oldest_queued_age(self, session: Session) -> int:
        """Return how long the oldest job has waited [s of operation]; 0 if none waits."""
        since = turns.oldest_queued(session)
        return 0 if since is None else operated(session) + self._database.clock.elapsed - since

    def wake(self, kind: str | None = None) -> None:
        """Have the queue looked at, by all threads or by those of a kind's lane."""
        self._dispatcher.wake(kind)

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

    def cancel(self, id: str, client: str | None = None) -> Job:
        """Cancel a job, kill its process if it has one, and return the job.

        For a client, a job that other clients wait for too goes on: it ends when the last of them cancels it.

        Raises
        ------
        JobShared
            Several clients wait for the job, and this one does not.
        JobNotFound
            There is no such job.
        JobFinished
            The job has ended already.
        """
        problem = self._describe(JobCancelled())

        def unit(session: Session) -> Job | None:
            job = _existing(session, id)
            if job.finished:
                raise JobFinished(id, job.state)
            if client is not None and turns.leave(session, id, client):
                return None
            repository.cancel(session, job, problem)
            if kind := self._dispatcher.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            return job

        if job := self._database.write(unit):
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
                            return cast(State, event["event"])
            except TimeoutError:
                pass
        return (await asyncio.to_thread(self.get, id)).state


def _existing(session: Session, id: str) -> Job:
    job = repository.get(session, id)
    if job is None:
        raise JobNotFound(id)
    return job
