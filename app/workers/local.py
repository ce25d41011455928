"""The worker of a server on one machine: every job in a fresh process of its own."""

import threading
from collections.abc import Callable, Sequence
from typing import TypeVar, TypeVarTuple, cast

from app.workers.base import Limits
from app.workers.isolated import ForkServer, JobProcess
from app.workers.messages import Request
from app.workers.threads import ONE_THREAD
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")


# What jobs import: the kernel, every model, and the modules of the job functions. The finite elements are
# imported by those that need them (0.3 s): NGSolve starts threads at once, which a fork would not have.
GEOMETRY = ("cad.regenerate", "cad.models", "app.solids.builds", "app.solids.finding")


class LocalProcesses:
    """Runs functions in processes that are forked from one with the geometry modules loaded.

    One process is kept waiting for the next job, because a fork of such a large process is not free.
    """

    def __init__(self, preload: Sequence[str] = GEOMETRY) -> None:
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
        process = self._start(Request(function, args, limits))
        return cast(T, process.finish(limits, on_progress, cancelled))

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

    def _start(self, request: Request) -> JobProcess:
        """Give the job to the process that waits for it, and have the next one forked meanwhile."""
        with self._lock:
            process, self._spare = self._spare, self._forkserver.fork()
        try:
            process.start(request)
        except OSError:  # something killed it while it waited
            process = self._forkserver.fork()
            process.start(request)
        return process
