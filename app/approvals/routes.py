"""`/designs/{id}/revisions/{number}/approvals` and `/comments`, and `/designs/{id}/released`."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Response

from app.api.dependencies import TheApproving, TheComments, TheOnce
from app.api.responses import written
from app.approvals.comments import shown
from app.approvals.schemas import ApprovalIn, Approvals, Comment, CommentIn, CommentList, ReleasedRevision
from app.designs.routes.designs import Id, Number
from app.http.pages import Cursor, Limit, page
from app.http.strict_requests import PreconditionRequired, StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs/{id}", tags=["approvals"], route_class=StrictRoute)

CommentId = Annotated[str, Path(max_length=64)]
SEEN = "`to_sign` of the approvals that were read, in quotes"


@router.get("/released", responses=refusals(404))
def show_released(id: Id, approving: TheApproving) -> ReleasedRevision:
    """Return the newest released revision that is not withdrawn, with links to its report and files."""
    return approving.released(id)


@router.get("/revisions/{number}/approvals", response_model=Approvals, responses=refusals(404))
def show_approvals(id: Id, number: Number, approving: TheApproving) -> Response:
    """Return the completed steps, the next step, and the digest to sign, which is also the ETag."""
    return _answer(approving.show(id, number), 200)


@router.post(
    "/revisions/{number}/approvals",
    status_code=201,
    response_model=Approvals,
    responses=refusals(403, 404, 409, 412, 428),
)
def sign_revision(
    id: Id,
    number: Number,
    body: ApprovalIn,
    approving: TheApproving,
    once: TheOnce,
    if_match: Annotated[str | None, Header(description=SEEN)] = None,
) -> Response:
    """Take a step: `calculated` by its author, `checked` and `released` by two other principals.

    After the first step the revision is locked and never changes. Every checker can withdraw a release that
    proves wrong (`withdrawn`) and must state a reason; the revision itself stays unchanged.
    """
    if if_match is None:
        raise PreconditionRequired("send If-Match with the value of `to_sign` from the approvals, in quotes")
    return _answer(approving.sign(id, number, body, if_match, once), 201)


@router.get("/comments", responses=refusals(404))
def list_all_comments(id: Id, comments: TheComments, limit: Limit = 50, cursor: Cursor = None) -> CommentList:
    """Return the comments on all revisions of a design, newest first."""
    rows = comments.page(id, None, limit, cursor)
    return page(CommentList, rows, limit, shown, lambda row: row.id)


@router.get("/revisions/{number}/comments", responses=refusals(404))
def list_comments(
    id: Id, number: Number, comments: TheComments, limit: Limit = 50, cursor: Cursor = None
) -> CommentList:
    """Return the comments on a revision, newest first."""
    rows = comments.page(id, number, limit, cursor)
    return page(CommentList, rows, limit, shown, lambda row: row.id)


@router.post("/revisions/{number}/comments", status_code=201, responses=refusals(404))
def add_comment(id: Id, number: Number, body: CommentIn, comments: TheComments, once: TheOnce) -> Comment:
    """Add a comment on a revision or on one name in it; the revision itself does not change."""
    return comments.add(id, number, body, once)


@router.post("/revisions/{number}/comments/{comment}/resolve", responses=refusals(404))
def resolve_comment(id: Id, number: Number, comment: CommentId, comments: TheComments) -> Comment:
    """Mark a comment as resolved; a resolved comment stays unchanged."""
    return comments.resolve(id, number, comment)


def _answer(approvals: Approvals, status: int) -> Response:
    return written(approvals, status, {"ETag": f'"{approvals.to_sign}"'})
