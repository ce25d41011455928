"""Build the responses of routes: waiting, worker threads, 202 with a job, JSON and its compression.

Routes that may wait for the pool of calculation processes have their own threads, so that they never block
other routes.
"""

from __future__ import annotations

import asyncio
import re
import time
from collections.abc import Callable, Mapping
from typing import ParamSpec, TypeVar

from anyio import CapacityLimiter, to_thread
from fastapi import Request
from fastapi.responses import Response
from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

from app.identity.principal import acting
from app.identity.service import Identity
from app.identity.usage import MIB
from app.jobs.service import Jobs
from app.pool.steps import Caller, present_caller
from app.schemas.answers import Accepted, Answer, FileAccepted
from app.schemas.problems import Responses

LONGEST = 60.0  # s
SMALLEST, LEVEL = 1000, 6  # smallest body that is compressed [bytes], compression level
PLAIN = ("/events", "/evaluate", ".png", ".step")
"""Ends of paths whose answers are not compressed: streams, short answers, and compressed formats."""
CALCULATED = re.compile("/api/v1/(evaluations/.*|templates/.*/worksheet)")
"""Paths of answers that may be large: compressing 256 kB blocks the event loop for about 10 ms."""
LATER: Responses = {
    202: {"description": "the work goes on; its job is in the header Location", "model": Accepted}
}
"""Declared answers of a route that may answer with a job."""


def later(answer: type[Answer]) -> Responses:
    """Describe, for OpenAPI, a route whose 202 response contains the available part of the result."""
    described = "the available part of the answer; the work continues, and the header Location names its job"
    return {202: {"description": described, "model": answer}}


MOST_ACCEPTED = 50  # media types in one Accept header; browsers send up to ten
_WEIGHT = re.compile(r"\bq=([01](?:\.[0-9]{0,3})?)")


def accepted_kinds(accept: str | None) -> list[tuple[str, str]]:
    """Return the media types of an Accept header, each with its parameters."""
    named = (part.partition(";") for part in (accept or "").lower().split(",", MOST_ACCEPTED)[:MOST_ACCEPTED])
    return [(media.strip(), parameters) for media, _, parameters in named]


def accepted_weights(accept: str | None) -> dict[str, float]:
    """Return the weight `q` [0 to 1] of each media type of an Accept header; 1 if the header states none."""
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
    """Return how long the client waits for an answer [s]: as its Prefer header states, or the default."""
    if prefer and "respond-async" in prefer:
        return 0.0
    asked = re.search(r"\bwait=([0-9]{1,4})\b", prefer or "")
    return min(float(asked[1]), LONGEST) if asked else default


async def client_left(request: Request) -> None:
    """Wait until the client has closed its connection, after the body has been read."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


FILE_LATER: Responses = {
    202: {"description": "the file is stored; its job is in the header Location", "model": FileAccepted}
}
"""Declared answers of a route that imports a file."""


def file_accepted(job: str, identity: Identity) -> Response:
    """Return status 202 for the import of a file, with the storage that the acting principal uses."""
    amounts, limits = identity.usage(acting().id)
    most = limits.storage_mb if limits else None
    answer = FileAccepted(job=f"/api/v1/jobs/{job}", storage_mb=amounts.bytes / MIB, storage_limit_mb=most)
    return accepted(job, answer)


def accepted(job: str | None, answer: Answer | None = None) -> Response:
    """Return status 202 for work in progress, with the job in Location."""
    place = f"/api/v1/jobs/{job}"
    return written(answer or Accepted(job=place), 202, {"Location": place})


def written(answer: Answer, status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    """Return an answer as JSON, without omitted fields."""
    return Response(as_json(answer), status, media_type="application/json", headers=dict(headers or {}))


def as_json(answer: Answer) -> bytes:
    """Return an answer as JSON, without omitted fields."""
    return answer.model_dump_json(by_alias=True, exclude_unset=True).encode()


P = ParamSpec("P")
T = TypeVar("T")

THREADS = 300
"""Largest number of these threads: more than the calculations that wait and run (`calculation_waiting`)."""
WATCHED = 0.05
"""Time after which the service watches for a disconnected client [s]; most answers take less."""


class Threads:
    """Threads for routes that may wait for the pool; the threads of all other routes stay free."""

    def __init__(self) -> None:
        self._limiter: CapacityLimiter | None = None

    async def run(self, function: Callable[P, T], *args: P.args, **options: P.kwargs) -> T:
        """Call a function in a thread that may wait for the pool."""
        if self._limiter is None:
            self._limiter = CapacityLimiter(THREADS)
        return await to_thread.run_sync(lambda: function(*args, **options), limiter=self._limiter)

    async def run_for(
        self, request: Request, function: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T:
        """Call a function for a client; its calculation ends if the client disconnects."""
        if (caller := present_caller()) is None:
            return await self.run(function, *args, **options)
        leaving = list[asyncio.Task[None]]()

        def watch() -> None:
            leaving.append(asyncio.create_task(_note_leaving(request, caller)))

        timer = asyncio.get_running_loop().call_later(WATCHED, watch)
        try:
            return await self.run(_closing, caller, lambda: function(*args, **options))
        finally:
            timer.cancel()
            for task in leaving:
                task.cancel()

    async def run_within(
        self, seconds: float, request: Request, function: Callable[P, T], *args: P.args, **options: P.kwargs
    ) -> T:
        """Run a function as `run_for` does, and defer every step that would take longer than `seconds`.

        The deadline of calculations limits that time.
        """
        if caller := present_caller():
            caller.until = time.monotonic() + min(seconds, caller.steps.deadline)
        return await self.run_for(request, function, *args, **options)


def _closing(caller: Caller, function: Callable[[], T]) -> T:
    """Call a function, then end those of its calculations that no job has taken over."""
    failed = True
    try:
        result = function()
        failed = False
        return result
    finally:
        caller.begun.close(failed=failed)


async def _note_leaving(request: Request, caller: Caller) -> None:
    await client_left(request)
    caller.left.set()


class Compression:
    """ASGI middleware that compresses pages and answers, but no event stream."""

    def __init__(self, app: ASGIApp) -> None:
        self.app, self.compressed = app, GZipMiddleware(app, minimum_size=SMALLEST, compresslevel=LEVEL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the response on, compressed if the client accepts that."""
        is_plain = scope["type"] != "http" or _is_plain(scope["path"])
        await (self.app if is_plain else self.compressed)(scope, receive, send)


def _is_plain(path: str) -> bool:
    return path.endswith(PLAIN) or CALCULATED.fullmatch(path) is not None
