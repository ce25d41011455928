"""The bounded pool in which expensive calculations run: a queue with admission, turns by client, and lanes.

Threads of its own wait for the processes. So neither the event loop nor a thread of a route does: a route
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

RETRY_AFTER = 5  # what to advise when too many wait [s]


class Calculation:
    """A calculation that waits or runs; its `future` holds what comes out."""

    def __init__(
        self, function: Callable[..., object], args: tuple[object, ...], client: str, turn: int, lane: Lane
    ) -> None:
        self.function, self.args = function, args
        self.client, self.turn, self.lane = client, turn, lane
        self.future: Future[Any] = Future()  # whoever submits a function knows what it returns
        self.cancelled = threading.Event()
        self._listener: Reporter | None = None
        self._latest: tuple[float, str] | None = None

    def listen(self, listener: Reporter) -> None:
        """Report progress to a function from now on, starting with the latest.

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
    """As many calculations at a time as there are cores, and beside them the long ones that became jobs.

    Args:
        worker: runs them; it is the pool's own.
        size: calculations that run at the same time while somebody waits for the answer.
        waiting: calculations that may wait.
        limits: of one calculation.
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
        """Return calculations that run."""
        return len(self._active)

    @property
    def waiting(self) -> int:
        """Return calculations that wait."""
        return len(self._queue)

    def occupancy(self) -> dict[str, float]:
        """Return the figures of the pool for `app.observation.metrics`."""
        return {"running": self.running, "waiting": self.waiting, "size": self.size}

    def answers(self) -> bool:
        """Return whether a calculation would find a process that is alive; see `Worker.answers`."""
        return self._worker.answers()

    def submit(
        self, client: str, function: Callable[[*Ts], object], *args: *Ts, lane: Lane = "answers"
    ) -> Calculation:
        """Calculate a function when it is the client's turn.

        Raises
        ------
        TooManyCalculations
            The queue is full. If another client has more waiting than this one, its latest gives way.
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
            As `submit`.
        """
        with self._changed:
            self._loser(client)

    def cancel(self, calculation: Calculation) -> None:
        """Cancel a calculation: remove it from the queue, or end its process if it runs."""
        calculation.cancelled.set()
        with self._changed:
            is_waiting = calculation in self._queue
            if is_waiting:
                self._queue.remove(calculation)
        if is_waiting:
            calculation.future.set_exception(JobCancelled())

    def keep(self, calculation: Calculation) -> bool:
        """Let a running calculation go on as a job, if there is room; return whether there was."""
        with self._changed:
            if calculation not in self._active or not self._has_room("jobs"):
                return False
            calculation.lane = "jobs"
            self._changed.notify_all()  # its place is free for another answer
            return True

    def close(self) -> None:
        """End everything; call it before the worker is closed."""
        with self._changed:
            self._closed = True
            ending = [*self._queue, *self._active]
            self._changed.notify_all()
        for calculation in ending:
            self.cancel(calculation)
        for thread in self._threads:
            thread.join()

    def _loser(self, client: str) -> Calculation | None:
        """Return the calculation to remove in favour of this client; None if the queue is not full."""
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
        """Wait for a calculation whose turn it is; None once the pool is closed."""
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
        except BaseException as error:  # whatever it is belongs to who waits for the result
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
