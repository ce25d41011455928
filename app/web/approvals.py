"""The approval of a revision, and comments, as pages show them."""

from __future__ import annotations

from app.approvals.routes import list_all_comments, list_comments
from app.approvals.schemas import Approvals, CommentList
from app.web.api import Api

ON_DESIGN = 10  # comments on the page of a design; that of a revision has all, page by page


async def approval_of(api: Api, id: str, number: int) -> Approvals:
    """The approval of a revision."""
    return await api.run(api.approving.show, id, number)


async def comments_of(api: Api, id: str, number: int | None, limit: int, cursor: str = "") -> CommentList:
    """Comments on a revision, or on all of a design."""
    if number:
        return await api.run(list_comments, id, number, api.comments, limit, cursor or None)
    return await api.run(list_all_comments, id, api.comments, limit, cursor or None)
