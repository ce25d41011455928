"""The pages for importing from Mathcad: the form, its progress, and the outcome of every region."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response

from app.web.shared.file_form import FileForm, Upload
from app.web.shared.multipart import forms_with_files
from app.web.shared.paths import Id, Text
from app.web.shared.responses import show
from app.web.shared.services import PageServices, ThePageServices
from app.worksheets.routes.imports import FileName, NewId, read_import
from app.worksheets.schemas.imports import ImportedRegion

_SHEET = re.compile(r"/api/v1/worksheets/([a-z0-9_]+)")


class NewSheet(Upload):
    """The id for an imported worksheet, and the name of its file."""

    id: NewId
    file: FileName = "sheet.mcdx"


def _address(result: str) -> str | None:
    sheet = _SHEET.fullmatch(result)
    return sheet and f"/worksheets/{sheet[1]}/import"


FORM = FileForm(
    "/worksheets/import",
    "worksheet_import/worksheet_import.html",
    "a .mcdx of Mathcad Prime or a .xmcd or .xmcdz of Mathcad 11 to 15",
    NewSheet,
    lambda services: services.imports.begin,
    _address,
)
router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.get(FORM.path)
async def import_form(request: Request, services: ThePageServices, job: Text = "", id: Text = "") -> Response:
    """Return the form for a file, the progress of its job, or the regions or the refusal."""
    return await FORM.show(request, services, job, id)


@forms.post(FORM.path)
async def import_file(request: Request, services: ThePageServices) -> Response:
    """Import the chosen file; if it is refused at once, return the form with the reason."""
    return await FORM.send(request, services)


@router.get("/worksheets/{id}/import")
async def import_report(id: Id, request: Request, services: ThePageServices) -> Response:
    """Return the page that shows every region of the sheet with its outcome."""
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
    """Return both results as text, shortened to the first items of a list."""
    return _written(region.mathcad, region.unit), _written(region.worksheet, region.unit)


def _written(values: list[float] | list[float | None], unit: str | None) -> str:
    if not values:
        return "–"
    some = ", ".join("none" if value is None else f"{value:.10g}" for value in values[:4])
    more = f", … ({len(values)} items)" if len(values) > 4 else ""
    return f"{some}{more}{'' if unit in (None, '1') else ' ' + unit}"
