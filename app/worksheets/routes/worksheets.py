"""`/worksheets`: templates that an engineer writes as text, from the draft to the release.

In `app.calculations.routes.evaluate`, `worksheet` means the printed steps of one calculation.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Query, Response
from fastapi.responses import PlainTextResponse
from pydantic.config import JsonDict

from app.api.dependencies import TheOnce, TheThreads, TheWorksheets
from app.api.responses import written
from app.http.access import TheClient, needs
from app.http.pages import Cursor, Limit, page
from app.http.paths import register_id
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals
from app.storage.tables import WorksheetVersionRow
from app.worksheets import repository, views
from app.worksheets.bodies import ReviewIn, SheetCheckIn, SheetIn, SheetPatch, WithdrawIn
from app.worksheets.check import checked
from app.worksheets.names import RESERVED
from app.worksheets.schemas.worksheets import Sheet, SheetCheck, SheetList
from app.worksheets.service import Worksheets

register_id("sheet", RESERVED)
router = APIRouter(prefix="/api/v1/worksheets", tags=["worksheets"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64, examples=["bush_duty"])]
Number = Annotated[int, Path(ge=1, le=10**6)]
IfMatch = Annotated[str | None, Header(description="the ETag of the worksheet that was read")]
OfVersion = Annotated[int | None, Query(ge=1, le=10**6, description="the version; by default the newest")]
STEP = refusals(404, 409, 412, 429)
"""Problems with which a change of a worksheet's state may be refused."""
PATCH: JsonDict = {
    "requestBody": {
        "content": {"application/merge-patch+json": {"schema": {"$ref": "#/components/schemas/SheetPatch"}}}
    }
}


@router.post("/check", response_model=SheetCheck, responses=refusals(429), dependencies=[needs("viewer")])
async def check_worksheet(
    body: SheetCheckIn, worksheets: TheWorksheets, threads: TheThreads, client: TheClient
) -> Response:
    """Check a text: return every fault with its line, or every line with the numbers of the example.

    Nothing is saved. A faulty text is not an error of the request.
    """
    content = await threads.run(worksheets.calculated, client, checked, body.text, body.id)
    return Response(content, media_type="application/json")


@router.post("", status_code=201, response_model=Sheet, responses=refusals(409, 429))
async def create_worksheet(
    body: SheetIn, worksheets: TheWorksheets, threads: TheThreads, once: TheOnce
) -> Response:
    """Create a worksheet as a draft with its faults; 409 if a file or another worksheet has the id."""
    row = await threads.run(worksheets.create, body, once)
    return await threads.run(_shown, worksheets, row, 201)


@router.get("")
def list_worksheets(worksheets: TheWorksheets, limit: Limit = 50, cursor: Cursor = None) -> SheetList:
    """Return every worksheet at its newest version, in the order of the ids."""
    broken = worksheets.published.broken
    with worksheets.database.read() as session:
        rows = repository.page(session, limit, cursor)
    return page(SheetList, rows, limit, lambda row: views.summary(row, broken), lambda row: row.id)


@router.get("/{id:sheet}", response_model=Sheet, responses=refusals(404))
def read_worksheet(id: Id, worksheets: TheWorksheets) -> Response:
    """Return a worksheet at its newest version; the ETag identifies this text and state."""
    return _shown(worksheets, worksheets.newest(id))


@router.patch("/{id:sheet}", response_model=Sheet, responses=refusals(404, 429), openapi_extra=PATCH)
async def change_worksheet(
    id: Id,
    body: SheetPatch,
    worksheets: TheWorksheets,
    threads: TheThreads,
    once: TheOnce,
    if_match: IfMatch = None,
) -> Response:
    """Change a worksheet, which becomes a draft again; a released version is followed by a new one."""
    row = await threads.run(worksheets.change, id, body, if_match, once)
    return await threads.run(_shown, worksheets, row)


@router.delete("/{id:sheet}", status_code=204, responses=refusals(404, 409))
def delete_worksheet(id: Id, worksheets: TheWorksheets, if_match: IfMatch = None) -> Response:
    """Delete the newest version if it was never released; earlier versions stay."""
    worksheets.delete(id, if_match)
    return Response(status_code=204)


@router.get("/{id}/versions/{number}", response_model=Sheet, responses=refusals(404))
def read_worksheet_version(id: Id, number: Number, worksheets: TheWorksheets) -> Response:
    """Return one version of a worksheet."""
    return _shown(worksheets, worksheets.version(id, number))


@router.get("/{id}/text", response_class=PlainTextResponse, responses=refusals(404))
def read_worksheet_text(id: Id, worksheets: TheWorksheets, version: OfVersion = None) -> Response:
    """Return the text of a worksheet as it was written, for example to store it in git."""
    row = worksheets.newest(id) if version is None else worksheets.version(id, version)
    name = f"{row.id}_v{row.number}.sheet"
    headers = {"ETag": f'"{row.edit}"', "Content-Disposition": f'inline; filename="{name}"'}
    return Response(row.text.encode(), media_type="text/plain; charset=utf-8", headers=headers)


@router.post("/{id}/test", response_model=Sheet, responses=STEP)
async def try_worksheet(
    id: Id, worksheets: TheWorksheets, threads: TheThreads, client: TheClient, if_match: IfMatch = None
) -> Response:
    """Run the tests of the worksheet, and calculate its example and inputs near it: draft → tested."""
    row = await threads.run(worksheets.test, id, if_match, client)
    return await threads.run(_shown, worksheets, row)


@router.post(
    "/{id}/review", response_model=Sheet, responses={**STEP, **refusals(403)}, dependencies=[needs("checker")]
)
def review_worksheet(id: Id, body: ReviewIn, worksheets: TheWorksheets, if_match: IfMatch = None) -> Response:
    """Record who reviewed the text with this digest: tested → reviewed. A typed name is not verified."""
    return _shown(worksheets, worksheets.review(id, body, if_match))


@router.post("/{id}/release", response_model=Sheet, responses=STEP, dependencies=[needs("checker")])
async def release_worksheet(
    id: Id, worksheets: TheWorksheets, threads: TheThreads, client: TheClient, if_match: IfMatch = None
) -> Response:
    """Make the reviewed version a template, which never changes: reviewed → released."""
    row = await threads.run(worksheets.release, id, if_match, client)
    return await threads.run(_shown, worksheets, row)


@router.post("/{id}/withdraw", response_model=Sheet, responses=STEP, dependencies=[needs("checker")])
def withdraw_worksheet(
    id: Id, body: WithdrawIn, worksheets: TheWorksheets, if_match: IfMatch = None
) -> Response:
    """Withdraw a released version and give the reason; designs that use it still calculate."""
    return _shown(worksheets, worksheets.withdraw(id, body, if_match))


def _shown(worksheets: Worksheets, row: WorksheetVersionRow, status: int = 200) -> Response:
    answer = worksheets.show(row)
    place = {"Location": f"/api/v1/worksheets/{row.id}"} if status == 201 else {}
    return written(answer, status, {"ETag": f'"{row.edit}"', **place})
