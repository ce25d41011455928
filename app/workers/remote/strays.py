"""Tasks that no machine works on, by what the scheduler says of them at each look.

Dask keeps a task whose machine has gone before it came there, in case that machine returns. Ours never do: a
machine that connects again has another address. So such a task would be waited for without end.
"""

from __future__ import annotations

from collections.abc import Mapping

_HELD = ("processing", "memory", "erred")  # on a machine, or at its end
_WITHOUT_MACHINE = "no-worker"
_ON_ITS_WAY = 120.0  # how long a task of 1 GiB may take to the scheduler [s]


class Strays:
    """Which tasks are lost, and why."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}  # when the scheduler was first seen without a task [s]
        self._why: dict[str, str] = {}

    def note(self, states: Mapping[str, str | None], now: float) -> None:
        """Judge all tasks by their states at a look; None is one that the scheduler does not know."""
        outside = [key for key, state in states.items() if state not in _HELD]
        self._since = {key: self._since.get(key, now) for key in outside}
        self._why = {
            key: why for key in outside if (why := self._reason(states[key], now - self._since[key]))
        }

    def why(self, key: str) -> str | None:
        """The reason why a task is lost; None if it is not."""
        return self._why.get(key)

    def _reason(self, state: str | None, seconds: float) -> str | None:
        if state == _WITHOUT_MACHINE:
            return "the machine that should run it has gone"
        return "the scheduler does not have it" if seconds > _ON_ITS_WAY else None
