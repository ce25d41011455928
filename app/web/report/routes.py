"""The route that redirects to a report."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.web.shared.paths import Id
from app.web.shared.responses import go, units_of

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/report")
async def report(id: Id, request: Request) -> Response:
    """Redirect to the report of a design."""
    return go(f"/api/v1/designs/{id}/report.html?units={units_of(request)}")
