"""The worker of a server on one machine: every job in a fresh process, several functions of a job in one."""

import logging
import threading
from collections.abc import Callable, Sequence
from typing import TypeVar, TypeVarTuple, cast

from app.workers.base import GEOMETRY, UNLIMITED, Lane, Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, WorkerError
from app.workers.isolated import ForkServer, JobProcess
from app.workers.messages import Outcome, Request, Returned
from app.workers.threads import ONE_THREAD
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

logger = logging.getLogger(__name__)

# What jobs import: the kernel, every model, and the modules of the job functions. The finite elements are
# imported by those that need them (0.3 s): NGSolve starts threads at once, which a fork would not have.
KERNEL = ("cad.regenerate", "cad.models", "app.solids.builds", "app.solids.finding")


class LocalProcesses:
    """Runs functions in processes that are forked from one with the geometry modules loaded.

    One process is kept waiting for the next job, because a fork of such a large process is not free.
    """

    def __init__(self, preload: Sequence[str] = KERNEL) -> None:
        self._forkserver = ForkServer(preload, ONE_THREAD)
        self._lock = threading.Lock()
        self._spare = self._forkserver.fork()

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function in a process of its own; see `Worker.run`."""
        return cast(T, self.outcome(Request.of(function, args, limits), on_progress, cancelled).result())

    def outcome(
        self, request: Request, on_progress: Reporter | None, cancelled: threading.Event | None
    ) -> Outcome:
        """Run a packed function in a process of its own; see `JobProcess.finish`."""
        return self.started(request).finish(request.limits, on_progress, cancelled)

    def batch(self, lane: Lane = GEOMETRY) -> "Batch":
        """Run several functions in one process; see `BatchWorker.batch`."""
        return Batch(self.started)

    def capacity(self, lane: Lane) -> int:
        """The queue has as many threads as this machine shall run jobs."""
        return UNLIMITED

    def answers(self) -> bool:
        """Whether the forkserver is alive, and has forked the process that waits for the next job."""
        if not self._forkserver.is_alive():
            if not self._forkserver.is_stopped() and self._lock.acquire(blocking=False):
                try:
                    self._spare = self._forkserver.fork()  # starts it again
                finally:
                    self._lock.release()
            return False
        return self._spare.is_born()

    def close(self) -> None:
        """Kill all processes; jobs that still run end with JobCrashed."""
        self._forkserver.close()  # before the lock, which who waits for a stopped forkserver may hold
        with self._lock:
            self._spare.kill()

    def started(self, request: Request) -> JobProcess:
        """Give the job to the process that waits for it, and have the next one forked meanwhile."""
        with self._lock:
            process, self._spare = self._spare, self._forkserver.fork()
        try:
            process.start(request)
        except OSError:  # something killed it while it waited
            process = self._forkserver.fork()
            process.start(request)
        return process


MOST_IN_BATCH = 100  # functions that one process runs: what leaks in it ends with it


class Batch:
    """Runs functions in one process, as long as each returns.

    Its process is given up after whatever did not return: the kernel may be in any state then. If it had run
    other functions before, the same one runs once more in a new process, whose answer counts. So no function
    fails for what another has left behind.
    """

    def __init__(self, started: Callable[[Request], JobProcess]) -> None:
        self._started = started
        self._process: JobProcess | None = None
        self._count = 0

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function in the process of this batch, or in a new one; see `Worker.run`."""
        request = Request.of(function, args, limits, reusable=True)
        return cast(T, self.outcome(request, on_progress, cancelled).result())

    def outcome(
        self, request: Request, on_progress: Reporter | None, cancelled: threading.Event | None
    ) -> Outcome:
        """Run a packed, reusable function as `run` does; see `JobProcess.finish`."""
        if (process := self._taken()) is not None:
            try:
                process.start(request)
                outcome = self._finished(process, request.limits, on_progress, cancelled)
            except (JobCancelled, DeadlineExceeded):
                raise
            except (OSError, WorkerError) as error:  # it died, maybe while it waited
                logger.info("once more in a new process: %s", error)
            else:
                if isinstance(outcome, Returned):
                    return outcome
                logger.info("once more in a new process: its predecessors may be to blame")
        self._count = 0
        return self._finished(self._started(request), request.limits, on_progress, cancelled)

    def close(self) -> None:
        """End the process, if one waits."""
        if (process := self._taken()) is not None:
            process.kill()

    def _taken(self) -> JobProcess | None:
        process, self._process = self._process, None
        return process

    def _finished(
        self,
        process: JobProcess,
        limits: Limits,
        on_progress: Reporter | None,
        cancelled: threading.Event | None,
    ) -> Outcome:
        """The outcome of a process; it is kept if it returned a result and may run another function."""
        outcome = process.finish(limits, on_progress, cancelled)
        self._count += 1
        if isinstance(outcome, Returned) and process.reusable and self._count < MOST_IN_BATCH:
            self._process = process
        else:
            process.kill()
        return outcome
