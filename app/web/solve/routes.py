"""The routes of the pages that solve a template or a design."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.web.shared.paths import Id, Number
from app.web.shared.services import ThePageServices
from app.web.solve.page import solve_page
from app.web.solve.template_page import template_solve_page

router = APIRouter(include_in_schema=False)


@router.get("/templates/{id}/{version}/solve")
async def solve_template(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Return the page that solves a template for one input; the address holds the request and the inputs."""
    return await template_solve_page(request, services, id, version)


@router.get("/designs/{id}/solve")
async def solve(id: Id, request: Request, services: ThePageServices) -> Response:
    """Return the page that solves a design for one parameter; the address contains the request."""
    return await solve_page(request, services, id)
