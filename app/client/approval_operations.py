"""The client's calls for approvals of revisions, and comments on them."""

from __future__ import annotations

from app.approvals.schemas import Approvals, Comment, CommentList, ReleasedRevision
from app.client.design_operations import once
from app.client.exchange import Exchange, answered, get, listed, post
from app.schemas.approval_steps import Step


def approvals(id: str, revision: int) -> Exchange[Approvals]:
    """Return the completed steps of a revision's approval, the next step, and the digest to sign."""
    return answered(Approvals, get(f"/designs/{id}/revisions/{revision}/approvals"))


def approve(
    seen: Approvals,
    step: Step,
    reason: str | None = None,
    *,
    acknowledged: str | None = None,
    key: str | None = None,
) -> Exchange[Approvals]:
    """Take the next step of an approval that was read before; a withdrawal needs a reason.

    To check or release a revision whose approvals list `unconfirmed` criteria, state in `acknowledged` why
    that is acceptable.
    """
    said = {"step": step, "reason": reason, "acknowledged": acknowledged}
    body = {name: text for name, text in said.items() if text is not None}
    path = f"/designs/{seen.design}/revisions/{seen.revision}/approvals"
    return answered(Approvals, post(path, body, {"If-Match": f'"{seen.to_sign}"', **once(key)}))


def released(id: str) -> Exchange[ReleasedRevision]:
    """Return the newest released revision of a design, with links to its files."""
    return answered(ReleasedRevision, get(f"/designs/{id}/released"))


def comments(id: str, revision: int) -> Exchange[list[Comment]]:
    """Return the comments on a revision, newest first."""
    return listed(CommentList, f"/designs/{id}/revisions/{revision}/comments")


def comment(
    id: str, revision: int, text: str, subject: str | None = None, *, key: str | None = None
) -> Exchange[Comment]:
    """Add a comment on a revision, or on one of its names such as `film.bearing_width`."""
    body = {"text": text, "subject": subject}
    return answered(Comment, post(f"/designs/{id}/revisions/{revision}/comments", body, once(key)))


def resolve_comment(comment: Comment) -> Exchange[Comment]:
    """Mark a comment as resolved."""
    path = f"/designs/{comment.design}/revisions/{comment.revision}/comments/{comment.id}/resolve"
    return answered(Comment, post(path, {}))
