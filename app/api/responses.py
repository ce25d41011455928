"""Responses of routes whose work may become a job: 202 with the job, and how long the client waits."""

from __future__ import annotations

import re
from collections.abc import Mapping

from fastapi import Request
from fastapi.responses import Response

from app.jobs.service import Jobs
from app.schemas.answers import Accepted, Answer
from app.schemas.problems import Responses

LONGEST = 60.0  # s
LATER: Responses = {
    202: {"description": "the work goes on; its job is in the header Location", "model": Accepted}
}
"""Declared answers of a route whose work may become a job."""


def later(answer: type[Answer]) -> Responses:
    """Describe an answer whose 202 holds as much of the result as there is."""
    described = "the answer as far as it goes: the work goes on, and its job is in the header Location"
    return {202: {"description": described, "model": answer}}


MOST_ACCEPTED = 50  # kinds in one Accept; browsers send up to ten
_WEIGHT = re.compile(r"\bq=([01](?:\.[0-9]{0,3})?)")


def accepted_kinds(accept: str | None) -> list[tuple[str, str]]:
    """Return the media types of an Accept header, each with its parameters."""
    named = (part.partition(";") for part in (accept or "").lower().split(",", MOST_ACCEPTED)[:MOST_ACCEPTED])
    return [(media.strip(), parameters) for media, _, parameters in named]


def accepted_weights(accept: str | None) -> dict[str, float]:
    """Return the weight `q` of each media type of an Accept header, 0 to 1; 1 where it names none."""
    return {media: _weight(parameters) for media, parameters in accepted_kinds(accept)}


def _weight(parameters: str) -> float:
    match = _WEIGHT.search(parameters)
    return float(match[1]) if match else 1.0


async def finished(jobs: Jobs, job: str | None, prefer: str | None) -> bool:
    """Return whether the job, if there is one, ended within the time that the client waits."""
    if job is None:
        return True
    return await jobs.wait(job, patience(prefer, jobs.wait_seconds)) in (
        "done",
        "failed",
        "cancelled",
    )


def patience(prefer: str | None, default: float) -> float:
    """Return how long the client waits for an answer [s]: as it prefers, else the default."""
    if prefer and "respond-async" in prefer:
        return 0.0
    asked = re.search(r"\bwait=([0-9]{1,4})\b", prefer or "")
    return min(float(asked[1]), LONGEST) if asked else default


async def client_left(request: Request) -> None:
    """Wait until the client has closed its connection; the body has been read."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


def accepted(job: str | None, answer: Answer | None = None) -> Response:
    """Return status 202: the work goes on; the job is in Location."""
    place = f"/api/v1/jobs/{job}"
    return written(answer or Accepted(job=place), 202, {"Location": place})


def written(answer: Answer, status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    """Return an answer as JSON, without the fields that it leaves out."""
    return Response(as_json(answer), status, media_type="application/json", headers=dict(headers or {}))


def as_json(answer: Answer) -> bytes:
    """Return an answer as JSON, without the fields that it leaves out."""
    return answer.model_dump_json(by_alias=True, exclude_unset=True).encode()
