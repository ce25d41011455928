"""The routes of the page of a model."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.solids.routes.models import list_model_versions
from app.web.model.page import model_page
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/models/{id}")
async def newest_model(id: Id, services: ThePageServices) -> Response:
    """The latest version."""
    versions = await services.run(list_model_versions, id, services.catalogues)
    return go(f"/models/{id}/{next(item.version for item in versions.items if item.latest)}")


@router.get("/models/{id}/{version}")
async def model(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """A CAD model, with a form to build it; what is typed stands in the address."""
    return await model_page(request, services, id, version)
