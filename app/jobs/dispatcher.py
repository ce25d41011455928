"""The threads that take jobs from the queue, have them run, and record how they ended."""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import partial

from sqlalchemy.orm import Session

from app.jobs import repository
from app.jobs.admission import Durations
from app.jobs.context import JobContext, publish
from app.jobs.errors import JobFailed, JobRests
from app.jobs.events import Events
from app.jobs.job import Job
from app.jobs.turns import Lane
from app.observation import logs
from app.plain import JsonObject
from app.storage.database import Database
from app.storage.errors import DatabaseClosed
from app.workers.base import BatchWorker, Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded

logger = logging.getLogger(__name__)

Problem = JsonObject
Completion = Callable[[Session], str | None]
Handler = Callable[[Job, JobContext], Completion]
FailureHook = Callable[[Session, Job, Problem], None]

FAST, SLOW = "fast", "slow"
MAX_CRASHES = 2
_PAUSE = 1.0  # before the queue is looked at again after the database has failed [s]


@dataclass(frozen=True)
class Kind:
    """What to do with jobs of a kind, and in which lane."""

    handler: Handler
    on_failure: FailureHook
    lane: str = FAST


class Dispatcher:
    """Runs the queued jobs, as many at a time as there are threads; every lane has threads of its own.

    So whoever changes a bearing does not wait until somebody's analysis is done.
    """

    def __init__(
        self,
        database: Database,
        worker: BatchWorker,
        limits: Limits,
        events: Events,
        describe: Callable[[Exception], Problem],
        threads: int = 1,
    ) -> None:
        self.kinds: dict[str, Kind] = {}
        self.durations = Durations()
        self._database = database
        self._worker = worker
        self._limits = limits
        self._events = events
        self._describe = describe
        self._counts = {FAST: threads, SLOW: 1}  # threads of each lane
        self._awake = {FAST: threading.Semaphore(0), SLOW: threading.Semaphore(0)}
        self._stopping = threading.Event()
        self._running: dict[str, threading.Event] = {}  # job id -> set to stop it
        self._threads: list[threading.Thread] = []

    def start(self, beside: Mapping[str, int]) -> None:
        """Begin to take jobs from the queue, with so many threads for the lanes `beside` the usual two."""
        self._counts |= beside
        self._awake = {lane: threading.Semaphore(0) for lane in self._counts}
        for number, lane in enumerate(lane for lane, count in self._counts.items() for _ in range(count)):
            thread = threading.Thread(target=self._work, args=[lane], name=f"jobs-{number}", daemon=True)
            self._threads.append(thread)
            thread.start()
            self.wake()

    def lane(self, kind: str) -> Lane:
        """The lane in which jobs of a kind wait."""
        return self._lane(self._lane_name(kind))

    def threads(self, kind: str) -> int:
        """How many threads run the jobs of a kind's lane."""
        return self._counts[self._lane_name(kind)]

    def wake(self, kind: str | None = None) -> None:
        """Have a thread of each lane look at the queue, or one of the lane of a kind."""
        for lane in self._awake if kind is None else (self._lane_name(kind),):
            self._awake[lane].release()

    def interrupt(self, id: str) -> None:
        """Kill the process of a job, if it runs."""
        if cancelled := self._running.get(id):
            cancelled.set()

    def drain(self) -> None:
        """Begin no more jobs; those that run go on."""
        self._stopping.set()

    def stop(self, patience: float = 10.0) -> None:
        """Kill what runs, put it back into the queue, and wait for the threads, at most for so long [s].

        A thread that calculates by itself cannot be stopped: its job is put back at the next start.
        """
        self.drain()
        for id in list(self._running):
            self.interrupt(id)
        for _ in self._threads:
            self.wake()
        end = time.monotonic() + patience
        for thread in self._threads:
            thread.join(max(0.0, end - time.monotonic()))
        if busy := [thread.name for thread in self._threads if thread.is_alive()]:
            logger.warning("still busy, and left behind: %s", ", ".join(busy))

    def _work(self, lane: str) -> None:
        while not self._stopping.is_set():
            self._awake[lane].acquire()
            try:
                self._empty_queue(lane)
            except DatabaseClosed:
                return  # this thread was left behind when the server stopped
            except Exception:
                logger.exception("The queue of jobs could not be read or written; trying again")
                self._stopping.wait(_PAUSE)
                self.wake()

    def _empty_queue(self, lane: str) -> None:
        while not self._stopping.is_set() and (job := self._database.write(partial(self._claim, lane=lane))):
            mine, start = self._running[job.id], time.monotonic()
            try:
                with logs.caused(job.id):
                    self._execute(job)
            finally:
                self.durations.note(self.lane(job.kind), time.monotonic() - start)
                if self._running.get(job.id) is mine:  # given back, it may run again in another thread by now
                    del self._running[job.id]

    def _claim(self, session: Session, *, lane: str) -> Job | None:
        """Claim a job and register it still in the writer thread: who sees it running can interrupt it."""
        job = repository.claim(session, self._lane(lane))
        if job is not None:
            self._running[job.id] = threading.Event()
        return job

    def _lane_name(self, kind: str) -> str:
        return self.kinds[kind].lane if kind in self.kinds else FAST

    def _lane(self, lane: str) -> Lane:
        """A lane by its name; a kind that nobody registered waits in the fast one."""
        beside = {name: kind.lane for name, kind in self.kinds.items() if kind.lane != FAST}
        if lane == FAST:
            return Lane(tuple(beside))
        return Lane(tuple(name for name, its in beside.items() if its == lane), is_common=False)

    def _execute(self, job: Job) -> None:
        """Run a claimed job to whatever end."""
        cancelled = self._running[job.id]
        if self._stopping.is_set():  # it was claimed while `stop` went through the running jobs
            cancelled.set()
        logger.info("job %s (%s) begins", job.id, job.kind, extra={"job": job.id})
        batch = self._worker.batch()
        context = JobContext(job, self._database, batch, self._limits, self._events, cancelled)
        publish(self._events, job, "running")
        try:
            with closing(context):
                completion = self.kinds[job.kind].handler(job, context)
            self._complete(job, context, completion)
        except JobCancelled:
            self._give_back(job, job.crashes)  # unless somebody has cancelled it: then it is no longer held
        except JobRests:
            self._rest(job)
        except JobCrashed as error:
            self._crashed(job, context, error)
        except JobFailed as verdict:
            self._fail(job, context, self._describe(verdict.cause), verdict.completion)
        except (DeadlineExceeded, MemoryExceeded) as error:
            self._fail(job, context, self._describe(error))
        except Exception as error:
            logger.exception("Job %s (%s) failed unexpectedly", job.id, job.kind)
            self._fail(job, context, self._describe(error))

    def _complete(self, job: Job, context: JobContext, completion: Completion) -> None:
        def unit(session: Session) -> bool:
            if not repository.end(session, job, "done", context.log, progress=1.0):
                return False
            repository.set_result(session, job.id, completion(session))
            return True

        if self._database.write(unit):
            publish(self._events, job, "done")

    def _crashed(self, job: Job, context: JobContext, error: JobCrashed) -> None:
        """Try again: another process may have been to blame, such as one that took the machine's memory."""
        if self._stopping.is_set():  # its process was ended with the others
            self._give_back(job, job.crashes)
            return
        crashes = job.crashes + 1
        logger.warning("Job %s (%s) crashed, time %d: %s", job.id, job.kind, crashes, error)
        if crashes < MAX_CRASHES:
            self._give_back(job, crashes)
        else:
            self._fail(job, context, self._describe(error), crashes=crashes)

    def _give_back(self, job: Job, crashes: int) -> None:
        if self._database.write(lambda session: repository.give_back(session, job, crashes)):
            publish(self._events, job, "queued")

    def _rest(self, job: Job) -> None:
        lane = self.lane(job.kind)
        if self._database.write(lambda session: repository.rest(session, job, lane)):
            publish(self._events, job, "queued")
            self.wake(job.kind)

    def _fail(
        self,
        job: Job,
        context: JobContext,
        problem: Problem,
        completion: Callable[[Session], None] | None = None,
        **more: object,
    ) -> None:
        def unit(session: Session) -> bool:
            if not repository.end(session, job, "failed", context.log, problem=problem, **more):
                return False
            if completion is not None:
                completion(session)
            if kind := self.kinds.get(job.kind):
                kind.on_failure(session, job, problem)
            return True

        if self._database.write(unit):
            publish(self._events, job, "failed", problem=problem)
