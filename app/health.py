"""`/healthz`, `/readyz` and `/metrics`, at the root."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Response
from prometheus_client import CONTENT_TYPE_LATEST

from app import metrics
from app.dependencies import TheDatabase, TheJobs
from app.designs import repository

router = APIRouter(tags=["health"])


@router.get("/healthz")
async def healthz() -> dict[str, str]:
    """The process is alive."""
    return {"status": "ok"}


@router.get("/readyz")
def readyz(database: TheDatabase) -> dict[str, Any]:
    """The database answers."""
    with database.read() as session:
        return {"status": "ready", "designs": repository.count(session)}


_TEXT: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "figures in the text format of Prometheus",
        "content": {"text/plain": {"schema": {"type": "string"}}},
    }
}


@router.get("/metrics", name="metrics", response_class=Response, responses=_TEXT)
def show_metrics(database: TheDatabase, jobs: TheJobs) -> Response:
    """Figures for Prometheus."""
    with database.read() as session:
        census = jobs.census(session)
    return Response(metrics.text(census), media_type=CONTENT_TYPE_LATEST)
