"""`/templates/{id}/versions/{n}/evaluate` and `…/solve`."""

from __future__ import annotations

from fastapi import APIRouter, Response
from pydantic_core import to_json
from starlette.concurrency import run_in_threadpool

from app.calculations.schemas import EvaluateIn, SolveIn
from app.calculations.service import run_evaluate, run_solve
from app.calculations.size import points
from app.catalogue.routes import Id, Number
from app.dependencies import TheCatalogues
from app.http import StrictRoute

router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)

FEW = 100  # points that are evaluated within the event loop, if no level is dear: a thread costs more


@router.post("/{id}/versions/{number}/evaluate")
async def evaluate(id: Id, number: Number, body: EvaluateIn, catalogues: TheCatalogues) -> Response:
    """Evaluate a template: inputs in any unit, scalars or arrays; only what is asked for is computed."""
    cls = catalogues.templates.get(id, number)
    if points(body.inputs) <= FEW and not cls.most_points:
        return _json(to_json(run_evaluate(cls, body)))
    return _json(await run_in_threadpool(lambda: to_json(run_evaluate(cls, body))))


@router.post("/{id}/versions/{number}/solve")
async def solve(id: Id, number: Number, body: SolveIn, catalogues: TheCatalogues) -> Response:
    """Find the input that gives a wanted output, between bounds."""
    cls = catalogues.templates.get(id, number)
    return _json(await run_in_threadpool(lambda: to_json(run_solve(cls, body))))


def _json(content: bytes) -> Response:
    return Response(content, media_type="application/json")
