"""Convert errors to RFC 9457 problems, by the table of `app.http.problem_kinds`.

A problem's `type` is a relative link, `/problems/<slug>`, to a page with its meaning and remedy.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping

from fastapi import APIRouter, FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from pydantic_core import ErrorDetails
from starlette.exceptions import HTTPException
from starlette.routing import Match, Mount

from app.calculations.errors import InvalidBody
from app.designs import errors as designs
from app.http.access import public
from app.http.problem_kinds import HTTP, INTERNAL, SLUGS, TABLE, Kind, kind_of
from app.jobs import errors as jobs
from app.observation import logs, metrics
from app.observation.secrets import without_keys
from app.plain import Json, JsonObject
from app.schemas.problems import MEDIA_TYPE, ProblemKind, refusals
from app.storage import errors as storage
from app.storage.errors import CannotRebuild
from app.studies.errors import RowsLost
from app.workers import errors as workers
from app.worksheets import errors as worksheets
from cad.errors import AnalysisError, GeometryError, UnreadableModel
from templates.core import errors as templates

logger = logging.getLogger(__name__)

LONGEST_PLACE = 200  # characters of a fault's location in a body; the client chose the names in it


def describe(error: Exception) -> JsonObject:
    """Return an error as a problem (RFC 9457) with all data of the error."""
    kind = kind_of(error)
    detail = kind.remedy if kind is INTERNAL else _detail(error)
    carried = next((tell(error) for cls, tell in _CARRIED.items() if isinstance(error, cls)), {})
    return {**problem(kind, detail[:2000]), **carried}


def _detail(error: Exception) -> str:
    """Return the text of an error.

    FastAPI's own text would quote the whole body, so `_validation` replaces it.
    """
    return "" if isinstance(error, RequestValidationError) else str(error)


def problem(kind: Kind, detail: str) -> JsonObject:
    """Return a problem object."""
    return {"type": f"/problems/{kind.slug}", "title": kind.title, "status": kind.status, "detail": detail}


def _faults(error: templates.InvalidInputs) -> dict[str, object]:
    listed = [_fault(fault) for fault in error.faults]
    count = len(listed)
    return {"errors": listed, "detail": f"{count} {'fault' if count == 1 else 'faults'}: {_short(listed)}"}


def _fault(fault: templates.Fault) -> dict[str, str | list[str]]:
    also = {"also": list(fault.also)} if fault.also else {}
    return {"name": fault.name, "code": fault.code, "detail": fault.detail, **also}


def _validation(error: RequestValidationError | InvalidBody) -> dict[str, object]:
    listed = [_located(fault) for fault in error.errors()]
    return {"errors": listed, "detail": _short(listed)}


def _located(fault: ErrorDetails) -> dict[str, str]:
    place = [str(part)[:LONGEST_PLACE] for part in fault["loc"]]
    if fault["type"] == "json_invalid":
        place = ["body"]
    inside = place[1:] if place[0] in ("body", "query", "path", "header") else place
    reason = fault.get("ctx", {}).get("error", "") if fault["type"] == "json_invalid" else ""
    detail = f"{fault['msg']}: {reason}" if reason else fault["msg"]
    return {
        "name": templates.plain(".".join(inside) or place[0], LONGEST_PLACE),
        "code": fault["type"],
        "detail": detail,
    }


def _short(listed: Iterable[Mapping[str, object]]) -> str:
    return "; ".join(f"{fault['name']}: {fault['detail']}" for fault in listed)[:500]


def _unreachable(error: templates.Unreachable) -> dict[str, object]:
    ends = [None if end != end else end for end in error.reachable]
    listed = [{"name": f"target.{error.name}", "code": "unreachable", "detail": str(error)}]
    return {"reachable": [{"value": end, "unit": error.unit} for end in ends], "errors": listed}


def _geometry(error: GeometryError) -> dict[str, object]:
    names = error.parameters or ("model",)
    return {"errors": [{"name": name, "code": error.code, "detail": error.detail} for name in names]}


def _untested(error: worksheets.TestsFailed) -> dict[str, object]:
    return {"errors": [{"name": "text", "code": "test_failed", "detail": text} for text in error.reasons]}


_CARRIED: dict[type[Exception], Callable[..., dict[str, object]]] = {
    templates.InvalidInputs: _faults,
    RequestValidationError: _validation,
    InvalidBody: _validation,
    templates.Unreachable: _unreachable,
    GeometryError: _geometry,
    UnreadableModel: lambda error: {"errors": [{"name": "file", "code": error.code, "detail": error.detail}]},
    AnalysisError: lambda error: {
        "errors": [{"name": error.name, "code": error.code, "detail": error.detail}]
    },
    designs.NotConverged: lambda error: {"rounds": error.rounds},
    worksheets.TestsFailed: _untested,
    worksheets.UnresolvedRegions: lambda error: {
        "errors": [{"name": "text", "code": "unresolved", "detail": text} for text in error.reasons]
    },
    RowsLost: lambda error: {"job": f"/api/v1/jobs/{error.job}"},
    CannotRebuild: lambda error: {
        **error.links,
        "errors": [{"name": "artifact", "code": error.code, "detail": error.detail}],
    },
    workers.WorkerError: lambda error: {
        "errors": [{"name": "model", "code": kind_of(error).slug, "detail": str(error)}]
    },
}


router = APIRouter(tags=["problems"])


@router.get("/problems/{slug}", responses=refusals(404), dependencies=[public()])
def explain_problem(slug: str) -> ProblemKind:
    """Return the meaning of a kind of problem, and its remedy."""
    if slug not in SLUGS:
        raise HTTPException(404, f"there is no problem {slug[:60]!r}")
    return ProblemKind(**vars(SLUGS[slug]))


def answer(about: Mapping[str, Json], headers: Mapping[str, str] | None = None) -> Response:
    """Return a problem as a response, with the id of the request."""
    about = {**about, "request_id": id_} if (id_ := logs.REQUEST_ID.get()) else about
    return ProblemResponse(dict(about), about["status"], headers=dict(headers or {}), media_type=MEDIA_TYPE)


class ProblemResponse(JSONResponse):
    """A response with a problem, which may quote what a client sent, but never a key."""

    def render(self, content: object) -> bytes:
        """Return the problem as JSON."""
        return without_keys(super().render(content).decode()).encode()


def install(app: FastAPI) -> None:
    """Make the app answer every error with a problem."""
    for cls in TABLE:
        app.add_exception_handler(cls, _handle)
    app.add_exception_handler(HTTPException, _handle_http)
    app.add_exception_handler(Exception, _handle_unexpected)


_PASSING = (jobs.QueueFull, RowsLost, storage.ArtifactsUnreachable, storage.DatabaseUnavailable)
"""Temporary problems; each answer states when to retry."""


def refusal(error: Exception) -> Response:
    """Return the response to an error, with the headers that the error states."""
    headers = getattr(error, "headers", {})
    if isinstance(error, _PASSING):
        headers = {"Retry-After": str(error.retry_after)}
    return answer(describe(error), headers)


async def _handle(request: Request, error: Exception) -> Response:
    return refusal(error)


async def _handle_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    kind = HTTP.get(error.status_code) or Kind("http", error.status_code, error.detail, "see `detail`")
    headers = {"Allow": allowed_methods(request)} if error.status_code == 405 else error.headers
    return answer(problem(kind, f"{request.url.path}: {error.detail}"[:2000]), headers)


async def _handle_unexpected(request: Request, error: Exception) -> Response:
    metrics.FAILURES.labels("internal").inc()
    logger.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return answer(describe(error))


METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")


def allowed_methods(request: Request) -> str:
    """Return all methods of the routes for the path of a request, as in the header Allow.

    Starlette names only the methods of the first matching route; here each method of a path is a separate
    route.
    """
    root = request.scope.get("app_root_path", request.scope.get("root_path", ""))
    return ", ".join(method for method in METHODS if _takes(request, method, root))


def _takes(request: Request, method: str, root: str) -> bool:
    scope = {**request.scope, "method": method, "root_path": root}
    for route in request.app.router.routes:
        if route.matches(dict(scope))[0] is Match.FULL:
            # a mounted app matches every method, but files can only be read
            return method in ("GET", "HEAD") if isinstance(route, Mount) else True
    return False
