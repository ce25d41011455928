"""Find tasks that no machine works on, from repeated reports of the scheduler.

If a machine disconnects before its task arrives, Dask keeps the task in case the machine returns. Machines of
this program never return under the same address, so a server would wait forever for such a task.
"""

from __future__ import annotations

from collections.abc import Mapping

from app.workers.errors import WorkerLost

_HELD = ("processing", "memory", "erred")  # on a machine, or at its end
_WITHOUT_MACHINE = "no-worker"
_ON_ITS_WAY = 120.0  # longest time for a task of 1 GiB to reach the scheduler [s]


class NeverBegun(Exception):
    """The machine of a task was lost before the task arrived; another machine may run the task."""


class Strays:
    """The tasks that are on no machine, and since when."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}  # when the scheduler first did not know a task [s]
        self._without_machine: frozenset[str] = frozenset()
        self._lost: frozenset[str] = frozenset()

    def note(self, states: Mapping[str, str | None], now: float) -> None:
        """Record the reported states of all tasks; None means that the scheduler does not know the task."""
        outside = [key for key, state in states.items() if state not in _HELD]
        self._since = {key: self._since.get(key, now) for key in outside}
        self._without_machine = frozenset(key for key in outside if states[key] == _WITHOUT_MACHINE)
        self._lost = frozenset(key for key, since in self._since.items() if now - since > _ON_ITS_WAY)

    def check(self, key: str) -> None:
        """Check that a task is on a machine, or may still be on its way.

        Raises
        ------
        NeverBegun
            If its machine disconnected before the task arrived.
        WorkerLost
            If the scheduler does not know the task.
        """
        if key in self._without_machine:
            raise NeverBegun
        if key in self._lost:
            raise WorkerLost("the scheduler does not know the task")
