"""Exchanges with the service: generators of requests, independent of the client that sends them.

An exchange yields requests, receives their responses and returns a model. It does not use the network itself,
so that `Client` and `AsyncClient` can run the same exchanges.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import httpx
from pydantic import TypeAdapter

from app.client.problem import Problem, checked
from app.jobs.schemas import Job
from app.plain import JsonObject
from app.schemas.answers import Answer, Page

BASE = "/api/v1"
ENDED = ("done", "failed", "cancelled")
JSON, MERGE_PATCH = "application/json", "application/merge-patch+json"
_JOB = f"{BASE}/jobs/"

Progress = Callable[[float, str], None]
"""Function that receives the progress of a job, 0 to 1, and what the job is doing."""

Model = TypeVar("Model")
Result = TypeVar("Result")
Item = TypeVar("Item")


Query = Mapping[str, str] | tuple[tuple[str, str], ...]
"""The query of a request; in pairs, a name may occur several times."""


@dataclass(frozen=True)
class Request:
    """A request; `listen` receives every line of a streamed response, which has no time-out.

    `is_safe` states that a POST changes nothing, as a calculation.
    """

    method: str
    path: str
    content: bytes | None = None
    params: Query = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    listen: Callable[[str], None] | None = None
    is_safe: bool = False


Exchange = Generator[Request, httpx.Response, Result]


def get(path: str, params: Query | None = None) -> Request:
    """Request the resource at a path below `BASE`."""
    return Request("GET", BASE + path, params=params or {})


def post(path: str, body: object, headers: Mapping[str, str] | None = None) -> Request:
    """Send a body as JSON by POST to a path below `BASE`."""
    return Request("POST", BASE + path, written(body), headers={"Content-Type": JSON, **(headers or {})})


def written(body: object) -> bytes:
    """Return a body as JSON; it may contain models of answers, such as a quantity.

    Raises
    ------
    ValueError
        If a number is NaN or infinite.
    """
    return json.dumps(body, default=_plain, allow_nan=False, ensure_ascii=False).encode()


def _plain(value: object) -> JsonObject:
    if isinstance(value, Answer):
        return value.plain()
    raise TypeError(f"a value of type {type(value).__name__} cannot be sent as JSON")


def read(model: type[Model], response: httpx.Response) -> Model:
    """Parse the answer as a model."""
    return TypeAdapter(model).validate_json(checked(response).content, extra="allow")


def answered(model: type[Model], request: Request) -> Exchange[Model]:
    """Return the answer to one request."""
    return read(model, (yield request))


def listed(page: type[Page[Item]], path: str, query: Sequence[tuple[str, str]] = ()) -> Exchange[list[Item]]:
    """Return the items of all pages."""
    items: list[Item] = []
    cursor: str | None = ""
    while cursor is not None:
        one = yield from answered(page, get(path, (*query, *([("cursor", cursor)] if cursor else []))))
        items += one.items
        cursor = one.next
    return items


def awaited(request: Request, on_progress: Progress | None = None) -> Exchange[httpx.Response]:
    """Send a request again once its job has ended, as for a file that must be created; return the response.

    Raises
    ------
    Problem
        If the service refuses the request, or its job fails.
    """
    response = yield request
    while job := job_of(response):
        yield from done(job, on_progress)
        response = yield request
    return checked(response)


def calculated(model: type[Model], request: Request, on_progress: Progress | None = None) -> Exchange[Model]:
    """Return the answer of a calculation; if the service made it a job, wait for the job."""
    return read(model, (yield from calculation(request, on_progress)))


def calculation(request: Request, on_progress: Progress | None = None) -> Exchange[httpx.Response]:
    """Return the response to a calculation; if the service made it a job, wait for the job."""
    response = yield replace(request, is_safe=True)
    if job := job_of(response):
        yield from done(job, on_progress)
        response = yield from awaited(get(f"/evaluations/{job}"), on_progress)
    return checked(response)


def job_of(response: httpx.Response) -> str | None:
    """Return the job that a response names: a 202, or a 503 while a lost file is rebuilt."""
    place = response.headers.get("Location", "")
    waits = response.status_code in (202, 503) and place.startswith(_JOB)
    return place.removeprefix(_JOB) if waits else None


def done(job: str, on_progress: Progress | None = None) -> Exchange[Job]:
    """Return a completed job.

    Raises
    ------
    Problem
        If the job failed or was cancelled.
    """
    ended = yield from followed(job, on_progress)
    if ended.problem:
        raise Problem(ended.problem.status, ended.problem.model_dump(exclude_unset=True))
    return ended


def followed(job: str, on_progress: Progress | None = None) -> Exchange[Job]:
    """Wait until a job has ended, and return it whatever its outcome."""

    def listen(line: str) -> None:
        event = json.loads(line.removeprefix("data:")) if line.startswith("data:") else {}
        if on_progress and event.get("event") == "progress":
            on_progress(event["progress"], event["text"])

    while True:
        checked((yield Request("GET", f"{_JOB}{job}/events", listen=listen)))
        row = yield from answered(Job, get(f"/jobs/{job}"))
        if row.state in ENDED:
            return row
