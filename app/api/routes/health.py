"""`/healthz` and `/metrics`, at the root; `/readyz` is in `app.api.readiness`."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import PlainTextResponse
from prometheus_client import CONTENT_TYPE_LATEST

from app.api.dependencies import TheDatabase, TheJobs
from app.observation import metrics

router = APIRouter(tags=["health"])


@router.get("/healthz")
async def healthz() -> dict[str, str]:
    """The process is alive."""
    return {"status": "ok"}


@router.get("/metrics", name="metrics", response_class=PlainTextResponse)
def show_metrics(database: TheDatabase, jobs: TheJobs) -> Response:
    """Figures for Prometheus."""
    with database.read() as session:
        text = metrics.text(jobs.census(session), jobs.oldest_queued_age(session))
    return Response(text, media_type=CONTENT_TYPE_LATEST)
