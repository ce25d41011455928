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
    """Show which values of one input give a wanted output; question and inputs stand in the address."""
    return await template_solve_page(request, services, id, version)


@router.get("/designs/{id}/solve")
async def solve(id: Id, request: Request, services: ThePageServices) -> Response:
    """Show which value of one parameter gives a wanted output; the question stands in the address."""
    return await solve_page(request, services, id)
