"""`POST /studies` with a file: CSV or XLSX rows in the body, all other members in the query."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.routing import Match
from starlette.types import Scope

from app.api.dependencies import TheOnce, TheStudies, services_of
from app.http.access import TheClient
from app.http.strict_requests import StrictRoute
from app.presentation.spreadsheets import XLSX
from app.studies.bodies import study_of
from app.studies.routes.studies import answer_begun, calculated_in_pool
from app.studies.schemas import Study
from app.studies.uploads import FileKind, read_rows
from app.workers.pieces import Pieces

KINDS: dict[str, FileKind] = {
    "text/csv": "csv",
    XLSX: "xlsx",
}
"""Content types of files with rows."""


def _kind(scope: Scope) -> FileKind | None:
    """Return the kind of file in the body of a request; None if it is not a file."""
    given = Headers(scope=scope).get("content-type", "")
    return KINDS.get(given.partition(";")[0].strip().lower())


class FileRoute(StrictRoute):
    """A route for files; other bodies go to the JSON route of the same path."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Match like any route, but only if the body is a file."""
        match, child = super().matches(scope)
        return (match, child) if match is not Match.FULL or _kind(scope) else (Match.NONE, {})


router = APIRouter(prefix="/api/v1/studies", tags=["studies"], route_class=FileRoute)

Names = Annotated[str | None, Query(max_length=5000, description="names separated by commas")]
Tolerance = Annotated[float | None, Query(gt=0, lt=1)]


@router.post("", status_code=202, response_model=Study, include_in_schema=False)
async def begin_study_of_file(
    studies: TheStudies,
    once: TheOnce,
    client: TheClient,
    request: Request,
    design: Annotated[str, Query(max_length=64)],
    outputs: Names = None,
    minimise: Names = None,
    maximise: Names = None,
    hold: Names = None,
    build: Annotated[str, Query(max_length=2000)] = "none",
    variant: Annotated[str | None, Query(max_length=64)] = None,
    revision: Annotated[int | None, Query(ge=1, le=10**9)] = None,
    explore: Tolerance = None,
    confirm: Tolerance = None,
) -> Response:
    """Begin a study with method `table` from a file.

    The file has a row of names, an optional row of units, then numbers.
    """
    kind, content = _kind(request.scope) or "csv", Pieces.of(await request.body())
    pool = services_of(request).calculations
    places = await run_in_threadpool(studies.places, design, revision)
    rows = await calculated_in_pool(pool, pool.submit(client, read_rows, content, kind, places))
    lists = {"outputs": outputs, "minimise": minimise, "maximise": maximise, "hold": hold}
    body = study_of(
        {
            "design": design,
            "method": "table",
            "rows": rows,
            "build": _build(build),
            **{name: _names(text) for name, text in lists.items() if text is not None},
            **({"revision": revision} if revision is not None else {}),
            **({"variant": variant} if variant else {}),
            **({"explore": {"tolerance": explore}} if explore else {}),
            **({"confirm": {"tolerance": confirm}} if confirm else {}),
        }
    )
    return await answer_begun(request, client, studies, body, once)


def _names(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _build(text: str) -> str | list[int]:
    """Return a word, or a list of row numbers."""
    numbers = _names(text)
    return (
        [int(n) for n in numbers] if numbers and all(n.isdecimal() and len(n) < 9 for n in numbers) else text
    )
