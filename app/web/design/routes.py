"""The routes of the page of a design."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.web.design.page import design_page, step_section
from app.web.revision.routes import or_stored
from app.web.shared.paths import Id, Text
from app.web.shared.responses import go
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}")
async def design(id: Id, request: Request, services: ThePageServices) -> Response:
    """A design at its newest revision, to be changed; only to be read while its template is quarantined."""
    return await or_stored(request, services, id, None, design_page(request, services, id))


@router.get("/designs/{id}/step")
async def step(id: Id, request: Request, services: ThePageServices, name: Text = "") -> Response:
    """One step of the newest revision of a design; the page of a long design fetches it when it is opened."""
    return await step_section(request, services, id, name)


@router.get("/designs/{id}/blocks")
@router.get("/designs/{id}/auto-map")
@router.get("/designs/{id}/copy")
@router.get("/designs/{id}/delete")
@router.get("/designs/{id}/rename")
@router.get("/designs/{id}/variants")
@router.get("/designs/{id}/variants/pasted")
@router.get("/designs/{id}/variants/file")
@router.get("/designs/{id}/labels")
@router.get("/designs/{id}/revisions/{_}/restore")
@router.get("/designs/{id}/jobs/{_}/cancel")
async def after_a_form(id: Id, request: Request) -> Response:
    """The design: a form that was refused is shown at the address to which it was sent."""
    query = f"?{request.url.query}" if request.url.query else ""
    return go(f"/designs/{id}{query}")
