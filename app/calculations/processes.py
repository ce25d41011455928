"""Calculation processes of two kinds: light ones for templates, others with the design network loaded.

The network imports the geometry kernel, which takes seconds and as much memory as all the rest. So functions
of designs run in processes that are forked from one with these modules loaded. They are started when the
first such function comes: a service whose clients evaluate templates only never has them.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar, TypeVarTuple

from app.workers.base import Limits
from app.workers.pool import WarmProcesses
from templates.core.progress import Reporter

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

SHEETS = ("app.worksheets.checking", "app.worksheets.examining")
LIGHT = ("app.calculations", "app.workers", *SHEETS, "templates")
"""Packages and modules of this program whose functions need no network of designs."""


class CalculationProcesses:
    """The worker of the calculation pool.

    Args:
        light: processes with the templates loaded.
        start: starts those with the network of designs.
    """

    def __init__(self, light: WarmProcesses, start: Callable[[], WarmProcesses]) -> None:
        self._light, self._start = light, start
        self._others: WarmProcesses | None = None
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
        """Run the function in a process that has its modules; see `Worker.run`."""
        worker = self._light if is_light(function.__module__) else self._with_designs()
        return worker.run(function, *args, limits=limits, on_progress=on_progress, cancelled=cancelled)

    def answers(self) -> bool:
        """Return whether a function would find a process that is alive; see `Worker.answers`."""
        return self._light.answers() and (self._others is None or self._others.answers())

    def close(self) -> None:
        """Kill all processes."""
        self._light.close()
        with self._starting:
            self._closed = True
            if self._others is not None:
                self._others.close()

    def _with_designs(self) -> WarmProcesses:
        with self._starting:
            if self._others is None and not self._closed:
                self._others = self._start()
            return self._others or self._light


def is_light(module: str) -> bool:
    """Return whether functions of a module need no network of designs."""
    return not module.startswith("app.") or module.startswith(LIGHT)
