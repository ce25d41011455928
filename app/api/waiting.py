"""How long an answer waits for its job: a short while, `Prefer: wait=n`, or not at all (`respond-async`)."""

from __future__ import annotations

import re
from typing import Any

from fastapi import Request
from fastapi.responses import JSONResponse, Response

from app.jobs.service import Jobs

LONGEST = 60.0  # s
LATER: dict[int | str, dict[str, Any]] = {
    202: {"description": "as far as it is known: the work goes on, its job is in the header Location"}
}
"""What a route that may wait for a job says of its answers."""

MOST_ACCEPTED = 50  # kinds in one Accept; browsers send up to ten


def accepted_kinds(accept: str | None) -> list[tuple[str, str]]:
    """The media types of an Accept header, each with its parameters."""
    named = (part.partition(";") for part in (accept or "").lower().split(",", MOST_ACCEPTED)[:MOST_ACCEPTED])
    return [(media.strip(), parameters) for media, _, parameters in named]


async def finished(jobs: Jobs, job: str | None, prefer: str | None) -> bool:
    """Whether the job, if there is one, ended within the time that the client waits."""
    if job is None:
        return True
    return await jobs.wait(job, patience(prefer, jobs.wait_seconds)) in (
        "done",
        "failed",
        "cancelled",
    )


def patience(prefer: str | None, default: float) -> float:
    """How long the client waits for an answer [s]: as it prefers, else the default."""
    if prefer and "respond-async" in prefer:
        return 0.0
    asked = re.search(r"\bwait=([0-9]{1,4})\b", prefer or "")
    return min(float(asked[1]), LONGEST) if asked else default


async def client_left(request: Request) -> None:
    """Wait until the client has closed its connection; the body has been read."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


def accepted(job: str | None, body: dict[str, Any] | None = None) -> Response:
    """202: the work goes on; the job is in Location."""
    place = f"/api/v1/jobs/{job}"
    return JSONResponse(body or {"job": place}, 202, headers={"Location": place})
