"""Shared by the routes of designs: parts of their paths, headers, and the answer once a design is saved."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated

from fastapi import Header, Path, Query, Response
from starlette.concurrency import run_in_threadpool

from app.api.responses import LONGEST, finished, later, patience, written
from app.designs.schemas.designs import Design, MappedDesign, Proposal
from app.designs.service import Designs, SaveResult
from app.jobs.service import Jobs
from app.schemas.problems import refusals

Id = Annotated[str, Path(max_length=64)]
Number = Annotated[int, Path(ge=1, le=10**9)]
Prefer = Annotated[str | None, Header(description="`wait=5` or `respond-async`")]
IfMatch = Annotated[str | None, Header(description='the ETag of the design that was read, such as `"3"`')]
Within = Annotated[
    float | None,
    Query(ge=0, le=LONGEST, description="leave pending what takes longer [s], instead of queueing a job"),
]
CHANGED = {**later(Design), **refusals(404, 429)}


def seconds_waited(prefer: str | None) -> float:
    """Return how long a request waits for expensive steps [s]; at most until the deadline."""
    return patience(prefer, math.inf)


async def answer_saved(
    designs: Designs,
    jobs: Jobs,
    saved: SaveResult,
    prefer: str | None,
    proposals: Sequence[Proposal] | None = None,
) -> Response:
    """Return the design: 200 or 201 if its job ended in time, else 202 with the job in Location."""
    done = not saved.is_deferred and await finished(jobs, saved.job, prefer)
    status = (201 if saved.created else 200) if done else 202
    place = f"/api/v1/jobs/{saved.job}" if saved.job and not done else f"/api/v1/designs/{saved.design}"
    design = saved.answer
    if design is None:
        design = await run_in_threadpool(designs.show, saved.design, saved.revision)
    if proposals is not None:
        design = MappedDesign(**dict(design), proposals=list(proposals))
    return shown(design, status, {"Location": place})


def shown(design: Design, status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    """Return a design as an answer; the ETag is its revision."""
    return written(design, status, {**(headers or {}), "ETag": f'"{design.revision}"'})
