"""Processes that serve one request after another, for work that is short compared with a fork."""

import threading
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar, TypeVarTuple, cast

from app.workers.base import Limits
from app.workers.messages import Request
from app.workers.prefork import fork_server
from app.workers.processes import JobProcess
from app.workers.threads import ONE_THREAD
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

REUSE = 100  # largest number of requests for one process, which limits leaks


class WarmProcesses:
    """Runs functions in processes that are forked from one with light modules loaded, and reused.

    A process takes another request only if the last one returned normally. After a crash, a time-out, too
    much memory or a cancellation only the process concerned ends.

    Args:
        preload: leaf modules; a package such as `numpy` would be imported with everything in it.
        spares: number of idle processes.
        reuse: largest number of requests for one process.
    """

    def __init__(
        self,
        preload: Sequence[str],
        *,
        spares: int = 1,
        reuse: int = REUSE,
        environment: Mapping[str, str] = ONE_THREAD,
    ) -> None:
        self._forkserver = fork_server(preload, environment)
        self._spares, self._reuse = spares, reuse
        self._lock = threading.Lock()
        self._closed = False
        self._served: dict[JobProcess, int] = {}  # number of requests of each live process
        self._idle = [self._forked() for _ in range(spares)]

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function in an idle process; see `Worker.run`."""
        process = self._started(Request.of(function, args, limits, reusable=True))
        try:
            outcome = process.finish(limits, on_progress, cancelled)
        finally:
            self._put_back(process)
        return cast(T, outcome.result())

    def answers(self) -> bool:
        """Return whether the fork server is alive; if it has died, it is restarted."""
        if self._forkserver.is_alive():
            return True
        if not self._forkserver.is_stopped() and self._lock.acquire(blocking=False):
            try:
                self._idle.append(self._forked())
            finally:
                self._lock.release()
        return False

    def close(self) -> None:
        """Kill all processes; running functions end with JobCrashed."""
        self._closed = True
        self._forkserver.close()  # before the lock, which a thread waiting for a stopped fork server may hold
        with self._lock:
            for process in self._idle:
                process.kill()
            self._idle.clear()

    def _forked(self) -> JobProcess:
        process = self._forkserver.fork()
        self._served[process] = 0
        return process

    def _started(self, request: Request) -> JobProcess:
        """Pass the request to an idle process; replace one that has died."""
        with self._lock:
            process = self._idle.pop() if self._idle else self._forked()
        try:
            process.start(request)
        except OSError:  # the process was killed while it waited
            self._put_back(process)
            with self._lock:
                process = self._forked()
            process.start(request)
        return process

    def _put_back(self, process: JobProcess) -> None:
        """Keep a process that may be used again; at least one process waits for the next request."""
        with self._lock:
            self._served[process] += 1
            is_kept = (
                process.reusable
                and self._served[process] < self._reuse
                and len(self._idle) < self._spares
                and not self._closed
            )
            if is_kept:
                self._idle.append(process)
                return
            del self._served[process]
            if not self._idle and not self._closed:
                self._idle.append(self._forked())
        process.kill()
