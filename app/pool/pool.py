"""The bounded pool in which expensive calculations run: a queue with admission, turns by client, and lanes.

Separate threads wait for the processes, so that neither the event loop nor the threads of routes do: a route
awaits `Calculation.future`, and a thread that needs the result blocks on it.
"""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Literal, TypeVarTuple

from app.pool.errors import TooManyCalculations
from app.pool.turns import Turns, first, last_of_the_greediest
from app.workers.base import Limits, Worker
from app.workers.errors import JobCancelled
from templates.core.progress import Reporter

Ts = TypeVarTuple("Ts")
Lane = Literal["answers", "jobs"]

RETRY_AFTER = 5  # advised time before a retry if too many wait [s]


class Calculation:
    """A calculation that waits or runs; its `future` receives the result."""

    def __init__(
        self, function: Callable[..., object], args: tuple[object, ...], client: str, turn: int, lane: Lane
    ) -> None:
        self.function, self.args = function, args
        self.client, self.turn, self.lane = client, turn, lane
        self.future: Future[Any] = Future()  # the submitter knows the type of the result
        self.cancelled = threading.Event()
        self._listener: Reporter | None = None
        self._latest: tuple[float, str] | None = None

    def listen(self, listener: Reporter) -> None:
        """Call a function with the progress from now on, beginning with the latest.

        It runs in a thread of the pool.
        """
        self._listener = listener
        if self._latest is not None:
            listener(*self._latest)

    def progress(self, fraction: float, text: str) -> None:
        """Record the progress of the calculation."""
        self._latest = fraction, text
        if self._listener is not None:
            self._listener(fraction, text)


class CalculationPool:
    """Runs as many calculations at a time as there are cores, plus the long ones that became jobs.

    Args:
        worker: runs the calculations; the pool owns it.
        size: number of simultaneous calculations for waiting clients.
        waiting: largest number of waiting calculations.
        limits: limits of one calculation.
    """

    def __init__(self, worker: Worker, size: int, waiting: int, limits: Limits) -> None:
        self.size, self.most_waiting = size, waiting
        self._worker, self._limits = worker, limits
        self._capacity: dict[Lane, int] = {"answers": size, "jobs": max(1, size // 2)}
        self._changed = threading.Condition()
        self._queue: list[Calculation] = []
        self._active: list[Calculation] = []
        self._turns = Turns()
        self._closed = False
        self._threads = [
            threading.Thread(target=self._work, name=f"calculations-{number}", daemon=True)
            for number in range(sum(self._capacity.values()))
        ]
        for thread in self._threads:
            thread.start()

    @property
    def most_jobs(self) -> int:
        """Return the number of calculations that may run at the same time as jobs."""
        return self._capacity["jobs"]

    @property
    def running(self) -> int:
        """Return the number of running calculations."""
        return len(self._active)

    @property
    def waiting(self) -> int:
        """Return the number of waiting calculations."""
        return len(self._queue)

    def occupancy(self) -> dict[str, float]:
        """Return the numbers of the pool for `app.observation.metrics`."""
        return {"running": self.running, "waiting": self.waiting, "size": self.size}

    def answers(self) -> bool:
        """Return whether a calculation would find a live process; see `Worker.answers`."""
        return self._worker.answers()

    def submit(
        self, client: str, function: Callable[[*Ts], object], *args: *Ts, lane: Lane = "answers"
    ) -> Calculation:
        """Run a function in a process as soon as it is the client's turn.

        Raises
        ------
        TooManyCalculations
            If the queue is full. If another client has more waiting calculations, its latest is removed
            instead.
        """
        with self._changed:
            if self._closed:
                raise JobCancelled
            loser = self._loser(client) if lane == "answers" else None
            if loser is not None:
                self._queue.remove(loser)
            calculation = Calculation(function, args, client, self._turns.next(client), lane)
            self._queue.append(calculation)
            self._changed.notify_all()
        if loser is not None:
            loser.future.set_exception(TooManyCalculations(RETRY_AFTER))
        return calculation

    def admit(self, client: str) -> None:
        """Refuse what `submit` would refuse now, before the body of the request is received.

        Raises
        ------
        TooManyCalculations
            As raised by `submit`.
        """
        with self._changed:
            self._loser(client)

    def cancel(self, calculation: Calculation) -> None:
        """Cancel a calculation: remove it from the queue, or end its process."""
        calculation.cancelled.set()
        with self._changed:
            is_waiting = calculation in self._queue
            if is_waiting:
                self._queue.remove(calculation)
        if is_waiting:
            calculation.future.set_exception(JobCancelled())

    def keep(self, calculation: Calculation) -> bool:
        """Let a running calculation continue as a job, if there is room; return whether there was."""
        with self._changed:
            if calculation not in self._active or not self._has_room("jobs"):
                return False
            calculation.lane = "jobs"
            self._changed.notify_all()  # its slot is free for another calculation
            return True

    def close(self) -> None:
        """End all calculations; call this before the worker is closed."""
        with self._changed:
            self._closed = True
            ending = [*self._queue, *self._active]
            self._changed.notify_all()
        for calculation in ending:
            self.cancel(calculation)
        for thread in self._threads:
            thread.join()

    def _loser(self, client: str) -> Calculation | None:
        """Return the calculation that must leave the queue for this client; None if the queue is not full."""
        queue = [calculation for calculation in self._queue if calculation.lane == "answers"]
        if len(queue) - self._room("answers") < self.most_waiting:
            return None
        loser = last_of_the_greediest(queue, client)
        if loser is None:
            raise TooManyCalculations(RETRY_AFTER)
        return loser

    def _work(self) -> None:
        while (calculation := self._next()) is not None:
            self._run(calculation)

    def _next(self) -> Calculation | None:
        """Wait for the calculation whose turn it is, and return it; None once the pool is closed."""
        with self._changed:
            while not self._closed:
                ready = [c for c in self._queue if self._has_room(c.lane)]
                running = Counter(c.client for c in self._active)
                if (calculation := first(ready, running)) is not None:
                    self._queue.remove(calculation)
                    self._active.append(calculation)
                    self._turns.taken(calculation.turn)
                    return calculation
                self._changed.wait()
        return None

    def _run(self, calculation: Calculation) -> None:
        try:
            result = self._worker.run(
                calculation.function,
                *calculation.args,
                limits=self._limits,
                on_progress=calculation.progress,
                cancelled=calculation.cancelled,
            )
        except BaseException as error:  # any error is passed to the waiting caller
            self._ended(calculation)
            calculation.future.set_exception(error)
        else:
            self._ended(calculation)
            calculation.future.set_result(result)

    def _ended(self, calculation: Calculation) -> None:
        with self._changed:
            self._active.remove(calculation)
            self._turns.forget({c.client for c in (*self._queue, *self._active)})
            self._changed.notify_all()

    def _has_room(self, lane: Lane) -> bool:
        return self._room(lane) > 0

    def _room(self, lane: Lane) -> int:
        return self._capacity[lane] - sum(c.lane == lane for c in self._active)
