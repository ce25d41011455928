"""`/designs/{id}/variants` as CSV and XLSX: download and upload the table of variants."""

from __future__ import annotations

import math
from functools import partial

from fastapi import APIRouter, Request, Response

from app.api.dependencies import ExpensiveSteps, TheDesigns, TheJobs, TheOnce, TheThreads
from app.api.responses import later, patience
from app.designs.routes.designs import Id, IfMatch, Prefer
from app.designs.routes.sheet_types import ANSWERS, MEDIA, SheetRoute, sheet_kind
from app.designs.routes.variants import answer_table
from app.designs.schemas.variants import VariantsOut
from app.designs.service import Designs
from app.designs.variant_sheets.service import Kind, save_sheet, write_sheet
from app.designs.variants.views import variants
from app.http.attachments import disposition
from app.http.strict_requests import StrictRoute
from app.schemas.problems import Responses, refusals
from cad.file_names import name as wide_name
from cad.file_names import plain_name

by_type = APIRouter(
    prefix="/api/v1/designs", route_class=SheetRoute, dependencies=[ExpensiveSteps], include_in_schema=False
)
"""Routes of sheets, on the paths of the JSON routes; include this router before the JSON router."""
router = APIRouter(prefix="/api/v1/designs", tags=["variants"], route_class=StrictRoute)


def _described(kind: Kind) -> Responses:
    return {200: {"content": {MEDIA[kind]: ANSWERS[MEDIA[kind]]}}, **refusals(404)}


@router.get("/{id}/variants.csv", response_class=Response, responses=_described("csv"))
def download_variants_as_csv(id: Id, designs: TheDesigns) -> Response:
    """Return the variants of the newest revision as CSV: inputs, which `PUT` accepts, then results.

    Row 1 has the headings, row 2 the units. A relation is in a column whose heading ends with ` =`, without
    its equals sign. When a file is uploaded, columns whose headings begin with `results:` are ignored.
    """
    return _file(designs, id, "csv")


@router.get("/{id}/variants.xlsx", response_class=Response, responses=_described("xlsx"))
def download_variants_as_xlsx(id: Id, designs: TheDesigns) -> Response:
    """Return the variants of the newest revision as XLSX: like CSV, but with numeric cells."""
    return _file(designs, id, "xlsx")


@by_type.get("/{id}/variants")
def show_sheet(id: Id, designs: TheDesigns, request: Request) -> Response:
    """Return the variants of the newest revision as CSV or XLSX."""
    return _file(designs, id, sheet_kind(request) or "csv")


@by_type.put("/{id}/variants", response_model=VariantsOut, responses=later(VariantsOut))
async def replace_variants_by_sheet(
    id: Id,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Create a revision with the variants of a sheet; an error names every faulty cell by its address."""
    kind, content = sheet_kind(request) or "csv", await request.body()
    save = partial(save_sheet, designs, id, content, kind, if_match, once)
    saved = await threads.run_within(patience(prefer, math.inf), request, save)
    return await answer_table(designs, jobs, saved, prefer)


def _file(designs: Designs, id: str, kind: Kind) -> Response:
    with designs.database.read() as session:
        out = variants(session, id, None, designs.catalogues)
    tail = f"_variants_r{out.revision}.{kind}"
    headers = {
        "ETag": f'"{out.revision}"',
        "Design-Revision": str(out.revision),
        "Vary": "Accept",
        "Content-Disposition": disposition(plain_name(out.name) + tail, wide_name(out.name) + tail),
    }
    return Response(write_sheet(out, kind), headers=headers, media_type=MEDIA[kind])
