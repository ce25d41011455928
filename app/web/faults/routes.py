"""The route of the page of a team's faulty files."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.catalogue.routes.faults import list_catalogue_faults
from app.web.shared.paths import Text
from app.web.shared.responses import show
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/templates/faults")
async def faults(request: Request, services: ThePageServices, cursor: Text = "") -> Response:
    """Return the page with the faulty files of a team."""
    faulty = await services.run(list_catalogue_faults, services.catalogues, cursor=cursor or None)
    return show(request, "faults/faults.html", faulty=faulty)
