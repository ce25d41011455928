"""A server's connection to the scheduler, restored after a break, and the free slots of the machines."""

from __future__ import annotations

import logging
import queue
import threading
import time
import uuid
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress

from distributed import Future, KilledWorker, Security

from app.workers.base import Lane
from app.workers.errors import JobCancelled, WorkerLost
from app.workers.messages import Outcome
from app.workers.remote.client import BoundedClient
from app.workers.remote.label import label
from app.workers.remote.strays import NeverBegun, Strays
from app.workers.remote.wire import Order, Places, carry_out, places
from templates.core.progress import Reporter

logger = logging.getLogger(__name__)

LANES: tuple[Lane, ...] = ("geometry", "analysis")
_GLANCE = 0.05  # time between two checks whether the job was cancelled [s]
_LOOK = 0.25  # time between two polls of the slots of all machines [s]
_PATIENCE = 10.0  # longest time for the scheduler to answer a poll [s]
_PAUSE = 1.0  # time before the next connection attempt [s]
_TURNS = 5  # attempts to send an order, if machines are lost before it arrives
_FETCH = 120.0  # longest time to receive a result [s]

Messages = queue.SimpleQueue[tuple[float, str] | None]
"""Messages of a task: its progress; None at its end."""


class Cluster:
    """The machines behind a scheduler that run the same program.

    A separate thread connects and polls, so no caller waits for a scheduler that does not answer. The tasks
    of this server are counted at once, and those of other servers as of the latest poll.
    """

    def __init__(self, address: str, security: Security, program: str) -> None:
        self.address = address
        self._security = security
        self._labels: Mapping[Lane, str] = {lane: label(lane, program) for lane in LANES}
        self._name = uuid.uuid4().hex
        self._topic = f"progress-{self._name}"
        self._listeners: dict[str, Messages] = {}  # by the key of a task
        self._client: BoundedClient | None = None
        self._places: dict[Lane, dict[str, Places]] = {}
        self._strays = Strays()
        self._own: Counter[tuple[Lane, str]] = Counter()
        self._changed = threading.Condition()
        self._closed = threading.Event()
        self._failure = "connecting"  # outcome of the latest connection attempt
        self._thread = threading.Thread(target=self._work, name="scheduler", daemon=True)
        self._thread.start()

    def size(self, lane: Lane) -> int:
        """Return how many functions of a lane the machines can run at the same time."""
        return sum(there.size for there in self._places.get(lane, {}).values())

    def free(self, lane: Lane) -> int:
        """Return how many more functions of a lane the machines could start now."""
        with self._changed:
            return sum(max(0, count) for count in self._free(lane).values())

    def why_silent(self) -> str:
        """Return the reason why no machine runs functions, if none does."""
        if not self._thread.is_alive():
            return f"the thread that connects to {self.address} has ended: start this server again"
        if (client := self._client) is None or client.status != "running":
            return f"no connection to the scheduler {self.address} ({self._failure})"
        return f"no machine of this program is connected to the scheduler {self.address}"

    def run(
        self,
        lane: Lane,
        order: Order,
        preferred: str | None,
        on_progress: Reporter | None,
        cancelled: threading.Event | None,
    ) -> tuple[Outcome, str]:
        """Wait for a slot, preferably on a given machine, run an order there, and return the machine.

        Raises
        ------
        JobCancelled
            If the job was cancelled.
        WorkerLost
            If the machine or the scheduler was lost during the run, or several machines before the order
            arrived.
        """
        cancelled = cancelled or threading.Event()
        for _ in range(_TURNS):
            with suppress(NeverBegun):
                return self._run_once(lane, order, preferred, on_progress, cancelled)
        raise WorkerLost(f"{_TURNS} machines in succession stopped before the work reached them")

    def _run_once(
        self,
        lane: Lane,
        order: Order,
        preferred: str | None,
        on_progress: Reporter | None,
        cancelled: threading.Event,
    ) -> tuple[Outcome, str]:
        """Run an order on one machine; raises NeverBegun if the machine is lost before the order arrives."""
        with self._place(lane, preferred, cancelled) as (client, machine):
            try:
                return self._run_there(client, lane, order, machine, on_progress, cancelled), machine
            except (JobCancelled, NeverBegun):
                raise
            except Exception as error:
                if client.status == "running" and not isinstance(error, WorkerLost):
                    raise
                if self._closed.is_set():  # this server itself has disconnected
                    raise JobCancelled from None
                if client.status == "running":
                    raise
                raise WorkerLost("the scheduler has disconnected") from error

    def close(self) -> None:
        """Disconnect from the scheduler; running functions are killed there."""
        self._closed.set()
        with self._changed:
            self._changed.notify_all()
        self._thread.join(_PAUSE)  # a connection attempt may take longer

    def _run_there(
        self,
        client: BoundedClient,
        lane: Lane,
        order: Order,
        machine: str,
        on_progress: Reporter | None,
        cancelled: threading.Event,
    ) -> Outcome:
        key = f"{lane}-{self._name}-{uuid.uuid4().hex}"
        messages = self._listeners[key] = Messages()
        try:
            future = self._submit(client, lane, key, order, machine)
            try:
                future.add_done_callback(lambda _: messages.put(None))
                self._follow(client, future, messages, on_progress, cancelled)
                return _result(future)
            finally:
                future.release()  # no longer wanted; if it runs, its process is killed
        finally:
            del self._listeners[key]

    def _submit(
        self, client: BoundedClient, lane: Lane, key: str, order: Order, machine: str
    ) -> Future[Outcome]:
        return client.submit(
            carry_out,
            key,
            order,
            self._topic,
            key=key,
            pure=False,
            retries=0,
            resources={self._labels[lane]: 1},
            workers=[machine],  # only this one; Dask would use any machine, even with another program
        )

    def _follow(
        self,
        client: BoundedClient,
        future: Future[Outcome],
        messages: Messages,
        on_progress: Reporter | None,
        cancelled: threading.Event,
    ) -> None:
        """Pass on the progress until the task has ended."""
        while True:
            if cancelled.is_set() or self._closed.is_set():
                raise JobCancelled
            if client.status != "running" or future.status in ("lost", "cancelled"):
                raise WorkerLost("the scheduler has disconnected")
            self._strays.check(str(future.key))
            try:
                message = messages.get(timeout=_GLANCE)
            except queue.Empty:
                continue
            if message is None:
                if client.status != "running" or future.status in ("lost", "cancelled"):
                    continue  # it has not ended, but its result can no longer arrive
                return
            if on_progress is not None:
                on_progress(*message)

    @contextmanager
    def _place(
        self, lane: Lane, preferred: str | None, cancelled: threading.Event
    ) -> Iterator[tuple[BoundedClient, str]]:
        """Reserve a free slot of a lane, and return the client and the address of the machine."""
        with self._changed:
            while (machine := self._best(lane, preferred)) is None or (client := self._client) is None:
                if cancelled.is_set() or self._closed.is_set():
                    raise JobCancelled
                self._changed.wait(_GLANCE)
            self._own[lane, machine] += 1
        try:
            yield client, machine
        finally:
            with self._changed:
                self._own[lane, machine] -= 1
                self._own += Counter()  # removes entries with a count of zero
                self._changed.notify_all()

    def _best(self, lane: Lane, preferred: str | None) -> str | None:
        free = {machine: count for machine, count in self._free(lane).items() if count > 0}
        return preferred if preferred in free else max(free, key=free.__getitem__, default=None)

    def _free(self, lane: Lane) -> dict[str, int]:
        if self._client is None or self._client.status != "running":
            return {}  # the polled data are outdated
        there = self._places.get(lane, {}).items()
        return {machine: its.size - its.of_others - self._own[lane, machine] for machine, its in there}

    def _work(self) -> None:
        """Connect, poll until the connection breaks, and connect again."""
        is_logged = False
        while not self._closed.is_set():
            try:
                with self._connected() as client:
                    logger.warning("connected to the scheduler %s", self.address)
                    is_logged, self._failure = False, "the connection is lost"
                    while client.status == "running" and not self._closed.is_set():
                        self._look_around(client)
                        self._closed.wait(_LOOK)
            except Exception as error:  # after any error no job can be sent until it is resolved
                self._failure = str(error) or type(error).__name__
                if not is_logged:
                    logger.warning("no connection to the scheduler %s: %s", self.address, error)
                is_logged = True
            self._closed.wait(_PAUSE)

    @contextmanager
    def _connected(self) -> Iterator[BoundedClient]:
        """Open a client, and close it when its scheduler is lost, because its futures are useless then."""
        client = BoundedClient(self.address, self._security)
        try:
            client.subscribe_topic(self._topic, self._hear)
            self._client = client
            yield client
        finally:
            self._client = None
            with self._changed:
                self._places = {}
            client.end()

    def _hear(self, event: tuple[float, tuple[str, float, str]]) -> None:
        key, fraction, text = event[1]
        if listener := self._listeners.get(key):
            listener.put((fraction, text))

    def _look_around(self, client: BoundedClient) -> None:
        async def look() -> tuple[dict[Lane, dict[str, Places]], dict[str, str | None]]:
            if (scheduler := client.scheduler) is None:
                raise ConnectionError("the connection is lost")
            keys = list(self._listeners)
            states = await scheduler.get_task_status(keys=keys) if keys else {}
            return await client.run_on_scheduler(places, labels=self._labels, own=self._name), states

        seen, states = client.sync(look, callback_timeout=_PATIENCE)
        with self._changed:
            self._places = seen
            self._changed.notify_all()
        self._strays.note(
            states, time.monotonic()
        )  # last, so that a caller that needs another slot sees the new ones


def _result(future: Future[Outcome]) -> Outcome:
    try:
        return future.result(timeout=_FETCH)
    except KilledWorker:
        raise WorkerLost("the machine that ran it has disconnected") from None
    except (CancelledError, OSError, TimeoutError) as error:
        raise WorkerLost(str(error) or type(error).__name__) from error
