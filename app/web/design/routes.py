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
    """Return the page of a design at its newest revision.

    It is read-only while one of its templates is quarantined.
    """
    return await or_stored(request, services, id, None, design_page(request, services, id))


@router.get("/designs/{id}/step")
async def step(id: Id, request: Request, services: ThePageServices, name: Text = "") -> Response:
    """Return the section of one step of a design's newest revision.

    The page of a long design loads it when the user unfolds the step.
    """
    return await step_section(request, services, id, name)


@router.get("/designs/{id}/blocks")
@router.get("/designs/{id}/auto-map")
@router.get("/designs/{id}/copy")
@router.get("/designs/{id}/delete")
@router.get("/designs/{id}/undelete")
@router.get("/designs/{id}/rename")
@router.get("/designs/{id}/variants")
@router.get("/designs/{id}/table")
@router.get("/designs/{id}/variants/pasted")
@router.get("/designs/{id}/variants/file")
@router.get("/designs/{id}/labels")
@router.get("/designs/{id}/revisions/{_}/restore")
@router.get("/designs/{id}/jobs/{_}/cancel")
async def after_a_form(id: Id, request: Request) -> Response:
    """Redirect to the design if a browser reloads the address of a refused form."""
    query = f"?{request.url.query}" if request.url.query else ""
    return go(f"/designs/{id}{query}")
