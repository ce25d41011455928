"""The route of the page that compares two revisions."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.web.compare.page import CompareForm, compare_page
from app.web.shared.paths import Id, Text
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/compare")
async def compared(
    id: Id,
    request: Request,
    services: ThePageServices,
    revision: Text = "",
    number: Annotated[str, Query(alias="with", max_length=200)] = "",
    design: Text = "",
    of: Text = "",
) -> Response:
    """Two revisions, of this design or of this and another one."""
    return await compare_page(request, services, id, CompareForm(revision, number, design, of))
