"""The approval of a revision, and comments, as pages show them."""

from __future__ import annotations

from app.approvals.routes import list_all_comments, list_comments
from app.approvals.schemas import Approvals, CommentList
from app.web.services import PageServices

ON_DESIGN = 10  # comments on the page of a design; that of a revision has all, page by page


async def approval_of(services: PageServices, id: str, number: int) -> Approvals:
    """The approval of a revision."""
    return await services.run(services.approving.show, id, number)


async def comments_of(
    services: PageServices, id: str, number: int | None, limit: int, cursor: str = ""
) -> CommentList:
    """Comments on a revision, or on all of a design."""
    if number:
        return await services.run(list_comments, id, number, services.comments, limit, cursor or None)
    return await services.run(list_all_comments, id, services.comments, limit, cursor or None)
