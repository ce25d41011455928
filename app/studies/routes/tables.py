"""`POST /studies` with a file: the file holds the rows as CSV or XLSX, the query parameters the rest."""

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
    """Return the kind of file that a request says it brings."""
    given = Headers(scope=scope).get("content-type", "")
    return KINDS.get(given.partition(";")[0].strip().lower())


class FileRoute(StrictRoute):
    """A route that takes files; other bodies go to the route of the same path that takes JSON."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Match as any route does, if the body is a file."""
        match, child = super().matches(scope)
        return (match, child) if match is not Match.FULL or _kind(scope) else (Match.NONE, {})


router = APIRouter(prefix="/api/v1/studies", tags=["studies"], route_class=FileRoute)

Names = Annotated[str | None, Query(max_length=5000, description="separated by commas")]
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
    """A study with method `table`: a row of names, perhaps one of units, then the numbers."""
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
    """Return a word, or numbers of rows."""
    numbers = _names(text)
    return (
        [int(n) for n in numbers] if numbers and all(n.isdecimal() and len(n) < 9 for n in numbers) else text
    )
