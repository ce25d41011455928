"""Threads that take jobs from the queue, execute them, and record their outcomes."""

import logging
import secrets
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass
from functools import partial

from sqlalchemy.orm import Session

from app.identity.usage import working_for
from app.jobs import repository
from app.jobs.context import JobContext, note
from app.jobs.errors import JobFailed, JobLost, JobRests
from app.jobs.events import Events
from app.jobs.progress import ProgressKeeper
from app.jobs.repository import Job
from app.jobs.turns import Durations, Lane
from app.observation import logs
from app.plain import JsonObject
from app.storage.database import Database, after_commit
from app.storage.errors import ArtifactsUnreachable, DatabaseClosed, DatabaseUnavailable
from app.workers.base import ANALYSIS, GEOMETRY, BatchWorker, Limits
from app.workers.base import Lane as WorkerLane
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded, WorkerLost

logger = logging.getLogger(__name__)

Problem = JsonObject
Completion = Callable[[Session], str | None]
Handler = Callable[[Job, JobContext], Completion]
FailureHook = Callable[[Session, Job, Problem], None]

FAST, SLOW = "fast", "slow"
WORKER_LANES: Mapping[str, WorkerLane] = {FAST: GEOMETRY, SLOW: ANALYSIS}
"""Lanes whose jobs are claimed only if the worker has room; other lanes do not use the worker."""
MAX_CRASHES = 2
MAX_LOSSES = 5  # largest number of lost machines or servers for one job
_GLANCE = 0.1  # time between two checks whether the worker has room [s]
_PAUSE = 1.0  # time before the next look at the queue after a database error [s]


@dataclass(frozen=True)
class RunningJob:
    """A job that this server has claimed, and the event that stops it."""

    job: Job
    cancelled: threading.Event


@dataclass(frozen=True)
class Kind:
    """A kind of jobs: the function that runs them, and the lane in which they wait."""

    handler: Handler
    on_failure: FailureHook
    lane: str = FAST


class Dispatcher:
    """Runs the queued jobs. Every lane has its own threads, whose number limits its simultaneous jobs.

    So a change of a bearing does not wait for somebody else's analysis.
    """

    def __init__(
        self,
        database: Database,
        worker: BatchWorker,
        limits: Limits,
        events: Events,
        describe: Callable[[Exception], Problem],
        threads: int = 1,
        lease: float = 30.0,
    ) -> None:
        self.owner = secrets.token_hex(8)
        """Name of this server in the rows of the jobs that it runs."""
        self.kinds: dict[str, Kind] = {}
        self.durations = Durations()
        self.around: Callable[[Job], AbstractContextManager[object]] = nullcontext
        """Context in which a job runs: its span if traces are enabled."""
        self._database = database
        self._worker = worker
        self._limits = limits
        self._events = events
        self._progress = ProgressKeeper(database, events)
        self._describe = describe
        self._counts = {FAST: threads, SLOW: 1}  # threads of each lane
        self._awake = {FAST: threading.Semaphore(0), SLOW: threading.Semaphore(0)}
        self._stopping = threading.Event()
        self._lease = lease
        self._running: dict[str, RunningJob] = {}  # by job
        self._threads: list[threading.Thread] = []

    def start(self, beside: Mapping[str, int]) -> None:
        """Start to take jobs from the queue; `beside` has the numbers of threads of additional lanes."""
        self._progress.start()
        self._counts |= beside
        self._awake = {lane: threading.Semaphore(0) for lane in self._counts}
        for number, lane in enumerate(lane for lane, count in self._counts.items() for _ in range(count)):
            thread = threading.Thread(target=self._work, args=[lane], name=f"jobs-{number}", daemon=True)
            self._threads.append(thread)
            thread.start()
            self.wake()

    def lane(self, kind: str) -> Lane:
        """Return the lane in which jobs of a kind wait."""
        return self._lane(self._lane_name(kind))

    def threads(self, kind: str) -> int:
        """Return the number of threads that run the jobs of a kind's lane."""
        return self._counts[self._lane_name(kind)]

    def wake(self, kind: str | None = None) -> None:
        """Wake a thread of each lane, or of the lane of one kind, to check the queue."""
        for lane in self._awake if kind is None else (self._lane_name(kind),):
            self._awake[lane].release()

    def interrupt(self, id: str, attempt: int | None = None) -> None:
        """Kill the process of a job, if the job is running at this attempt."""
        running = self._running.get(id)
        if running and attempt in (None, running.job.attempt):
            running.cancelled.set()

    def running(self) -> list[Job]:
        """Return the jobs that this server runs, as they were when it claimed them."""
        return [running.job for running in list(self._running.values())]

    def requeue_all(self, owner: str | None = None) -> None:
        """Queue again all running jobs, or only those of an owner; none of them may still be alive."""

        def unit(session: Session) -> None:
            for job in repository.requeue_all(session, owner):
                note(session, self._events, job, "queued")

        self._database.write(unit)

    def drain(self) -> None:
        """Start no more jobs; running ones continue."""
        self._stopping.set()

    def stop(self, patience: float = 10.0) -> None:
        """Kill running jobs, put them back into the queue, and wait this long for the threads [s].

        A thread that calculates in this process cannot be stopped; its job is put back at the next start.
        """
        self.drain()
        for id in list(self._running):
            self.interrupt(id)
        for _ in self._threads:
            self.wake()
        end = time.monotonic() + patience
        for thread in self._threads:
            thread.join(max(0.0, end - time.monotonic()))
        self._progress.stop()
        if busy := [thread.name for thread in self._threads if thread.is_alive()]:
            logger.warning("still busy, and left behind: %s", ", ".join(busy))

    def _work(self, lane: str) -> None:
        while not self._stopping.is_set():
            self._awake[lane].acquire()
            try:
                self._empty_queue(lane)
            except DatabaseClosed:
                return  # this thread outlived the stop of the server
            except Exception:
                logger.exception("The queue of jobs could not be read or written; trying again")
                self._stopping.wait(_PAUSE)
                self.wake()

    def _empty_queue(self, lane: str) -> None:
        while self._has_place(lane) and (job := self._database.write(partial(self._claim, lane=lane))):
            mine, start = self._running[job.id], time.monotonic()
            try:
                with logs.caused(job.cause), working_for(self._database, job.principal), self.around(job):
                    self._execute(job)
            finally:
                self.durations.note(self.lane(job.kind), time.monotonic() - start)
                if (
                    self._running.get(job.id) is mine
                ):  # once given back, the job may already run in another thread
                    del self._running[job.id]

    def _has_place(self, lane: str) -> bool:
        """Wait until the worker has room for a job of a lane; return False if no more jobs are to start."""
        while not self._stopping.is_set():
            if lane not in WORKER_LANES or self._worker.capacity(WORKER_LANES[lane]) > 0:
                return True
            self._stopping.wait(_GLANCE)
        return False

    def _claim(self, session: Session, *, lane: str) -> Job | None:
        """Claim a job and register it within the same write, so that it can be interrupted at once."""
        kinds = self.kinds if self._database.is_shared else None
        job = repository.claim(session, self._lane(lane), self.owner, self._lease, kinds)
        if job is not None:
            after_commit(session, partial(self._register, job))
            note(session, self._events, job, "running")
        return job

    def _register(self, job: Job) -> None:
        self.interrupt(job.id)  # in case this server lost the lease, and this is the next attempt
        self._running[job.id] = RunningJob(job, threading.Event())

    def _lane_name(self, kind: str) -> str:
        return self.kinds[kind].lane if kind in self.kinds else FAST

    def _lane(self, lane: str) -> Lane:
        """Return a lane by its name; jobs of an unregistered kind wait in the fast lane."""
        beside = {name: kind.lane for name, kind in self.kinds.items() if kind.lane != FAST}
        if lane == FAST:
            return Lane(tuple(beside))
        return Lane(tuple(name for name, its in beside.items() if its == lane), is_common=False)

    def _execute(self, job: Job) -> None:
        """Run a claimed job until it ends, and handle every outcome."""
        cancelled = self._running[job.id].cancelled
        if self._stopping.is_set():  # claimed while `stop` went through the running jobs
            cancelled.set()
        logger.info("job %s (%s) begins", job.id, job.kind, extra={"job": job.id})
        batch = self._worker.batch(WORKER_LANES.get(self._lane_name(job.kind), GEOMETRY))
        context = JobContext(job, self._progress.keep, batch, self._limits, self._events, cancelled)
        try:
            try:
                with closing(context):
                    completion = self.kinds[job.kind].handler(job, context)
            finally:
                self._progress.forget(job)
            self._complete(job, context, completion)
        except JobCancelled:
            self._requeue(job, job.crashes)  # has no effect if the job was cancelled meanwhile
        except JobRests:
            self._rest(job)
        except (ArtifactsUnreachable, DatabaseUnavailable) as error:
            logger.warning("Job %s (%s) is queued again: %s", job.id, job.kind, error)
            self._requeue(job, job.crashes)
            self._stopping.wait(error.retry_after)
        except JobCrashed as error:
            self._crashed(job, context, error)
        except WorkerLost as error:
            self._lost(job, context, error)
        except JobFailed as verdict:
            self._fail(job, context, self._describe(verdict.cause), verdict.completion)
        except (DeadlineExceeded, MemoryExceeded) as error:
            self._fail(job, context, self._describe(error))
        except Exception as error:
            logger.exception("Job %s (%s) failed unexpectedly", job.id, job.kind)
            self._fail(job, context, self._describe(error))

    def _complete(self, job: Job, context: JobContext, completion: Completion) -> None:
        def unit(session: Session) -> None:
            if repository.end(session, job, "done", context.log, progress=1.0):
                repository.set_result(session, job.id, completion(session))
                note(session, self._events, job, "done")

        self._database.write(unit)

    def _crashed(self, job: Job, context: JobContext, error: JobCrashed) -> None:
        """Queue a crashed job again, because another process may have caused the crash by using all memory.

        After several crashes the job fails.
        """
        if self._stopping.is_set():  # its process was ended with the others
            self._requeue(job, job.crashes)
            return
        crashes = job.crashes + 1
        logger.warning("Job %s (%s) crashed, time %d: %s", job.id, job.kind, crashes, error)
        if crashes < MAX_CRASHES:
            self._requeue(job, crashes)
        else:
            self._fail(job, context, self._describe(error), crashes=crashes)

    def _lost(self, job: Job, context: JobContext, error: WorkerLost) -> None:
        """Queue a job again whose machine was lost; it fails only after repeated losses."""
        losses = job.losses + 1
        logger.warning("Job %s (%s) was lost, time %d: %s", job.id, job.kind, losses, error)
        if losses < MAX_LOSSES:
            self._requeue(job, job.crashes, losses=losses)
        else:
            self._fail(job, context, self._describe(JobLost(losses)), losses=losses)

    def _requeue(self, job: Job, crashes: int, **more: int) -> None:
        def unit(session: Session) -> None:
            if repository.requeue(session, job, crashes, **more):
                note(session, self._events, job, "queued")

        self._database.write(unit)
        self._events.tell([f"queue:{job.kind}"])

    def _rest(self, job: Job) -> None:
        lane = self.lane(job.kind)

        def unit(session: Session) -> None:
            if repository.rest(session, job, lane):
                note(session, self._events, job, "queued")

        self._database.write(unit)
        self.wake(job.kind)

    def _fail(
        self,
        job: Job,
        context: JobContext,
        problem: Problem,
        completion: Callable[[Session], None] | None = None,
        **more: object,
    ) -> None:
        def unit(session: Session) -> None:
            if not repository.end(session, job, "failed", context.log, problem=problem, **more):
                return
            if completion is not None:
                completion(session)
            if kind := self.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            note(session, self._events, job, "failed", problem=problem)

        self._database.write(unit)
