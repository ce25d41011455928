"""`/healthz`, `/readyz` and `/metrics`, outside `/api/v1`."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import PlainTextResponse
from prometheus_client import CONTENT_TYPE_LATEST

from app.api.dependencies import TheDatabase, TheJobs, TheReadiness
from app.api.responses import written
from app.http import problems
from app.http.access import needs, public
from app.http.problem_kinds import NOT_READY
from app.observation import metrics
from app.observation.schemas import Health, Ready
from app.schemas.problems import refusals

router = APIRouter(tags=["operations"])


@router.get("/healthz", dependencies=[public()])
async def show_health() -> Health:
    """Return status 200 to show that the process is alive."""
    return Health(status="ok")


@router.get("/readyz", response_model=Ready, responses=refusals(503), dependencies=[public()])
async def show_readiness(readiness: TheReadiness) -> Response:
    """Return whether the service can write, has disk space, and its job processes answer.

    The checks run at most once a second.
    """
    said = await readiness.failures()
    listed = [{"name": n, "code": "not_ready", "detail": text} for n, text in said.items() if text]
    if not listed:
        return written(Ready(status="ready", checks=dict.fromkeys(said, "ok")))
    detail = "; ".join(f"{fault['name']}: {fault['detail']}" for fault in listed)
    about: dict[str, object] = {**problems.problem(NOT_READY, detail[:2000]), "errors": listed}
    return problems.answer(about, {"Retry-After": "2"})


@router.get("/metrics", response_class=PlainTextResponse, dependencies=[needs()])
def show_metrics(database: TheDatabase, jobs: TheJobs) -> Response:
    """Return the metrics in Prometheus's text format."""
    with database.read() as session:
        text = metrics.text(jobs.census(session), jobs.oldest_queued_age(session))
    return Response(text, media_type=CONTENT_TYPE_LATEST)
