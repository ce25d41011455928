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

router = APIRouter(prefix="/api/v1/designs/{id}", tags=["approval"], route_class=StrictRoute)

CommentId = Annotated[str, Path(max_length=64)]
SEEN = "`to_sign` of the approvals that were read, in quotes"


@router.get("/released", responses=refusals(404))
def show_released(id: Id, approving: TheApproving) -> ReleasedRevision:
    """The newest released revision that is not withdrawn, and links to its report and files."""
    return approving.released(id)


@router.get("/revisions/{number}/approvals", response_model=Approvals, responses=refusals(404))
def show_approvals(id: Id, number: Number, approving: TheApproving) -> Response:
    """The steps that were taken, the next step, and the digest to sign, which is also the ETag."""
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

    From the first step on the revision is locked: nothing of it changes any more. A release that proves wrong
    is `withdrawn` by any checker, with a reason; the revision stays as it is.
    """
    if if_match is None:
        raise PreconditionRequired("send If-Match with the value of `to_sign` from the approvals, in quotes")
    return _answer(approving.sign(id, number, body, if_match, once), 201)


@router.get("/comments", responses=refusals(404))
def list_all_comments(id: Id, comments: TheComments, limit: Limit = 50, cursor: Cursor = None) -> CommentList:
    """The comments on all revisions of a design, newest first."""
    rows = comments.page(id, None, limit, cursor)
    return page(CommentList, rows, limit, shown, lambda row: row.id)


@router.get("/revisions/{number}/comments", responses=refusals(404))
def list_comments(
    id: Id, number: Number, comments: TheComments, limit: Limit = 50, cursor: Cursor = None
) -> CommentList:
    """The comments on a revision, newest first."""
    rows = comments.page(id, number, limit, cursor)
    return page(CommentList, rows, limit, shown, lambda row: row.id)


@router.post("/revisions/{number}/comments", status_code=201, responses=refusals(404))
def add_comment(id: Id, number: Number, body: CommentIn, comments: TheComments, once: TheOnce) -> Comment:
    """A comment on a revision, or on one of its names; it changes nothing of the revision."""
    return comments.add(id, number, body, once)


@router.post("/revisions/{number}/comments/{comment}/resolve", responses=refusals(404))
def resolve_comment(id: Id, number: Number, comment: CommentId, comments: TheComments) -> Comment:
    """Say that a comment is dealt with; one that is resolved already stays as it is."""
    return comments.resolve(id, number, comment)


def _answer(approvals: Approvals, status: int) -> Response:
    return written(approvals, status, {"ETag": f'"{approvals.to_sign}"'})
