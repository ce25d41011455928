"""The report on paper: typeset as PDF by Typst, in a process of its own.

The typesetter gets a fixed document, `report.typ`, and the report as data. Nothing that a user wrote is ever
read as markup: texts come from the data as strings, formulas as MathML whose elements the document knows.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from datetime import datetime
from functools import cache
from pathlib import Path
from threading import BoundedSemaphore
from typing import Any

from app.reports.models import DRAWING, PICTURE
from app.workers.base import Limits, Worker

AT_ONCE = 2  # reports that are typeset at the same time; others wait
LIMITS = Limits(deadline=60.0, memory_mb=1024)

Pictures = Mapping[str, Mapping[str, bytes]]


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
            made: bytes = self._worker.run(typeset, report, pictures, limits=LIMITS)
            return made


def typeset(report: Mapping[str, Any], pictures: Pictures) -> bytes:
    """A report as PDF; runs in a worker's process."""
    import typst  # 30 MB that a server which prints nothing does not need

    models = [{**model, "pictures": _as_svg(pictures.get(model["name"], {}))} for model in report["models"]]
    data = json.dumps({**report, "models": models}, ensure_ascii=True).encode()
    files: Any = {"main": _document(), "data.json": data}
    date = datetime.fromisoformat(report["date"]).replace(microsecond=0)
    made = typst.compile(files, format="pdf", timestamp=date)
    assert isinstance(made, bytes), "one document makes one file"
    return made


@cache
def _document() -> bytes:
    return Path(__file__).with_name("report.typ").read_bytes()


def _as_svg(files: Mapping[str, bytes]) -> dict[str, str]:
    """Pictures as SVG texts, for the typesetter's data is text: a PNG is put into one."""
    told = {"drawing": files[DRAWING].decode()} if DRAWING in files else {}
    if PICTURE in files:
        coded = base64.b64encode(files[PICTURE]).decode()
        told["picture"] = (
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 480" width="640" height="480">'
            f'<image width="640" height="480" href="data:image/png;base64,{coded}"/></svg>'
        )
    return told
