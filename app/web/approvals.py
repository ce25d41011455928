"""The approval of a revision, and comments, as pages show them."""

from __future__ import annotations

from app.approvals.schemas import Approvals, CommentList
from app.web.api import Api

ON_DESIGN = 10  # comments on the page of a design; that of a revision has all, page by page


async def approval_of(api: Api, id: str, number: int) -> Approvals:
    """The approval of a revision."""
    return await api.get(f"/designs/{id}/revisions/{number}/approvals", Approvals)


async def comments_of(api: Api, id: str, number: int | None, limit: int, cursor: str = "") -> CommentList:
    """Comments on a revision, or on all of a design."""
    of_one = f"/revisions/{number}" if number else ""
    place = {"cursor": cursor} if cursor else {}
    return await api.get(f"/designs/{id}{of_one}/comments", CommentList, limit=limit, **place)
