"""Show errors as pages if a browser requests a page; the REST interface returns problems."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import cast
from urllib.parse import urlencode

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.datastructures import URL
from starlette.exceptions import HTTPException

from app.identity.errors import NotSignedIn, RoleNeeded
from app.schemas.problems import MEDIA_TYPE, Problem
from app.web.shared.responses import go, show
from app.web.shared.services import Refused

BASE = "/api/v1"
"""Prefix of the paths of the interface."""
_LONGEST = 2000  # characters of an address
Handler = Callable[[Request, Exception], Awaitable[Response]]


def install(app: FastAPI) -> None:
    """Make errors of pages appear as pages; call this after `problems.install`."""
    app.add_exception_handler(Refused, _refused)
    for cls in (HTTPException, RequestValidationError, RoleNeeded, NotSignedIn, Exception):
        app.add_exception_handler(cls, _page_or(cast(Handler, app.exception_handlers[cls])))


def _page_or(others: Handler) -> Handler:
    """Return a handler that sends a page to browsers and calls another handler for other clients."""

    async def handle(request: Request, error: Exception) -> Response:
        if not _is_page(request):
            return await others(request, error)
        if isinstance(error, HTTPException):
            return _page(request, error.status_code, error.detail)
        if isinstance(error, RoleNeeded):
            return _page(request, 403, str(error), "Your roles do not allow this")
        if isinstance(error, NotSignedIn):
            return go(f"/sign-in?{urlencode({'back': _place(request)})}")
        if isinstance(error, RequestValidationError):
            return _page(request, 404, "there is no such page")
        problem = Problem.model_validate_json(bytes((await others(request, error)).body))
        return _page(request, problem.status, problem.detail, problem.title)

    return handle


def _is_page(request: Request) -> bool:
    return not request.url.path.startswith(BASE) and "text/html" in request.headers.get("accept", "")


def _place(request: Request) -> str:
    """Return the page to open after signing in.

    It is the requested page, or the page whose form was sent.
    """
    place = request.url
    if request.method not in ("GET", "HEAD"):
        place = URL(request.headers.get("referer", "/")[:_LONGEST])
    return f"{place.path}?{place.query}" if place.query else place.path


async def _refused(request: Request, error: Exception) -> Response:
    """Return the page that shows a service's refusal."""
    assert isinstance(error, Refused)
    if not _is_page(request):
        return JSONResponse(
            error.problem.model_dump(mode="json", exclude_unset=True), error.status, media_type=MEDIA_TYPE
        )
    return _page(request, error.status, error.problem.detail, error.problem.title)


def _page(request: Request, status: int, detail: str, title: str | None = None) -> Response:
    titles = {404: "There is no such page", 403: "Not allowed", 405: "Not allowed here"}
    shown = title or titles.get(status, "Something went wrong")
    return show(request, "shared/problem.html", status, title=shown, detail=detail, code=status)
