"""`/curves`: convert the columns of a table file to curves that inputs of templates accept."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.calculations.curves import curves_of
from app.calculations.schemas.curves import Curves
from app.http.access import needs
from app.http.strict_requests import NotCsv, StrictRoute
from app.observation.processor_time import in_thread

router = APIRouter(prefix="/api/v1", tags=["curves"], route_class=StrictRoute)

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
CHARSETS = (
    "utf-8",
    "us-ascii",
    "utf-16",
    "utf-16le",
    "utf-16be",
    "iso-8859-1",
    "latin-1",
    "latin1",
    "windows-1252",
)
"""Accepted content types; the content of the file determines its type."""

EXAMPLE = "crank angle [deg], pressure [bar]\n0, 1.0\n180, 1.0\n360, 60.0\n540, 3.5\n"
BODY = {
    "content": {
        "text/csv": {"schema": {"type": "string", "minLength": 1, "examples": [EXAMPLE]}},
        XLSX: {"schema": {"type": "string", "format": "binary"}},
    },
    "required": True,
}


@router.post("/curves", openapi_extra={"requestBody": BODY}, dependencies=[needs("viewer", "admin")])
async def read_curve_table(request: Request) -> Curves:
    """Return the curves of a table, such as an indicator diagram: `{"curves": {"pressure": {"value", …}}}`.

    The body is the file itself, CSV or XLSX: names, units beside or below them, and a row for each point.
    Several cycles are averaged; time and TDC pulses are converted to crank angles. `assumed` lists the
    assumptions. Each curve can be used in `inputs` under the name of an input. Nothing is stored.
    """
    kind, _, extra = request.headers.get("content-type", "").lower().partition(";")
    charset = extra.partition("charset=")[2].strip(' "') or "utf-8"
    if kind.strip() not in ("text/csv", XLSX) or charset not in CHARSETS:
        raise NotCsv(f"send the file itself as text/csv, or as {XLSX}")
    read = await in_thread(curves_of, await request.body())
    return Curves.model_validate({"curves": read.curves, "assumed": read.assumed})
