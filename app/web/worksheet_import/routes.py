"""The pages of an import from Mathcad: the form, its progress, and the outcome of every region."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel

from app.web.shared.design_answers import job_of
from app.web.shared.multipart import forms_with_files, parts_of
from app.web.shared.paths import Id, Text
from app.web.shared.responses import go, show
from app.web.shared.services import PageServices, Refused, ThePageServices
from app.worksheets.routes.imports import FileName, NewId, read_import
from app.worksheets.schemas.imports import ImportedRegion

MISSED = (409, 415, 422, 429)
"""Errors that the form explains, because the user can correct them."""
_JOB = re.compile(r"[A-Za-z0-9-]{1,64}")


class NewSheet(BaseModel):
    """The id of a worksheet to be imported, and the name of its file."""

    id: NewId
    file: FileName = "sheet.mcdx"


router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.get("/worksheets/import")
async def import_form(request: Request, services: ThePageServices, job: Text = "", id: Text = "") -> Response:
    """Show the form for a file; while its job runs, the wait; then the regions or the refusal."""
    if not _JOB.fullmatch(job):
        return _form(request, id)
    work = await job_of(services, job)
    if work.state == "done" and work.result:
        return go(f"{work.result.removeprefix('/api/v1')}/import")
    if work.problem is not None:
        return _form(request, id, work.problem.detail, work.problem.status)
    answer = show(request, "worksheet_import/worksheet_import.html", typed_id=id, notice="", waiting=work)
    answer.headers["Refresh"] = "1"  # the page needs no script to wait
    return answer


@forms.post("/worksheets/import")
async def import_file(request: Request, services: ThePageServices) -> Response:
    """Send the chosen file; where it is refused at once, the form again with the reason."""
    parts = await parts_of(request)
    id = parts["id"].text.strip() if "id" in parts else ""
    chosen = parts.get("file")
    if chosen is None or not chosen.content:
        said = "choose a file: a .mcdx of Mathcad Prime or a .xmcd or .xmcdz of Mathcad 11 to 15"
        return _form(request, id, said, 422)
    name = "".join(sign for sign in (chosen.file or "") if sign.isprintable())[-200:].strip()
    try:
        job = await begun_import(services, chosen.content, id, name)
    except Refused as refused:
        if refused.status not in MISSED:
            raise
        said = "; ".join(refused.faults.values()) or refused.problem.detail
        return _form(request, id, said, refused.status)
    return go(f"/worksheets/import?job={job}&id={id}")


async def begun_import(services: PageServices, content: bytes, id: str, name: str) -> str:
    """Begin the import of a file, and return its job.

    Raises
    ------
    Refused
        If the file is refused at once.
    """
    given = services.read(NewSheet, {"id": id, **({"file": name} if name else {})})
    return await services.ask(
        services.threads.run(services.imports.begin, content, given.id, given.file, services.once)
    )


@router.get("/worksheets/{id}/import")
async def import_report(id: Id, request: Request, services: ThePageServices) -> Response:
    """Every region of the sheet, and what became of it."""
    return await _report(request, services, id)


async def _report(request: Request, services: PageServices, id: str) -> Response:
    sheet = await services.run(services.worksheets.sheet, id)
    report = await services.run(read_import, id, services.worksheets)
    counts = [(state, count) for state, count in report.regions if count]
    rows = [(region, _values(region)) for region in report.items if region.kind != "text"]
    return show(
        request, "worksheet_import/import_report.html", sheet=sheet, report=report, counts=counts, rows=rows
    )


def _values(region: ImportedRegion) -> tuple[str, str]:
    """Return both results in words: the first items of a list."""
    return _written(region.mathcad, region.unit), _written(region.worksheet, region.unit)


def _written(values: list[float] | list[float | None], unit: str | None) -> str:
    if not values:
        return "–"
    some = ", ".join("none" if value is None else f"{value:.10g}" for value in values[:4])
    more = f", … ({len(values)} items)" if len(values) > 4 else ""
    return f"{some}{more}{'' if unit in (None, '1') else ' ' + unit}"


def _form(request: Request, id: str, notice: str = "", status: int = 200) -> Response:
    return show(
        request, "worksheet_import/worksheet_import.html", status, typed_id=id, notice=notice, waiting=None
    )
