"""`/curves`: a CSV file, as the inputs of templates take it."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.concurrency import run_in_threadpool

from app.calculations.curves import read_curves
from app.calculations.schemas.curves import Curves
from app.http.access import needs
from app.http.strict_requests import NotCsv, StrictRoute

router = APIRouter(prefix="/api/v1", tags=["curves"], route_class=StrictRoute)

EXAMPLE = "crank angle [deg], pressure [bar]\n0, 1.0\n180, 1.0\n360, 60.0\n540, 3.5\n"
BODY = {
    "content": {"text/csv": {"schema": {"type": "string", "minLength": 1, "examples": [EXAMPLE]}}},
    "required": True,
}


@router.post("/curves", openapi_extra={"requestBody": BODY}, dependencies=[needs("viewer")])
async def read_curve_table(request: Request) -> Curves:
    """Read a table of curves, such as an indicator diagram: `{"curves": {"pressure": {"value", "unit"}}}`.

    The body is the file itself: a header with names and units, a row for each point. Each curve can be pasted
    into `inputs` under the name wanted there. Nothing is stored.
    """
    kind, _, extra = request.headers.get("content-type", "").lower().partition(";")
    charset = extra.partition("charset=")[2].strip(' "') or "utf-8"
    if kind.strip() != "text/csv" or charset not in ("utf-8", "us-ascii"):
        raise NotCsv("send the file itself as text/csv, in UTF-8")
    curves = await run_in_threadpool(read_curves, await request.body())
    return Curves.model_validate({"curves": curves})
