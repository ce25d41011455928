"""`/templates/{id}/versions/{n}/evaluate` and `…/solve`."""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any, cast, get_type_hints

from fastapi import APIRouter, Response
from pydantic_core import to_json
from starlette.concurrency import run_in_threadpool

from app.calculations.display import Units
from app.calculations.schemas import Asked, EvaluateIn, SolveIn
from app.calculations.service import run_evaluate, run_solve
from app.calculations.size import points
from app.calculations.worksheet import run_worksheet
from app.catalogue.routes import Id, Number
from app.dependencies import TheCatalogues
from app.http import StrictRequest, StrictRoute


class PlainRoute(StrictRoute):
    """A route with a template, its version and a body, which reads a request that is right by itself.

    FastAPI's general way costs more than an evaluation. What is not plainly right goes that way, and gets its
    errors.
    """

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """The answer, unless something about the request is not plain."""
        id, number = request.path_params["id"], request.path_params["number"]
        if len(id) > LONGEST_ID or not PLAIN_NUMBER.fullmatch(number):
            return None
        try:
            body = self.asked.model_validate(await request.json())
        except ValueError:  # no JSON, or not what is asked for
            return None
        answer: Response = await self.endpoint(id, int(number), body, request.app.state.catalogues)
        return answer

    @cached_property
    def asked(self) -> type[Asked]:
        """The model of the body."""
        return cast(type[Asked], get_type_hints(self.endpoint)["body"])


router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=PlainRoute)

LONGEST_ID, PLAIN_NUMBER = 64, re.compile("[1-9][0-9]{0,5}")
FEW = 100  # points and names that are taken in the event loop, if no level is dear: a thread costs more


@router.post("/{id}/versions/{number}/evaluate")
async def evaluate(id: Id, number: Number, body: EvaluateIn, catalogues: TheCatalogues) -> Response:
    """Evaluate a template: inputs in any unit, scalars or arrays; only what is asked for is computed."""
    cls = catalogues.templates.get(id, number)
    if points(body.inputs) <= FEW and len(body.inputs) <= FEW and not cls.most_points:
        return _json(to_json(run_evaluate(cls, body)))
    return _json(await run_in_threadpool(lambda: to_json(run_evaluate(cls, body))))


@router.post("/{id}/versions/{number}/solve")
async def solve(id: Id, number: Number, body: SolveIn, catalogues: TheCatalogues) -> Response:
    """Find the input that gives a wanted output, between bounds."""
    cls = catalogues.templates.get(id, number)
    return _json(await run_in_threadpool(lambda: to_json(run_solve(cls, body))))


worksheets = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=StrictRoute)


@worksheets.post("/{id}/versions/{number}/worksheet")
def worksheet(
    id: Id, number: Number, body: EvaluateIn, catalogues: TheCatalogues, units: Units = "si"
) -> dict[str, Any]:
    """Evaluate a template, with every formula written out: symbol = expression = numbers = result."""
    return run_worksheet(catalogues.templates.get(id, number), body, units)


def _json(content: bytes) -> Response:
    return Response(content, media_type="application/json")
