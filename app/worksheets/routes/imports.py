"""`/worksheets/import`: import Mathcad sheets as drafts, and report the outcome of each region."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response

from app.api.dependencies import TheIdentity, TheImports, TheOnce, TheStore, TheThreads, TheWorksheets
from app.api.file_answers import UNCHANGED, StoredFile
from app.api.responses import FILE_LATER, file_accepted
from app.http.strict_requests import SHEET_TYPES, StrictRoute, require_sheet
from app.schemas.problems import refusals
from app.storage.errors import NotFound
from app.worksheets.bodies import ID, NAME
from app.worksheets.imports.views import imported
from app.worksheets.routes.worksheets import Id
from app.worksheets.schemas.imports import SheetImport

router = APIRouter(prefix="/api/v1/worksheets", tags=["worksheets"], route_class=StrictRoute)

BINARY = {"schema": {"type": "string", "format": "binary"}}
BODY = {"requestBody": {"required": True, "content": dict.fromkeys(sorted(SHEET_TYPES), BINARY)}}
NewId = Annotated[
    str, Query(max_length=64, pattern=ID, description="id of the worksheet", examples=["bush_duty"])
]
FileName = Annotated[str, Query(max_length=200, pattern=NAME, description="name of the file")]


@router.post(
    "/import",
    status_code=202,
    responses={**FILE_LATER, **refusals(409, 429)},
    openapi_extra=BODY,
    dependencies=[Depends(require_sheet)],
)
async def import_worksheet(
    request: Request,
    imports: TheImports,
    identity: TheIdentity,
    threads: TheThreads,
    once: TheOnce,
    id: NewId,
    file: FileName = "sheet.mcdx",
) -> Response:
    """Import a sheet of Mathcad Prime (.mcdx) or Mathcad 11 to 15 (.xmcd, .xmcdz) as a draft.

    The body of the request is the file itself. The result of the job is the worksheet. `GET
    /worksheets/{id}/import` lists the outcome of every region of the sheet.
    """
    body = await request.body()
    job = await threads.run(imports.begin, memoryview(body), id, file, once)
    return await threads.run(file_accepted, job, identity)


@router.get("/{id}/import", responses=refusals(404))
def read_import(id: Id, worksheets: TheWorksheets) -> SheetImport:
    """Return the result of the import for every region of the original sheet."""
    return imported(worksheets.newest(id))


@router.get("/{id}/import/original", response_class=Response, responses={**UNCHANGED, **refusals(404, 503)})
def read_original(id: Id, worksheets: TheWorksheets, store: TheStore) -> Response:
    """Return the file from which a worksheet was imported, unchanged."""
    row = worksheets.newest(id)
    if row.import_sha256 is None or row.imported is None:
        raise NotFound(f"worksheet {id} was typed, not imported")
    headers = {"ETag": f'"{row.import_sha256}"'}
    return StoredFile(store, row.import_sha256, "application/octet-stream", headers, row.imported["file"])
