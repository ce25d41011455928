"""Handle the forms of the table of variants: edited cells, a pasted table, an uploaded file.

Each form saves a table, as `PUT /designs/{id}/variants` does. If the table is refused, the page shows it
again with a message next to each faulty cell.
"""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response
from pydantic import JsonValue
from starlette.concurrency import run_in_threadpool

from app.designs.variant_sheets.grid import Grid
from app.designs.variant_sheets.service import Kind, read_sheet, save_sheet
from app.schemas.problems import Fault
from app.web.design.page import design_page
from app.web.shared.forms import fields
from app.web.shared.multipart import forms_with_files, parts_of
from app.web.shared.paths import Id
from app.web.shared.responses import go
from app.web.shared.services import PageServices, Refused, ThePageServices, tag_of
from app.web.variants.cells import CsvFile, csv_of, grid_of_form, with_units
from app.web.variants.table import EMPTY, RefusedTable, places_of
from templates.core.errors import InvalidInputs

STALE, WRONG = 412, 422
CHANGED = "Somebody else saved this design meanwhile: {}. Check your table again, then save it."


router = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.post("/designs/{id}/variants")
async def save_cells(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save the table as edited on the page."""
    typed = await fields(request)
    design = await services.run(services.designs.show, id)
    network = await services.run(services.designs.network, id)
    units = {name: "" if unit == "1" else unit for name, unit in places_of(network, design).items()}
    grid = with_units(grid_of_form(typed), units)
    file = csv_of(grid)
    return await _saved(
        request, services, id, _Upload(file.content, "csv", typed.get("revision", "")), grid, file
    )


@router.post("/designs/{id}/variants/pasted")
async def save_pasted(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save a table pasted from a spreadsheet."""
    typed = await fields(request)
    content = typed.get("table", "").encode()
    return await _saved(request, services, id, _Upload(content, "csv", typed.get("revision", "")))


@router.post("/designs/{id}/variants/file")
async def save_file(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save a table from a spreadsheet file."""
    parts = await parts_of(request)
    content = bytes(parts["file"].content) if "file" in parts else b""
    revision = parts["revision"].text if "revision" in parts else ""
    return await _saved(
        request, services, id, _Upload(content, "xlsx" if content[:2] == b"PK" else "csv", revision)
    )


@router.post("/designs/{id}/table")
async def save_columns(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save which values the table of results shows, one name a line, and whether it shows changes."""
    typed = await fields(request)
    columns: list[JsonValue] = list(re.split(r"[\s,;]+", typed.get("columns", "").strip()))
    chosen: dict[str, JsonValue] = {"columns": [one for one in columns if one], "changes": "changes" in typed}
    try:
        await services.change(id, typed.get("revision", ""), {"table": chosen})
    except Refused as refused:
        if refused.status not in (STALE, WRONG):
            raise
        detail = refused.problem.detail
        notice = CHANGED.format(detail) if refused.status == STALE else f"Nothing was saved: {detail}"
        return await design_page(request, services, id, notice=notice, status=refused.status)
    return go(f"/designs/{id}#variants")


class _Upload:
    """A table, its file type, and the revision on which it is based."""

    def __init__(self, content: bytes, kind: Kind, revision: str) -> None:
        self.content, self.kind, self.tag = content, kind, tag_of(revision)


async def _saved(
    request: Request,
    services: PageServices,
    id: str,
    upload: _Upload,
    grid: Grid | None = None,
    file: CsvFile | None = None,
) -> Response:
    """Return the page of the design after a save, or with the refused table."""
    try:
        await services.save(
            save_sheet, services.designs, id, upload.content, upload.kind, upload.tag, services.once
        )
    except Refused as refused:
        if refused.status not in (STALE, WRONG):
            raise
        shown = await run_in_threadpool(_cells, upload) if grid is None else grid
        errors = [file.on_page(fault) if file else fault for fault in refused.problem.errors]
        return await _again(request, services, id, refused, RefusedTable(shown, _by_name(errors)))
    return go(f"/designs/{id}#variants")


def _by_name(errors: list[Fault]) -> dict[str, str]:
    return {fault.name: fault.detail for fault in errors}


def _cells(upload: _Upload) -> Grid:
    """Return the cells of a refused file, if they can be shown."""
    try:
        return read_sheet(upload.content, upload.kind)
    except InvalidInputs:
        return EMPTY


async def _again(
    request: Request, services: PageServices, id: str, refused: Refused, table: RefusedTable
) -> Response:
    detail = refused.problem.detail
    notice = CHANGED.format(detail) if refused.status == STALE else None
    if notice is None and not table.faults:
        notice = f"Nothing was saved: {detail}"
    return await design_page(request, services, id, table=table, notice=notice, status=refused.status)
