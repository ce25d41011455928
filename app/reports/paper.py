"""Typeset reports and drawings, only a few at a time, each in a process that can be stopped."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from dataclasses import asdict
from threading import BoundedSemaphore, Lock
from typing import cast

from app.reports.content import Report
from app.reports.errors import Unprintable
from app.reports.typesetting import Pictures, ReportAsData, typeset
from app.workers.base import Limits, Worker
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded
from cad.drafting.paper import as_pdf

KEPT = 32 * 2**20  # largest size of the cached drawings [bytes]


class Press:
    """Typesets reports, `at_once` of them at a time, while others wait; it keeps the latest drawings."""

    def __init__(self, worker: Worker, limits: Limits, at_once: int) -> None:
        self._worker, self._limits = worker, limits
        self._free = BoundedSemaphore(at_once)
        self._drawn: OrderedDict[bytes, bytes] = OrderedDict()
        self._lock = Lock()

    def print(self, report: Report, pictures: Pictures) -> bytes:
        """Return a report as PDF; equal reports give equal bytes. The call blocks, so make it in a thread.

        Raises
        ------
        Unprintable
            If the typesetter was stopped, or ran out of memory.
        """
        data = cast(ReportAsData, asdict(report))
        with self._free:
            try:
                return self._worker.run(typeset, data, pictures, limits=self._limits)
            except (DeadlineExceeded, MemoryExceeded, JobCrashed) as error:
                formulas = sum(len(step.formulas) for step in report.steps)
                reason = f"with {formulas} formulas it takes more time or memory than a job may have"
                raise Unprintable(f"this report is too long to print: {reason} ({error})") from error

    def draw(self, svg: bytes) -> bytes:
        """Return a drawing as PDF; equal drawings give equal bytes. The call blocks, so make it in a thread.

        Raises
        ------
        Unprintable
            If the typesetter was stopped, or ran out of memory.
        """
        key = hashlib.sha256(svg).digest()
        with self._lock:
            if key in self._drawn:
                self._drawn.move_to_end(key)
                return self._drawn[key]
        with self._free:
            try:
                pdf = self._worker.run(as_pdf, svg, limits=self._limits)
            except (DeadlineExceeded, MemoryExceeded, JobCrashed) as error:
                raise Unprintable(f"this drawing cannot be typeset; use its SVG or DXF ({error})") from error
        self._keep(key, pdf)
        return pdf

    def _keep(self, key: bytes, pdf: bytes) -> None:
        """Keep a drawing, and drop the drawings that were requested least recently."""
        with self._lock:
            self._drawn[key] = pdf
            while sum(map(len, self._drawn.values())) > KEPT:
                self._drawn.popitem(last=False)
