"""The route of the page of tolerances."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.web.shared.paths import Id
from app.web.shared.services import ThePageServices
from app.web.tolerances.page import tolerances_page

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/tolerances")
async def tolerances(
    id: Id,
    request: Request,
    services: ThePageServices,
    job: Annotated[str | None, Query(max_length=64, pattern=r"^[A-Za-z0-9_-]+$")] = None,
    part: Annotated[str, Query(max_length=1)] = "",
) -> Response:
    """Show the effects of a design's tolerances; `part` returns only the part for the design page."""
    return await tolerances_page(request, services, id, job, is_part=bool(part))
