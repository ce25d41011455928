"""The interfaces that workers implement."""

import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol, TypeVar, TypeVarTuple

from app.settings.machines import Lane as Lane
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

GEOMETRY: Final = "geometry"
ANALYSIS: Final = "analysis"
UNLIMITED = sys.maxsize
"""Capacity of a worker that does not limit the number of simultaneous jobs."""


@dataclass(frozen=True)
class Limits:
    """The longest time of one run [s], and its memory in addition to the program itself [MiB].

    `memory_setting` is the name of the operator's setting of this memory; empty if it is fixed.
    """

    deadline: float = 60.0
    memory_mb: int = 3072
    memory_setting: str = ""

    @property
    def memory(self) -> str:
        """Return the memory limit in words."""
        setting = f", which the operator may raise ({self.memory_setting})" if self.memory_setting else ""
        return f"{self.memory_mb} MiB of memory{setting}"


def shares_process(function: Callable[..., object], args: tuple[object, ...]) -> bool:
    """Return whether the process of a function may serve another job afterwards, see `may_share`."""
    is_shared: Callable[..., bool] | None = getattr(function, _SHARED, None)
    return is_shared is not None and is_shared(*args)


def may_share(when: Callable[[*Ts], bool]) -> Callable[[Callable[[*Ts], T]], Callable[[*Ts], T]]:
    """Mark a function whose process may serve another job afterwards, if `when` allows it.

    `when` is called with the function's arguments. The process of an unmarked function ends with its job.
    """

    def mark(function: Callable[[*Ts], T]) -> Callable[[*Ts], T]:
        setattr(function, _SHARED, when)
        return function

    return mark


_SHARED = "shares_process"


class Runner(Protocol):
    """Runs functions one after another for one piece of work, within its limits or others."""

    def run(self, function: Callable[[*Ts], T], *args: *Ts, limits: Limits | None = None) -> T:
        """Return the result of the function, or raise its exception; see `Worker.run`."""
        ...


class Batch(Protocol):
    """Runs the functions of one piece of work one after another, called from one thread."""

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = ...,
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Return the result of the function, or raise its exception.

        The function is sent as its module and name; arguments and result are pickled. `on_progress` is
        called in this thread.

        Raises
        ------
        WorkerError
            If the function did not finish; the class of the error gives the reason.
        """
        ...

    def close(self) -> None:
        """End all running functions and accept no more."""
        ...


class Worker(Batch, Protocol):
    """Runs functions independently of each other, called from any number of threads."""

    def answers(self) -> bool:
        """Return whether a function would find a live process.

        If there is none, one is started. The call never blocks.
        """
        ...


class BatchWorker(Worker, Protocol):
    """A worker that can run all functions of a piece of work in one process."""

    def capacity(self, lane: Lane) -> int:
        """Return how many functions of a lane could start now; 0 if they would wait. It never blocks."""
        ...

    def batch(self, lane: Lane = GEOMETRY) -> Batch:
        """Return a batch that runs functions of a lane in one process, as long as each succeeds.

        If a function crashes, takes too long, uses too much memory, is cancelled or raises, its process ends,
        and the next function gets a new one. Close the batch at the end.
        """
        ...
