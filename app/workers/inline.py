"""A worker without processes or limits, for tests and debugging; it cannot stop a running function."""

import threading
from collections.abc import Callable
from typing import Self, TypeVar, TypeVarTuple

from app.workers.base import GEOMETRY, UNLIMITED, Lane, Limits
from app.workers.errors import JobCancelled
from templates.core.progress import Reporter, reporting

T = TypeVar("T")
Ts = TypeVarTuple("Ts")


class Inline:
    """Runs functions in the calling thread."""

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        """Call the function; see `Worker.run`."""
        if cancelled is not None and cancelled.is_set():
            raise JobCancelled
        with reporting(on_progress):
            return function(*args)

    def batch(self, lane: Lane = GEOMETRY) -> Self:
        """Return this worker as a batch, which runs all functions in the calling thread."""
        return self

    def capacity(self, lane: Lane) -> int:
        """Return an unlimited capacity, because every calling thread runs its own function."""
        return UNLIMITED

    def answers(self) -> bool:
        """Return True, because the caller's thread runs every function."""
        return True

    def close(self) -> None:
        """Do nothing, because there is nothing to close."""
