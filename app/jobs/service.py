"""The service of jobs: queue, show, wait for and cancel them."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Collection, Mapping
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, TypeVar

from sqlalchemy.orm import Session

from app.identity import usage
from app.identity.audit import record
from app.identity.errors import NotOwn
from app.identity.limits import Limits as PrincipalLimits
from app.identity.principal import BUILT_IN, acting
from app.jobs import repository, turns
from app.jobs.context import JobContext, note
from app.jobs.dispatcher import FAST, SLOW, Completion, Dispatcher, FailureHook, Handler, Kind, Problem
from app.jobs.errors import JobFailed, JobFinished, JobNotFound, JobRests
from app.jobs.events import Events
from app.jobs.leases import Leases
from app.jobs.progress import ProgressFollower
from app.jobs.repository import FINAL, Job
from app.jobs.schemas import State
from app.jobs.turns import admit
from app.plain import JsonObject
from app.settings import Settings
from app.storage.clock import operated
from app.storage.database import Database
from app.storage.locks import lock
from app.storage.units import Unit
from app.workers.base import BatchWorker, Limits
from app.workers.errors import JobCancelled

if TYPE_CHECKING:
    from app.storage.notices import Notices

__all__ = ["Completion", "Job", "JobContext", "JobFailed", "JobRests", "Jobs"]

logger = logging.getLogger(__name__)

T = TypeVar("T")


def _ignore(session: Session, job: Job, problem: Problem) -> None:
    """Do nothing when a job fails."""


class Jobs:
    """The queue of jobs, and the threads that run them.

    `describe` turns an exception into the problem that a failed job shows.
    """

    def __init__(
        self,
        database: Database,
        worker: BatchWorker,
        settings: Settings,
        describe: Callable[[Exception], Problem],
    ) -> None:
        self.events = Events(database)
        self.wait_seconds = settings.wait_seconds
        self._database = database
        self.settings = settings
        self._describe = describe
        limits = Limits(settings.job_deadline, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB")
        self._notices: Notices | None = None
        self._dispatcher = Dispatcher(
            database, worker, limits, self.events, describe, settings.workers, settings.lease_seconds
        )
        self._progress = ProgressFollower(database, self.events, self._dispatcher.owner)
        self._leases = Leases(database, self._dispatcher, self.events, settings, describe)

    def register(
        self,
        kind: str,
        handler: Handler,
        on_failure: FailureHook = _ignore,
        *,
        is_slow: bool = False,
        lane: str | None = None,
    ) -> None:
        """Register the handler of a kind of job; slow jobs run in a lane of their own, one at a time.

        A kind may have its own lane, whose number of threads is passed to `start`. The handler runs in a
        thread of the queue and returns a completion. The completion stores the result of the job and returns
        a link to it, in the transaction that marks the job as done. `on_failure` runs in the transaction
        that marks it as failed or cancelled.
        """
        self._dispatcher.kinds[kind] = Kind(handler, on_failure, lane or (SLOW if is_slow else FAST))

    def run_within(self, around: Callable[[Job], AbstractContextManager[object]]) -> None:
        """Make each job run within a separate context."""
        self._dispatcher.around = around

    def start(self, lanes: Mapping[str, int] | None = None) -> None:
        """Queue again the jobs that a killed server left running, and start the threads.

        Register the kinds first. `lanes` gives the number of threads of lanes besides the usual two. If
        several servers share the database, a running job may belong to another server; it is queued again
        once its lease ends.
        """
        if self._database.is_shared:
            self._leases.start()
        else:
            self._dispatcher.requeue_all()
        self._dispatcher.start(lanes or {})
        if self._database.is_shared:
            self._join_others()

    def drain(self) -> None:
        """End all subscriptions and start no more jobs; running ones continue."""
        self.events.close()
        self._dispatcher.drain()

    def stop(self) -> None:
        """End all subscriptions and all running jobs; they stay in the queue for the next start."""
        self.events.close()
        self._dispatcher.stop(self.settings.stop_seconds / 2)
        if self._leases.is_started:
            self._leases.stop()
        if self._notices is not None:
            self._notices.stop()

    def census(self, session: Session) -> list[tuple[str, str, int]]:
        """Return the number of unfinished jobs by kind and state."""
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
        question: str | None = None,
    ) -> str:
        """Queue a client's job in a unit of work, and return its id; pass the unit to `commit`.

        Raises
        ------
        QueueFull
            If too many jobs are waiting, of this client or of all.
        LimitReached
            If the acting principal has used up its calculation time of today or its storage.
        """
        lane = self._dispatcher.lane(kind)
        threads = self._dispatcher.threads(kind)
        limits = usage.own_limits(session, self.settings)
        share = self._share(limits)
        admit(session, client, lane, threads, share, self.settings.queue_limit, self._dispatcher.durations)
        if limits is not None:
            usage.admit(session, limits)
        turn = turns.next_turn(session, client, lane)
        id = repository.add(session, kind, payload, design, revision, client, turn, question)
        logger.info("job %s (%s) queued", id, kind, extra={"job": id})
        return id

    def request(self, session: Session, kind: str, payload: JsonObject, client: str = "") -> str:
        """Return the id of an equal waiting job, in the earlier turn of its clients, or queue a new one.

        Raises
        ------
        QueueFull
            If there is no such job, and too many others are waiting.
        """
        id = self.waiting(session, kind, payload)
        if id is None:
            return self.enqueue(session, kind, payload, client=client)
        self._join(session, kind, id, client)
        return id

    def ask(
        self,
        session: Session,
        kind: str,
        payload: JsonObject,
        question: str,
        states: Collection[State],
        client: str = "",
    ) -> tuple[str, bool]:
        """Return the job for an equal request in one of these states, else a new job; and whether it is new.

        `question` is the key of the request. The client joins those who already wait for the job.

        Raises
        ------
        QueueFull, LimitReached
            As raised by `enqueue`, for a new job.
        """
        lock(session, f"question {question}")
        earlier = repository.asked(session, question, states)
        if earlier is None:
            return self.enqueue(session, kind, payload, client=client, question=question), True
        if not earlier.finished:
            self._join(session, kind, earlier.id, client)
        return earlier.id, False

    def _join(self, session: Session, kind: str, id: str, client: str) -> None:
        """Add a client to those who wait for a job that another client requested."""
        share = self._share(usage.own_limits(session, self.settings))
        turns.join(session, id, client, self._dispatcher.lane(kind), share)

    def _share(self, limits: PrincipalLimits | None) -> int:
        """Return how many jobs one client may have waiting."""
        return self.settings.client_queue_limit if limits is None else limits.queued_jobs

    def waiting(self, session: Session, kind: str, payload: JsonObject) -> str | None:
        """Return the id of an equal unfinished job."""
        return repository.find_waiting(session, kind, payload)

    def others_wait(self, kind: str) -> bool:
        """Return whether a job waits in the lane of a kind."""
        lane = self._dispatcher.lane(kind)
        with self._database.read() as session:
            return turns.count_queued(session, lane=lane) > 0

    def usual_seconds(self, kind: str) -> float:
        """Return the mean duration of the latest jobs in the lane of a kind [s]."""
        return self._dispatcher.durations.mean(self._dispatcher.lane(kind))

    def queued(self, session: Session) -> int:
        """Return the number of waiting jobs."""
        return turns.count_queued(session)

    def oldest_queued_age(self, session: Session) -> int:
        """Return the waiting time of the oldest job [s of the service's running time]; 0 if none waits."""
        since = turns.oldest_queued(session)
        return 0 if since is None else operated(session) + self._database.clock.elapsed - since

    def commit(self, unit: Unit[T], kind: str | None = None) -> T:
        """Commit a unit of work that may queue a job, and wake all threads of the queue, or those of a kind.

        Raises
        ------
        Exception
            As raised by `Database.write`; then nothing is queued.
        """
        result = self._database.write(unit)
        self.wake(kind)
        return result

    def wake(self, kind: str | None = None) -> None:
        """Wake all threads of the queue, or those of a kind's lane."""
        self._dispatcher.wake(kind)
        self.events.tell([f"queue:{kind or ''}"])

    def get(self, id: str) -> Job:
        """Return a job; raises JobNotFound."""
        with self._database.read() as session:
            return _existing(session, id)

    def problem(self, id: str | None) -> Problem | None:
        """Return why a job failed or was cancelled; None for any other job."""
        return None if id is None else self.get(id).problem

    def page(self, limit: int, before: str | None = None) -> list[Job]:
        """Return jobs, newest first, older than `before` if given."""
        with self._database.read() as session:
            return repository.page(session, limit, before)

    def cancel(self, id: str, client: str | None = None) -> Job:
        """Cancel a job, kill its process if it has one, and return the job.

        A job that other clients wait for continues: it ends when the last of them cancels it.

        Raises
        ------
        JobShared, NotOwn
            If several other clients wait for the job, or it belongs to another principal.
        JobNotFound
            If there is no such job.
        JobFinished
            If the job has already ended.
        """
        problem = self._describe(JobCancelled())

        def unit(session: Session) -> bool:
            job = repository.locked(session, id)
            if job is None:
                raise JobNotFound(id)
            if job.finished:
                raise JobFinished(id, job.state)
            if client is not None and not _administers() and turns.leave(session, id, client):
                return False
            if client is not None:
                _require_own(session, id, client)
            repository.cancel(session, job, problem)
            record(session, "job.cancel", f"jobs/{id}")
            if kind := self._dispatcher.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            note(session, self.events, job, "cancelled")
            return True

        if self._database.write(unit):
            self._dispatcher.interrupt(id)
            self.events.tell([f"cancel:{id}"])
        return self.get(id)

    async def wait(self, id: str, seconds: float) -> State:
        """Wait at most this long for the end of a job [s], and return its state; raises JobNotFound."""
        async with self.events.subscribe(f"job:{id}") as events:
            job = await asyncio.to_thread(self.get, id)
            if job.finished or seconds <= 0:
                return job.state
            events.number = job.event
            try:
                async with asyncio.timeout(seconds):
                    async for event in events:
                        if event.name in FINAL:
                            return event.name
            except TimeoutError:
                pass
        return (await asyncio.to_thread(self.get, id)).state

    def _join_others(self) -> None:
        """Start to exchange hints with the other servers of the database."""
        from app.storage.notices import Notices  # needs the driver in the extra `team`

        self._notices = Notices(self._database.url, self.settings.poll_seconds, self._hear)
        self.events.tell = self._notices.send
        self._notices.start()

    def _hear(self, hints: list[str] | None) -> None:
        """React to hints of other servers; without hints, check everything."""
        if hints is None:
            self._dispatcher.wake()
        for hint in hints or ():
            subject, _, name = hint.partition(":")
            if subject == "queue":
                self._dispatcher.wake(name or None)
            elif subject == "cancel":
                self._dispatcher.interrupt(name)
        self._progress.look(hints)
        self.events.look(hints)


def _existing(session: Session, id: str) -> Job:
    job = repository.get(session, id)
    if job is None:
        raise JobNotFound(id)
    return job


def _administers() -> bool:
    """Return whether the acting principal is an administrator, who may end any job."""
    who = acting()
    return who.id not in BUILT_IN and who.may("admin")


def _require_own(session: Session, id: str, client: str) -> None:
    """Restrict a job to its principal and to administrators.

    Raises
    ------
    NotOwn
        If the acting principal is neither.
    """
    own = acting().id in BUILT_IN or turns.client_of(session, id) == client
    if not own and not _administers():
        raise NotOwn("the job belongs to another principal: only they or an administrator can cancel it")
