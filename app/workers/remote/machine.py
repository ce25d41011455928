"""The program of `crankwright worker`: a Dask worker whose threads wait for isolated processes.

Dask's worker never imports the geometry kernel, because it only passes packed bytes on. If the scheduler is
lost, all running jobs are killed, and the machine reconnects as soon as a scheduler answers.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from distributed import Security, Status, Worker

from app.settings import Settings
from app.workers.base import Lane
from app.workers.errors import WorkerError
from app.workers.local import Batch, LocalProcesses
from app.workers.messages import ErrorMessage, Outcome, ResultMessage, pack
from app.workers.remote.label import label, program
from app.workers.remote.network import configure, security
from app.workers.remote.wire import Order, check_size
from templates.core.progress import Reporter

logger = logging.getLogger(__name__)

_GLANCE = 0.05  # time between two checks whether a task is still wanted [s]
_IDLE = 5.0  # how long a process waits for the next function of its batch [s]
_PAUSE = 0.5  # time before the machine reconnects [s]
_START = 20.0  # longest wait for a scheduler before a new attempt [s]
_END = 10.0  # longest time to disconnect from a scheduler [s]
_WANTED = ("executing", "long-running")


class Processes:
    """The processes of a machine; those of batches are kept for a while, at most one for each slot."""

    def __init__(self, places: int) -> None:
        self._local = LocalProcesses()
        self._places = places
        self._lock = threading.Lock()
        self._kept: dict[str, tuple[Batch, float]] = {}  # with the time of last use, latest last

    def outcome(self, order: Order, on_progress: Reporter | None, unwanted: threading.Event) -> Outcome:
        """Return the outcome of a request, run in a separate process or in that of its batch."""
        if order.batch is None:
            return self._local.outcome(order.request, on_progress, unwanted)
        batch = self._taken(order.batch)
        try:
            return batch.outcome(order.request, on_progress, unwanted)
        finally:
            self._keep(order.batch, batch)

    def close_idle(self, since: float = _IDLE, most: int | None = None) -> None:
        """End processes that have been idle for this time [s], and the oldest ones beyond this number."""
        now, most = time.monotonic(), self._places if most is None else most
        with self._lock:
            names = list(self._kept)
            surplus = names[: max(0, len(names) - most)]
            old = [name for name in names if name in surplus or now - self._kept[name][1] > since]
            closing = [self._kept.pop(name)[0] for name in old]
        for batch in closing:
            batch.close()

    def close(self) -> None:
        """Kill all processes."""
        self._local.close()
        self.close_idle(most=0)

    def _taken(self, name: str) -> Batch:
        with self._lock:
            kept = self._kept.pop(name, None)
        return kept[0] if kept else self._local.batch()

    def _keep(self, name: str, batch: Batch) -> None:
        with self._lock:
            self._kept[name] = batch, time.monotonic()
        self.close_idle()


class Machine(Worker):
    """A Dask worker that runs orders in processes, and kills them when no server waits for them any more."""

    def __init__(
        self, address: str, processes: Processes, lanes: Mapping[Lane, int], security: Security
    ) -> None:
        places = {label(lane, program()): float(count) for lane, count in lanes.items() if count}
        super().__init__(
            address,
            nthreads=sum(lanes.values()),
            memory_limit=0,
            resources=places,
            dashboard=False,
            dashboard_address="127.0.0.1:0",
            security=security,
        )
        self._isolated = processes
        self._running: dict[
            str, threading.Event
        ] = {}  # key of a task -> event set when it is no longer wanted
        self._watching = threading.Event()
        threading.Thread(target=self._watch, name="unwanted", daemon=True).start()

    def carry_out(self, key: str, order: Order, topic: str) -> Outcome:
        """Return the outcome of an order, run in a thread of this worker; a crash is an outcome too."""
        unwanted = self._running[key] = threading.Event()
        reporter = self._reporter(key, topic) if order.is_heard else None
        try:
            outcome = self._isolated.outcome(order, reporter, unwanted)
            check_size(outcome.value if isinstance(outcome, ResultMessage) else outcome.error)
        except WorkerError as error:
            return ErrorMessage(pack(error))
        finally:
            del self._running[key]
        return outcome

    def end_watch(self) -> None:
        """End the thread that checks for abandoned tasks; call this once the worker is closed."""
        self._watching.set()

    def _reporter(self, key: str, topic: str) -> Reporter:
        return lambda fraction, text: self.log_event(topic, (key, float(fraction), text))

    def _watch(self) -> None:
        """Kill the processes whose task was cancelled or whose server or scheduler is lost."""
        while not self._watching.wait(_GLANCE):
            is_open = self.status in (Status.running, Status.paused)
            for key, unwanted in list(self._running.items()):
                task = self.state.tasks.get(key)
                if not is_open or task is None or task.state not in _WANTED:
                    unwanted.set()
            self._isolated.close_idle()


@dataclass(frozen=True)
class Service:
    """Serves one scheduler after another until it is asked to stop."""

    settings: Settings
    stopping: asyncio.Event = field(default_factory=asyncio.Event)

    async def run(self) -> None:
        """Connect to a scheduler, and reconnect when it is lost."""
        for number in (signal.SIGTERM, signal.SIGINT):
            asyncio.get_running_loop().add_signal_handler(number, self.stopping.set)
        processes = Processes(sum(self.settings.lanes.values()))
        try:
            while not self.stopping.is_set():
                await self._serve(processes)
                with suppress(TimeoutError):
                    await asyncio.wait_for(self.stopping.wait(), _PAUSE)
        finally:
            processes.close()

    async def _serve(self, processes: Processes) -> None:
        machine = Machine(
            self.settings.engine, processes, self.settings.lanes, security=security(self.settings)
        )
        ends = [asyncio.ensure_future(wait) for wait in (self._connected(machine), self.stopping.wait())]
        try:
            await asyncio.wait(ends, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for end in ends:
                end.cancel()
            try:
                with suppress(TimeoutError):
                    await asyncio.wait_for(machine.close(executor_wait=False), _END)
            finally:
                machine.end_watch()

    async def _connected(self, machine: Machine) -> None:
        """Serve the scheduler while it is connected."""
        logger.warning("connecting to %s", self.settings.engine)
        try:
            await asyncio.wait_for(machine, _START)  # otherwise it would wait for a silent scheduler for ever
            logger.warning("at work for %s: %s", machine.scheduler.address, dict(self.settings.lanes))
            await machine.finished()
        except Exception as error:
            logger.warning("no work from %s: %s", self.settings.engine, str(error) or type(error).__name__)
        logger.warning("the scheduler %s has gone", self.settings.engine)


def main() -> None:
    """Run the worker of this machine with the settings in the environment."""
    settings = Settings()
    logging.basicConfig(format="%(asctime)s %(message)s")
    configure()
    asyncio.run(Service(settings).run())
