"""`/studies`: begin a study, show it and its rows, choose a row, cancel or delete it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from functools import partial
from tempfile import TemporaryFile
from typing import IO, Annotated

from fastapi import APIRouter, Depends, Path, Query, Request, Response
from fastapi.responses import StreamingResponse
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic.config import JsonDict
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import (
    OneStream,
    TheDesigns,
    TheJobs,
    TheOnce,
    TheStudies,
    TheThreads,
    Units,
    services_of,
)
from app.api.event_streams import LastEvent, Whole, as_it_stands, listening
from app.api.responses import written
from app.designs.routes.designs import CHANGED, IfMatch, Prefer, answer_saved, seconds_waited
from app.designs.schemas.designs import Design
from app.http.access import TheClient
from app.http.attachments import MemoryFile, disposition
from app.http.pages import Cursor, Limit, page
from app.http.paths import register_id
from app.http.strict_requests import PreconditionRequired, StrictRoute
from app.jobs.events import newest_numbers
from app.plain import Json
from app.pool.pool import Calculation, CalculationPool
from app.presentation.spreadsheets import XLSX
from app.schemas.problems import Responses, refusals
from app.storage.idempotency import Once
from app.storage.tables import StudyRow
from app.studies import exports, repository, views
from app.studies.bodies import ChooseIn, StudyIn
from app.studies.plan import Plan, planned
from app.studies.row_columns import StoredRows
from app.studies.schemas import Study, StudyEstimate, StudyList, StudyRows
from app.studies.service import ENDED, Draft, Studies
from app.studies.views import RowList, RowQuery, Where
from templates.core.arrays import Array

register_id("study", ["estimate"])
router = APIRouter(prefix="/api/v1/studies", tags=["studies"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64)]
Columns = Annotated[
    str | None,
    Query(max_length=5000, description="names of places and outputs, separated by commas; by default all"),
]
Fits = Annotated[Where | None, Query(description="only rows with this verdict, or only refused rows")]
Sort = Annotated[
    str | None, Query(max_length=200, description="a column; prefix it with `-` for descending order")
]
FILES: JsonDict = {
    "requestBody": {
        "content": {"text/csv": {"schema": {"type": "string"}}, XLSX: {"schema": {"type": "string"}}}
    }
}
BEGUN: Responses = {
    202: {"description": "the study is queued; the header Location has its address"},
    **refusals(404, 429),
}


@router.post("", status_code=202, response_model=Study, responses=BEGUN, openapi_extra=FILES)
async def begin_study(
    body: StudyIn, studies: TheStudies, once: TheOnce, client: TheClient, request: Request
) -> Response:
    """Begin a study of a revision; its cost is estimated before it begins.

    With a CSV or XLSX file as body, the file has the rows of a `table` study, and `design`, `outputs` and the
    other members are query parameters.
    """
    return await answer_begun(request, client, studies, body, once)


async def answer_begun(
    request: Request, client: str, studies: Studies, body: StudyIn, once: Once
) -> Response:
    """Return the study that a request begins, or began before."""
    id = await begun(request, client, studies, body, once)
    shown = await run_in_threadpool(_shown, studies, id)
    return written(shown, 202, {"Location": f"/api/v1/studies/{id}"})


async def begun(request: Request, client: str, studies: Studies, body: StudyIn, once: Once) -> str:
    """Return the id of the study that a request begins, or began before."""
    id = await run_in_threadpool(studies.begun_before, once)
    if id is None:
        draft = await run_in_threadpool(studies.draft, body)
        plan, given = await _planned(request, client, draft)
        id = await run_in_threadpool(studies.begin, draft, plan, given, once)
    return id


@router.post("/estimate", responses=refusals(404, 429))
async def estimate_study(
    body: StudyIn, studies: TheStudies, client: TheClient, request: Request
) -> StudyEstimate:
    """Estimate the rows, levels, time and solids of a study without beginning it."""
    draft = await run_in_threadpool(studies.draft, body)
    plan, _ = await _planned(request, client, draft)
    return views.estimate(plan)


async def _planned(request: Request, client: str, draft: Draft) -> tuple[Plan, Array | None]:
    """Return the plan of a study, calculated in the pool, and the rows that its user gave."""
    pool = services_of(request).calculations
    calculation = pool.submit(client, planned, draft.task, draft.rows, draft.solid_seconds)
    plan, given = await calculated_in_pool(pool, calculation)
    return plan, given


async def calculated_in_pool(pool: CalculationPool, calculation: Calculation) -> Json:
    """Return the result of a calculation; cancel the calculation if the request is cancelled."""
    try:
        return await asyncio.shield(asyncio.wrap_future(calculation.future))
    except BaseException:
        pool.cancel(calculation)
        raise


@router.get("")
def list_studies(
    studies: TheStudies,
    limit: Limit = 50,
    cursor: Cursor = None,
    design: Annotated[str | None, Query(max_length=64, description="only studies of this design")] = None,
) -> StudyList:
    """Return studies, newest first."""
    with studies.database.read() as session:
        rows = repository.page(session, limit, cursor, design)
        return page(StudyList, rows, limit, lambda row: views.study(session, row), lambda row: row.id)


@router.get("/{id:study}", responses=refusals(404))
def show_study(id: Id, studies: TheStudies, units: Units = "si") -> Study:
    """Return a study: its state, its progress, and the result of its method."""
    return _shown(studies, id).in_units(units)


@router.delete(
    "/{id:study}", response_model=Study, responses={204: {"description": "removed"}, **refusals(403, 404)}
)
def end_study(id: Id, studies: TheStudies, client: TheClient) -> Response:
    """Cancel one's own study that waits or runs, or delete a finished study with its rows."""
    row = studies.end(id, client)
    return Response(status_code=204) if row is None else written(_shown(studies, id))


@router.get("/{id}/rows", responses=refusals(404, 410, 503))
def list_rows(
    id: Id,
    studies: TheStudies,
    columns: Columns = None,
    where: Fits = None,
    sort: Sort = None,
    limit: Limit = 50,
    cursor: Cursor = None,
    units: Units = "si",
) -> StudyRows:
    """Return rows that have been calculated, filtered and sorted."""
    listing = _listing(studies, id, columns, where, sort)
    with studies.reading(id):
        return listing.page(limit, views.start_of(cursor), units)


@router.get("/{id}/rows.csv", response_class=StreamingResponse, responses=refusals(404, 410, 503))
def download_csv(
    id: Id,
    studies: TheStudies,
    columns: Columns = None,
    where: Fits = None,
    sort: Sort = None,
    units: Units = "si",
) -> Response:
    """Return all or the selected rows as CSV: headings with units, names for programs, then the numbers."""
    listing = _listing(studies, id, columns, where, sort)
    with studies.reading(id):
        listing.stored.verify()  # after the response has begun, an error could only truncate it
    headers = {"Content-Disposition": _named(id, "csv")}
    return StreamingResponse(
        exports.csv_parts(listing, units), media_type="text/csv; charset=utf-8", headers=headers
    )


@router.get("/{id}/rows.xlsx", response_class=StreamingResponse, responses=refusals(404, 410, 503))
async def download_xlsx(
    id: Id,
    studies: TheStudies,
    threads: TheThreads,
    columns: Columns = None,
    where: Fits = None,
    sort: Sort = None,
    units: Units = "si",
) -> Response:
    """Return at most 20 000 rows as an XLSX sheet."""

    def content() -> bytes:
        with studies.reading(id):
            return exports.xlsx(_listing(studies, id, columns, where, sort), units)

    return MemoryFile(await threads.run(content), XLSX, {"Content-Disposition": _named(id, "xlsx")})


@router.get("/{id}/rows.npz", response_class=StreamingResponse, responses=refusals(404, 410, 503))
def download_npz(
    id: Id, studies: TheStudies, columns: Columns = None, where: Fits = None, sort: Sort = None
) -> Response:
    """Return all or the selected rows as named NumPy arrays in the units of the design.

    Equal studies give equal bytes.
    """
    listing = _listing(studies, id, columns, where, sort)
    file = TemporaryFile()  # closed after it is sent
    try:
        with studies.reading(id):
            exports.write_npz(listing, file)
    except BaseException:
        file.close()
        raise
    length = str(file.tell())
    file.seek(0)
    headers = {"Content-Disposition": _named(id, "npz"), "Content-Length": length}
    return StreamingResponse(_pieces(file), media_type="application/zip", headers=headers)


def _pieces(file: IO[bytes]) -> Iterator[bytes]:
    with file:
        while piece := file.read(2**18):
            yield piece


@router.post("/{id}/choose", response_model=Design, responses={**CHANGED, **refusals(412, 428)})
async def choose_row(
    id: Id,
    body: ChooseIn,
    studies: TheStudies,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Create a revision of the design with the values of a row."""
    if if_match is None:
        raise PreconditionRequired('send If-Match with the ETag of the design you read, such as "3"')
    saved = await threads.run_within(
        seconds_waited(prefer), request, studies.choose, id, body.row, body.note, if_match, once
    )
    return await answer_saved(designs, jobs, saved, prefer)


@router.get(
    "/{id}/events",
    response_class=EventSourceResponse,
    dependencies=[Depends(show_study)],
    responses=refusals(404, 429),
)
async def watch_study(
    id: Id, studies: TheStudies, jobs: TheJobs, place: OneStream, last: LastEvent
) -> AsyncIterator[ServerSentEvent]:
    """Stream the study whenever its state changes, and its progress, until it has ended."""
    topic = f"job:{(await run_in_threadpool(_row, studies, id)).job}"
    async with listening(jobs.events, topic) as events:
        async for event in as_it_stands(events, place, partial(_whole, studies, id, topic), last, study=id):
            yield event


def _row(studies: Studies, id: str) -> StudyRow:
    with studies.database.read() as session:
        return repository.get(session, id)


def _shown(studies: Studies, id: str) -> Study:
    with studies.database.read() as session:
        return views.study(session, repository.get(session, id))


def _whole(studies: Studies, id: str, topic: str) -> Whole:
    with studies.database.read() as session:
        study = views.study(session, repository.get(session, id))
        number = newest_numbers(session, [topic]).get(topic, 0)
    return Whole(number, study.state, study, study.state in ENDED)


def _listing(
    studies: Studies, id: str, columns: str | None, where: Where | None, sort: str | None
) -> RowList:
    with studies.database.read() as session:
        row = repository.get(session, id)
        stored = StoredRows(studies.store, repository.chunks(session, id))
    names = tuple(dict.fromkeys(part.strip() for part in (columns or "").split(",") if part.strip()))
    return RowList(row, stored, RowQuery(names, where, sort))


def _named(id: str, kind: str) -> str:
    name = f"study_{id}.{kind}"
    return disposition(name, name)
