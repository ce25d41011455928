"""`/templates/{id}/versions/{n}/evaluate` and `…/solve` and `…/worksheet`.

What is cheap is calculated here, in the event loop or a thread; what is expensive, or comes in a large body,
goes to a calculation process as it is.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import Annotated, Any, cast, get_type_hints

from fastapi import APIRouter, Header, Request, Response
from pydantic_core import to_json
from starlette.concurrency import run_in_threadpool

from app.calculations.answering import Answering, TheAnswering
from app.calculations.cost import EXPENSIVE, estimated_seconds, is_quick, solving_seconds, writing_seconds
from app.calculations.display import System, Units
from app.calculations.operations import LARGE, Question
from app.calculations.schemas import Asked, EvaluateIn, SolveIn
from app.calculations.service import run_evaluate, run_solve
from app.calculations.size import points
from app.calculations.worksheet import run_worksheet
from app.catalogue.routes import Id, Number
from app.dependencies import TheCatalogues
from app.http import StrictRequest, StrictRoute
from app.waiting import LATER

LONGEST_ID, PLAIN_NUMBER = 64, re.compile("[1-9][0-9]{0,5}")
FEW = 100  # points and names that are taken in the event loop, if every level is quick: a thread costs more
SYSTEMS: dict[str | None, System] = {None: "si", "si": "si", "us": "us"}

Prefer = Annotated[
    str | None, Header(description="`wait=5` or `respond-async`, for what takes long: it goes on as a job")
]


class LargeRoute(StrictRoute):
    """A route with a template, its version and a body, which hands a large body on without reading it.

    To parse 16 MB holds the interpreter, and with it the server, for a second.
    """

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """The answer to a large body."""
        system = SYSTEMS.get(request.query_params.get("units"))
        if system is None or len(await request.body()) <= LARGE or not _is_plain(request):
            return None
        id, number = request.path_params["id"], int(request.path_params["number"])
        question = Question(id, number, self.path.rpartition("/")[2], await request.body(), system)
        answering: Answering = request.app.state.answering
        return await answering.answer(request, question)


class PlainRoute(LargeRoute):
    """A route that reads a request that is right by itself.

    FastAPI's general way costs more than an evaluation. What is not plainly right goes that way, and gets its
    errors.
    """

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """The answer, unless something about the request is not plain."""
        if not _is_plain(request):
            return None
        if len(await request.body()) > LARGE:
            return await super().shortcut(request)
        try:
            body = self.asked.model_validate(await request.json())
        except ValueError:  # no JSON, or not what is asked for
            return None
        id, number, state = request.path_params["id"], request.path_params["number"], request.app.state
        answer: Response = await self.endpoint(
            id, int(number), body, state.catalogues, state.answering, request
        )
        return answer

    @cached_property
    def asked(self) -> type[Asked]:
        """The model of the body."""
        return cast(type[Asked], get_type_hints(self.endpoint)["body"])


def _is_plain(request: Request) -> bool:
    """Whether the path names a template and a version in their usual form."""
    id, number = request.path_params["id"], request.path_params["number"]
    return len(id) <= LONGEST_ID and PLAIN_NUMBER.fullmatch(number) is not None


router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=PlainRoute)


@router.post("/{id}/versions/{number}/evaluate", responses=LATER)
async def evaluate(
    id: Id,
    number: Number,
    body: EvaluateIn,
    catalogues: TheCatalogues,
    answering: TheAnswering,
    request: Request,
    prefer: Prefer = None,
) -> Response:
    """Evaluate a template: inputs in any unit, scalars or arrays; only what is asked for is computed."""
    cls = catalogues.templates.get(id, number)
    if points(body.inputs) <= FEW and len(body.inputs) <= FEW and is_quick(cls):
        return _json(to_json(run_evaluate(cls, body)))
    if estimated_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs) > EXPENSIVE:
        return await answering.answer(request, Question(id, number, "evaluate", await request.body()))
    return _json(await run_in_threadpool(lambda: to_json(run_evaluate(cls, body))))


@router.post("/{id}/versions/{number}/solve", responses=LATER)
async def solve(
    id: Id,
    number: Number,
    body: SolveIn,
    catalogues: TheCatalogues,
    answering: TheAnswering,
    request: Request,
    prefer: Prefer = None,
) -> Response:
    """Find the input that gives a wanted output, between bounds."""
    cls = catalogues.templates.get(id, number)
    seconds = solving_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs, body.target)
    if seconds > EXPENSIVE:
        return await answering.answer(request, Question(id, number, "solve", await request.body()))
    return _json(await run_in_threadpool(lambda: to_json(run_solve(cls, body))))


worksheets = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=LargeRoute)


@worksheets.post("/{id}/versions/{number}/worksheet", response_model=None, responses=LATER)
async def worksheet(
    id: Id,
    number: Number,
    body: EvaluateIn,
    catalogues: TheCatalogues,
    answering: TheAnswering,
    request: Request,
    units: Units = "si",
    prefer: Prefer = None,
) -> dict[str, Any] | Response:
    """Evaluate a template, with every formula written out: symbol = expression = numbers = result."""
    cls = catalogues.templates.get(id, number)
    seconds = estimated_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs)
    if seconds + writing_seconds(cls, body.outputs) > EXPENSIVE:
        return await answering.answer(request, Question(id, number, "worksheet", await request.body(), units))
    return await run_in_threadpool(run_worksheet, cls, body, units)


def _json(content: bytes) -> Response:
    return Response(content, media_type="application/json")
