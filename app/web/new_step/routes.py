"""The routes of the form of a new step."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.web.new_step.page import beside, new_step, step_page
from app.web.shared.paths import Id
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/designs/new")
async def new_design(request: Request, services: ThePageServices) -> Response:
    """The empty form of a new design's first step."""
    typed = dict(request.query_params)
    step = await new_step(services, typed)
    hidden = {"design_name": "new design", **beside(typed)}
    return step_page(request, step, "/designs", hidden)


@router.get("/designs/{id}/steps/new")
async def another_step(id: Id, request: Request, services: ThePageServices) -> Response:
    """The empty form of one more step of a design."""
    typed = dict(request.query_params)
    step, design = await new_step(services, typed), await services.run(services.designs.show, id)
    hidden = {**beside(typed), "add": "template", "revision": str(design.revision)}
    return step_page(request, step, f"/designs/{id}/blocks", hidden)
