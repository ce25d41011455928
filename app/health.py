"""`/healthz` and `/metrics`, at the root; `/readyz` is in `app.readiness`."""

from __future__ import annotations

import time
from functools import cache

from fastapi import APIRouter, Response
from fastapi.responses import PlainTextResponse
from prometheus_client import (
    CONTENT_TYPE_LATEST,
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    generate_latest,
)
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.dependencies import TheDatabase, TheJobs

router = APIRouter(tags=["health"])

REGISTRY = CollectorRegistry()
REQUESTS = Counter("crankwright_requests_total", "Requests answered", ["status"], registry=REGISTRY)
SECONDS = Histogram("crankwright_request_seconds", "Time to answer [s]", registry=REGISTRY)
QUEUED = Gauge("crankwright_jobs_queued", "Jobs that wait", registry=REGISTRY)
OLDEST = Gauge(
    "crankwright_jobs_oldest_seconds", "How long the oldest of them has waited [s]", registry=REGISTRY
)


@router.get("/healthz")
async def healthz() -> dict[str, str]:
    """The process is alive."""
    return {"status": "ok"}


@router.get("/metrics", response_class=PlainTextResponse)
def metrics(database: TheDatabase, jobs: TheJobs) -> Response:
    """Figures for Prometheus."""
    with database.read() as session:
        QUEUED.set(jobs.queued(session))
        OLDEST.set(jobs.oldest_queued_age(session))
    return Response(generate_latest(REGISTRY), media_type=CONTENT_TYPE_LATEST)


@cache
def answered(status: int) -> Counter:
    """The counter of the answers of one status; to look it up by its label costs more than to count."""
    return REQUESTS.labels(status)


class Metrics:
    """ASGI middleware that counts requests and their time."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and count."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start = time.perf_counter()

        async def counted(message: Message) -> None:
            if message["type"] == "http.response.start":
                answered(message["status"]).inc()
                SECONDS.observe(time.perf_counter() - start)
            await send(message)

        await self.app(scope, receive, counted)
