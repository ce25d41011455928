"""The routes of the page of a template."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.catalogue.routes.templates import list_template_versions
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go
from app.web.shared.services import ThePageServices
from app.web.template.page import template_page

router = APIRouter(include_in_schema=False)


@router.get("/templates/{id}")
async def newest_template(id: Id, services: ThePageServices) -> Response:
    """Redirect to the latest version."""
    versions = await services.run(list_template_versions, id, services.catalogues)
    return go(f"/templates/{id}/{next(item.version for item in versions.items if item.latest)}")


@router.get("/templates/{id}/{version}")
async def template(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Show a template with a form to try it; the address holds the typed values."""
    return await template_page(request, services, id, version)
