"""The route of the page of a revision."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.web.revision.page import or_stored, revision_page
from app.web.shared.paths import Id, Number, Text
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/revisions/{number}")
async def revision(
    id: Id,
    number: Number,
    request: Request,
    services: ThePageServices,
    other: Annotated[int | None, Query(alias="with", ge=1, le=10**9)] = None,
    comments: Text = "",
) -> Response:
    """A revision, and what differs from another; `comments` is where a page of comments begins."""
    page = revision_page(request, services, id, number, other, cursor=comments)
    return await or_stored(request, services, id, number, page)
