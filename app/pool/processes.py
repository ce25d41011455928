"""Calculation processes of two kinds: light ones for templates, others with the design network loaded.

The network imports the geometry kernel, which takes seconds and as much memory as everything else. So
functions of designs run in processes forked from a process that has these modules loaded. The processes of
each kind start at the first function for them: a service that evaluates only quick templates never starts
them.

`crankwright serve` loads the network without the kernel, and forks the second kind in advance.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar, TypeVarTuple

from app.workers.base import Limits
from app.workers.errors import JobCancelled
from app.workers.pool import WarmProcesses
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

SHEETS = ("app.worksheets.check", "app.worksheets.examination")
LIGHT = ("app.calculations", "app.workers", *SHEETS, "templates")
"""Packages and modules of this program whose functions do not need the network of designs."""


class CalculationProcesses:
    """The worker of the calculation pool.

    Args:
        light: starts processes with the templates loaded.
        designs: starts processes with the network of designs; None if the light ones have the network too.
    """

    def __init__(
        self, light: Callable[[], WarmProcesses], designs: Callable[[], WarmProcesses] | None = None
    ) -> None:
        self._starts = {True: light}  # key: True for functions without the network of designs
        if designs is not None:
            self._starts[False] = designs
        self._started: dict[bool, WarmProcesses] = {}
        self._starting = threading.Lock()
        self._closed = False

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Run the function in a process that has the required modules; see `Worker.run`."""
        worker = self._processes(is_light(function.__module__))
        return worker.run(function, *args, limits=limits, on_progress=on_progress, cancelled=cancelled)

    def answers(self) -> bool:
        """Return whether a function has a live process, or starts one; see `Worker.answers`."""
        return all(processes.answers() for processes in list(self._started.values()))

    def close(self) -> None:
        """Kill all processes."""
        with self._starting:
            self._closed = True
            for processes in self._started.values():
                processes.close()

    def _processes(self, light: bool) -> WarmProcesses:
        """Return the processes of a kind; start them if there are none.

        Raises
        ------
        JobCancelled
            If the service is stopping.
        """
        with self._starting:
            if self._closed:
                raise JobCancelled
            kind = light or False not in self._starts
            if kind not in self._started:
                self._started[kind] = self._starts[kind]()
            return self._started[kind]


def is_light(module: str) -> bool:
    """Return whether the functions of a module do not need the network of designs."""
    return not module.startswith("app.") or module.startswith(LIGHT)
