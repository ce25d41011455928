"""The worker of a server on one machine: the functions of a job share one process.

The process ends with the job, unless all functions of the job are marked with `app.workers.base.may_share`:
then it is kept for the next such job. Starting a process costs more than building a small solid: it must be
forked, and the kernel then loads some of its parts at first use.
"""

import logging
import threading
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar, TypeVarTuple, cast

from app.workers.base import GEOMETRY, UNLIMITED, Lane, Limits, shares_process
from app.workers.errors import DeadlineExceeded, JobCancelled, WorkerError
from app.workers.messages import Outcome, Request, ResultMessage
from app.workers.prefork import fork_server
from app.workers.processes import JobProcess
from app.workers.threads import ONE_THREAD
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

logger = logging.getLogger(__name__)

# Modules that jobs import: the kernel, every model, and the modules of the job functions. Finite elements
# are imported only by jobs that need them (0.3 s): NGSolve starts threads at once, which a fork would lack.
KERNEL = ("cad.regenerate", "cad.models", "app.solids.builds", "app.solids.analysis_process")


class LocalProcesses:
    """Runs functions in processes that are forked from one with the geometry modules loaded.

    One process is kept ready for the next job, because forking such a large process takes time.
    """

    def __init__(self, preload: Sequence[str] = KERNEL) -> None:
        self._forkserver = fork_server(preload, ONE_THREAD)
        self._lock = threading.Lock()
        self._spare = self._forkserver.fork()
        self._kept: list[IdleProcess] = []
        self._closed = False

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function in a separate process; see `Worker.run`."""
        return cast(T, self.outcome(Request.of(function, args, limits), on_progress, cancelled).result())

    def outcome(
        self, request: Request, on_progress: Reporter | None, cancelled: threading.Event | None
    ) -> Outcome:
        """Run a packed function in a separate process; see `JobProcess.finish`."""
        return self.started(request).finish(request.limits, on_progress, cancelled)

    def batch(self, lane: Lane = GEOMETRY) -> "Batch":
        """Return a batch that runs several functions in one process; see `BatchWorker.batch`."""
        return Batch(self.started, self)

    def capacity(self, lane: Lane) -> int:
        """Return an unlimited capacity, because the queue has as many threads as this machine runs jobs."""
        return UNLIMITED

    def answers(self) -> bool:
        """Return whether the fork server is alive, and has forked the process for the next job."""
        if not self._forkserver.is_alive():
            if not self._forkserver.is_stopped() and self._lock.acquire(blocking=False):
                try:
                    self._spare = self._forkserver.fork()  # restarts the fork server
                finally:
                    self._lock.release()
            return False
        return self._spare.is_born()

    def close(self) -> None:
        """Kill all processes; running jobs end with JobCrashed."""
        self._forkserver.close()  # before the lock, which a thread waiting for a stopped fork server may hold
        with self._lock:
            self._closed = True
            self._spare.kill()
            for used in self._kept:
                used.process.kill()
            self._kept.clear()

    def lend(self) -> "IdleProcess | None":
        """Return the idle process of an earlier job, if there is one."""
        with self._lock:
            return self._kept.pop() if self._kept else None

    def keep(self, used: "IdleProcess") -> None:
        """Keep the process of a job for the next one, or end it if another process is already waiting."""
        with self._lock:
            if len(self._kept) < MOST_KEPT and not self._closed:
                self._kept.append(used)
                return
        used.process.kill()

    def started(self, request: Request) -> JobProcess:
        """Pass the job to the waiting process, and fork the next one meanwhile."""
        with self._lock:
            process, self._spare = self._spare, self._forkserver.fork()
        try:
            process.start(request)
        except OSError:  # the process was killed while it waited
            process = self._forkserver.fork()
            process.start(request)
        return process


MOST_IN_BATCH = 100  # largest number of functions for one process, which limits leaks
MOST_KEPT = 1  # largest number of idle processes kept for another job


class IdleProcess(NamedTuple):
    """A process that has completed some functions, and waits for another."""

    process: JobProcess
    runs: int


class Batch:
    """Runs functions in one process, as long as each returns.

    After a function that did not return, its process is abandoned, because the state of the kernel is
    unknown. If the process had run other functions before, the function runs once more in a new process,
    whose answer counts. So no function fails because of what another one has left behind, in this batch or
    in an earlier one.

    Parameters
    ----------
    started
        Function that passes a request to a new process.
    keeper
        Lends the process of an earlier batch, and takes back the process of this one; None if processes are
        not reused.
    """

    def __init__(
        self, started: Callable[[Request], JobProcess], keeper: "LocalProcesses | None" = None
    ) -> None:
        self._started, self._keeper = started, keeper
        self._process: JobProcess | None = None
        self._count = 0
        self._is_shared = True

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
        is_shared = shares_process(function, args)
        return cast(T, self.outcome(request, on_progress, cancelled, is_shared=is_shared).result())

    def outcome(
        self,
        request: Request,
        on_progress: Reporter | None,
        cancelled: threading.Event | None,
        *,
        is_shared: bool = False,
    ) -> Outcome:
        """Run a packed, reusable function as `run` does; see `JobProcess.finish`.

        `is_shared` states whether its process may also serve other batches.
        """
        self._is_shared = self._is_shared and is_shared
        if (process := self._taken() or self._lent()) is not None:
            try:
                process.start(request)
                outcome = self._finished(process, request.limits, on_progress, cancelled)
            except (JobCancelled, DeadlineExceeded):
                raise
            except (OSError, WorkerError) as error:  # the process died, perhaps while it waited
                logger.info("once more in a new process: %s", error)
            else:
                if isinstance(outcome, ResultMessage):
                    return outcome
                logger.info("once more in a new process: its predecessors may be to blame")
        self._count = 0
        return self._finished(self._started(request), request.limits, on_progress, cancelled)

    def close(self) -> None:
        """Leave the process to the next batch, or end it if other batches may not use it."""
        if (process := self._taken()) is None:
            return
        if self._keeper is not None and self._is_shared:
            self._keeper.keep(IdleProcess(process, self._count))
        else:
            process.kill()

    def _lent(self) -> JobProcess | None:
        """Return the process of an earlier batch, if all functions of this batch may share it."""
        lent = self._keeper.lend() if self._keeper is not None and self._is_shared else None
        if lent is None:
            return None
        self._count = lent.runs
        return lent.process

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
        """Return the outcome of a process.

        The process is kept if it returned a result and may run another function.
        """
        outcome = process.finish(limits, on_progress, cancelled)
        self._count += 1
        if isinstance(outcome, ResultMessage) and process.reusable and self._count < MOST_IN_BATCH:
            self._process = process
        else:
            process.kill()
        return outcome
