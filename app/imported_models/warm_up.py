"""Idle FreeCAD processes, one for each recently drawn file, so that its next drawing is fast.

FreeCAD takes seconds to start, but only a tenth of a second to draw. A process serves only one file, so a
harmful file affects no other. The process ends after a number of drawings, after any failure, and when other
files need its memory.
"""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from collections.abc import Callable

from app.imported_models.freecad import FreeCad
from app.imported_models.freecad_process import FreeCadAnswer, FreeCadProcess
from app.workers.base import Limits
from app.workers.errors import JobCancelled
from cad.errors import GeometryError
from cad.imported_models import Ends

MOST_WARM = 3
MOST_DRAWINGS = 100


class WarmProcesses:
    """Idle FreeCAD processes by the hash of their file."""

    def __init__(self, find: Callable[[], FreeCad], limits: Limits) -> None:
        self.find, self.limits = find, limits
        self._waiting: OrderedDict[str, FreeCadProcess] = OrderedDict()
        self._running = set[FreeCadProcess]()
        self._lock, self._is_closed = threading.Lock(), False

    def ask(
        self,
        sha: str,
        content: Callable[[], bytes],
        do: str,
        given: list[list[str | float]],
        cancelled: threading.Event,
        seconds: float = math.inf,
        ends: Ends | None = None,
    ) -> FreeCadAnswer:
        """Send a request to the process of a file, with a time limit; raises like `FreeCadProcess.ask`."""
        process = self._taken(sha, content)
        try:
            return process.ask(do, given, cancelled, seconds, ends)
        except GeometryError:
            if self._is_closed:  # the process was killed
                raise JobCancelled from None
            raise
        finally:
            self._returned(sha, process)

    def close(self) -> None:
        """End all processes."""
        with self._lock:
            self._is_closed = True
            ending = [*self._waiting.values(), *self._running]
            self._waiting.clear()
        for process in ending:
            process.kill()

    def _taken(self, sha: str, content: Callable[[], bytes]) -> FreeCadProcess:
        with self._lock:
            process = self._waiting.pop(sha, None)
            if process is not None:
                self._running.add(process)
                return process
        process = FreeCadProcess(self.find(), content(), self.limits)
        with self._lock:
            if not self._is_closed:
                self._running.add(process)
                return process
        process.kill()
        raise JobCancelled

    def _returned(self, sha: str, process: FreeCadProcess) -> None:
        leaving = list[FreeCadProcess]()
        with self._lock:
            self._running.discard(process)
            if process.is_sound and process.answers < MOST_DRAWINGS and not self._is_closed:
                if sha in self._waiting:
                    leaving.append(self._waiting.pop(sha))
                self._waiting[sha] = process
                while len(self._waiting) > MOST_WARM:
                    leaving.append(self._waiting.popitem(last=False)[1])
            else:
                leaving.append(process)
        for one in leaving:
            one.kill()
