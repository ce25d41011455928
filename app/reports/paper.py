"""The press: reports are typeset in a process each, which can be stopped, and few at a time."""

from __future__ import annotations

from collections.abc import Mapping
from threading import BoundedSemaphore
from typing import Any

from app.reports.typesetting import Pictures, typeset
from app.workers.base import Limits, Worker

AT_ONCE = 2  # reports that are typeset at the same time; others wait
LIMITS = Limits(deadline=60.0, memory_mb=1024)


class Press:
    """Typesets reports."""

    def __init__(self, worker: Worker) -> None:
        self._worker = worker
        self._free = BoundedSemaphore(AT_ONCE)

    def print(self, report: Mapping[str, Any], pictures: Pictures) -> bytes:
        """A report as PDF; equal reports give equal bytes. It waits, so call it in a thread.

        Raises
        ------
        DeadlineExceeded, MemoryExceeded, JobCrashed
            If the typesetter was stopped.
        """
        with self._free:
            return self._worker.run(typeset, report, pictures, limits=LIMITS)
