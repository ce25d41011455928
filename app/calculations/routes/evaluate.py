"""`/templates/{id}/versions/{n}/evaluate`, `…/solve` and `…/worksheet`.

A cheap calculation runs in the server, in its event loop or a thread. An expensive calculation, or one with a
large body, goes to a calculation process. Arrays go there if earlier ones of their kind took more than
`IN_SERVER` of processor time here.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from time import thread_time
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response
from pydantic_core import to_json

from app.api.answers import answered
from app.api.dependencies import Units, services_of
from app.api.responses import LATER, patience
from app.calculations.array_files import NPY, Form, npy
from app.calculations.bodies import EvaluateIn, SolveIn
from app.calculations.operations import LARGE, OPERATIONS, Question
from app.calculations.schemas.evaluations import Evaluation, Solution, Worksheet
from app.calculations.service import evaluated, run_evaluate, run_solve
from app.calculations.worksheet import run_worksheet
from app.catalogue.routes.templates import Id, Number
from app.http.access import get_client, needs
from app.http.strict_requests import PlainRoute, StrictRequest
from app.observation.processor_time import in_thread
from app.pool.cost import (
    EXPENSIVE,
    Kind,
    MeasuredTimes,
    estimated_seconds,
    is_quick,
    solving_seconds,
    writing_seconds,
)
from app.presentation.units import System
from app.schemas.problems import Responses, refusals
from app.workers.pieces import Pieces
from templates.core.language.template import Template

LONGEST_ID, PLAIN_NUMBER = 64, re.compile("[1-9][0-9]{0,5}")
MEASURED = MeasuredTimes()
FEW = 100  # points and names evaluated in the event loop if all levels are quick; a thread would cost more
SYSTEMS: dict[str | None, System] = {None: "si", "si": "si", "us": "us"}

DECLARED = {**LATER, **refusals(404, 429)}
ARRAYS = "with `Accept: application/x-npy` the outputs as one structured array, a field for each"
AS_ARRAY: Responses = {
    200: {"description": ARRAYS, "content": {NPY: {"schema": {"type": "string", "format": "binary"}}}}
}
Prefer = Annotated[
    str | None, Header(description="`wait=5` or `respond-async`, for what takes long: it goes on as a job")
]


class LargeRoute(PlainRoute):
    """A route with a template, its version and a body; it passes a large body on without parsing it.

    Parsing 16 MB would hold the interpreter lock, and so block the server, for a second.
    """

    async def admit(self, request: StrictRequest) -> None:
        """Refuse a large body before it arrives, if the pool has no room for its calculation."""
        if int(request.headers.get("content-length", 0)) > LARGE and _system(request) and _is_plain(request):
            await _admit(request)

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """Return the response to a request with a large body."""
        parts = await request.parts()
        if sum(map(len, parts)) <= LARGE or (system := _system(request)) is None or not _is_plain(request):
            return None
        operation = self.path.rpartition("/")[2]
        question = Question(*_template(request), operation, Pieces(parts), system, _form(request, operation))
        return await _answered(request, question)


async def _admit(request: Request) -> None:
    """Check, before a large body arrives, whether the queue has room for its calculation.

    Raises
    ------
    UnknownTemplate, InvalidInputs, TooManyCalculations
        As raised by the calculation.
    """
    services = services_of(request)
    await services.catalogues.tried(*_template(request))
    client = await get_client(request)
    if _patience(request) > 0:  # otherwise a job waits in the queue
        services.calculations.admit(client)


async def _answered(request: Request, question: Question) -> Response:
    """Return the answer of a calculation process, or 202 with a job if the client stops waiting."""
    questions, client = services_of(request).evaluations, await get_client(request)
    return await answered(questions, question, request, client, _patience(request), question.media_type)


def _patience(request: Request) -> float:
    """Return how long a request waits for its answer [s]."""
    deadline = services_of(request).steps.deadline
    return min(deadline, patience(request.headers.get("prefer"), deadline))


def _is_plain(request: Request) -> bool:
    """Return whether a path names its template and version in the usual form."""
    id, number = request.path_params["id"], request.path_params["number"]
    return len(id) <= LONGEST_ID and PLAIN_NUMBER.fullmatch(number) is not None


def _template(request: Request) -> tuple[str, int]:
    """Return the template and the version in a path."""
    return request.path_params["id"], int(request.path_params["number"])


def _system(request: Request) -> System | None:
    """Return the system of units that a request names; None if there is no such system."""
    return SYSTEMS.get(request.query_params.get("units"))


router = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=LargeRoute)


@router.post(
    "/{id}/versions/{number}/evaluate",
    response_model=Evaluation,
    responses={**DECLARED, **AS_ARRAY, **refusals(406)},
    dependencies=[needs("viewer", "admin")],
)
async def evaluate_template(
    request: StrictRequest,
    id: Id,
    number: Number,
    body: EvaluateIn,
    prefer: Prefer = None,
) -> Response:
    """Evaluate a template with inputs in any unit, scalars or arrays.

    Only the requested outputs are computed.
    """
    services = services_of(request)
    cls = await services.catalogues.tried(id, number)
    form = _form(request, "evaluate")
    if form == "json" and body.points <= FEW and len(body.inputs) <= FEW and is_quick(cls):
        return _json(to_json(run_evaluate(cls, body)))
    if _leaves(cls, body):
        return await _answered(request, await _question(request, id, number, "evaluate"))
    if form == "npy":
        return Response(await in_thread(_timed, cls, body, lambda: npy(evaluated(cls, body))), media_type=NPY)
    return _json(await in_thread(_timed, cls, body, lambda: to_json(run_evaluate(cls, body))))


def _leaves(cls: type[Template], body: EvaluateIn) -> bool:
    """Return whether a calculation process evaluates a request, not the server."""
    estimate = estimated_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs)
    return MEASURED.leaves(_kind(cls, body), estimate) if body.points > FEW else estimate > EXPENSIVE


def _timed(cls: type[Template], body: EvaluateIn, answer: Callable[[], bytes]) -> bytes:
    """Return an answer, and keep the processor time that this thread needed for it."""
    start = thread_time()
    content = answer()
    MEASURED.note(_kind(cls, body), thread_time() - start)
    return content


def _kind(cls: type[Template], body: EvaluateIn) -> Kind:
    outputs = None if body.outputs is None else frozenset(body.outputs)
    return cls, body.level, body.tolerance, outputs, body.points.bit_length()


@router.post(
    "/{id}/versions/{number}/solve",
    response_model=Solution,
    responses=DECLARED,
    dependencies=[needs("viewer", "admin")],
)
async def solve_template(
    request: StrictRequest,
    id: Id,
    number: Number,
    body: SolveIn,
    prefer: Prefer = None,
) -> Response:
    """Find the input that gives a wanted output, in an interval."""
    services = services_of(request)
    cls = await services.catalogues.tried(id, number)
    seconds = solving_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs, body.target)
    if seconds > EXPENSIVE:
        return await _answered(request, await _question(request, id, number, "solve"))
    return _json(await in_thread(lambda: to_json(run_solve(cls, body))))


worksheets = APIRouter(prefix="/api/v1/templates", tags=["templates"], route_class=LargeRoute)


@worksheets.post(
    "/{id}/versions/{number}/worksheet",
    response_model=Worksheet,
    responses=DECLARED,
    dependencies=[needs("viewer", "admin")],
)
async def write_worksheet(
    request: StrictRequest,
    id: Id,
    number: Number,
    body: EvaluateIn,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Evaluate a template and write every formula out: symbol = expression = numbers = result."""
    services = services_of(request)
    cls = await services.catalogues.tried(id, number)
    seconds = estimated_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs)
    if seconds + writing_seconds(cls, body.outputs) > EXPENSIVE:
        return await _answered(request, await _question(request, id, number, "worksheet", units))
    return _json(await in_thread(lambda: to_json(run_worksheet(cls, body, units))))


async def _question(
    request: Request, id: str, number: int, operation: str, system: System = "si"
) -> Question:
    body = Pieces.of(await request.body())
    return Question(id, number, operation, body, system, _form(request, operation))


def _form(request: Request, operation: str) -> Form:
    """Return the requested format: an array if the Accept header prefers it to JSON."""
    first = request.headers.get("accept", "").partition(",")[0].partition(";")[0].strip()
    return "npy" if first == NPY and "npy" in OPERATIONS[operation].write else "json"


def _json(content: bytes) -> Response:
    return Response(content, media_type="application/json")
