"""The worker of a team's server: it runs functions on other machines, as `LocalProcesses` does locally."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Callable
from typing import TypeVar, TypeVarTuple, cast

from app.settings import Settings
from app.workers.base import GEOMETRY, Lane, Limits
from app.workers.errors import JobCancelled, WorkerLost
from app.workers.messages import Request
from app.workers.remote.cluster import Cluster
from app.workers.remote.label import program
from app.workers.remote.network import configure, security
from app.workers.remote.wire import Order, check_size
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")


class DaskWorker:
    """Runs functions on the machines of a Dask scheduler that run the same program; see `BatchWorker`.

    It submits a function only when a machine has a free slot. So waiting work stays in the queue of jobs,
    which outlives every process, and not in Dask.
    """

    def __init__(self, cluster: Cluster) -> None:
        self._cluster = cluster

    @classmethod
    def of(cls, settings: Settings) -> DaskWorker:
        """Return the worker for a server's settings; it connects in the background."""
        configure()
        return cls(Cluster(settings.engine, security(settings), program()))

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
        lane: Lane = GEOMETRY,
    ) -> T:
        """Run the function in a separate process; see `Worker.run`."""
        once = DaskBatch(self._cluster, lane)
        return once.run(function, *args, limits=limits, on_progress=on_progress, cancelled=cancelled)

    def batch(self, lane: Lane = GEOMETRY) -> DaskBatch:
        """Return a batch that runs several functions in one process if possible; see `BatchWorker.batch`."""
        return DaskBatch(self._cluster, lane, uuid.uuid4().hex)

    def capacity(self, lane: Lane) -> int:
        """Return the known number of free slots of the lane; 0 without a scheduler."""
        return self._cluster.free(lane)

    def answers(self) -> bool:
        """Return whether there is a machine with the same program."""
        return self._cluster.size(GEOMETRY) > 0

    def why_silent(self) -> str:
        """Return the reason why there is no such machine, if there is none."""
        return self._cluster.why_silent()

    def close(self) -> None:
        """Disconnect from the scheduler; running functions are killed and end with JobCancelled."""
        self._cluster.close()


class DaskBatch:
    """Runs functions one after another on the machine that ran the first, in the process that it kept.

    If that machine has no free slot, or is lost, another one continues with a new process: a batch only
    saves time. An idle process ends by itself after some seconds. Without a name, each function has its own
    process.
    """

    def __init__(self, cluster: Cluster, lane: Lane, name: str | None = None) -> None:
        self._cluster, self._lane, self._name = cluster, lane, name
        self._machine: str | None = None

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function on a machine; see `Worker.run`."""
        request = Request.of(function, args, limits, reusable=self._name is not None)
        check_size(request.task)
        order = Order(request, self._name, is_heard=on_progress is not None)
        outcome, self._machine = self._cluster.run(self._lane, order, self._machine, on_progress, cancelled)
        try:
            return cast(T, outcome.result())
        except JobCancelled:
            if cancelled is not None and cancelled.is_set():
                raise
            raise WorkerLost("the machine that ran it was stopped") from None

    def close(self) -> None:
        """Do nothing, because no function is running and an idle process ends by itself."""
