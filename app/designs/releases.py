"""The released revisions of a design, and the progress of their approval."""

from __future__ import annotations

from collections.abc import Collection

from sqlalchemy import bindparam, func, select
from sqlalchemy.orm import Session, aliased

from app.schemas.approval_steps import ORDER, Step
from app.storage.errors import NotFound
from app.storage.tables import ApprovalRow, RevisionRow
from app.storage.units import Statement

_withdrawal = aliased(ApprovalRow)
_IS_WITHDRAWN = (
    select(_withdrawal.step)
    .where(
        _withdrawal.design_id == ApprovalRow.design_id,
        _withdrawal.revision == ApprovalRow.revision,
        _withdrawal.step == "withdrawn",
    )
    .exists()
)

_EVER_SIGNED = select(func.max(ApprovalRow.revision)).where(ApprovalRow.design_id == bindparam("design"))
EVER_SIGNED = Statement(_EVER_SIGNED, "design")
"""Selects the newest revision of a `design` that has a signature, even if withdrawn since; or null."""
OF_NEWEST_RELEASED = _EVER_SIGNED.where(ApprovalRow.step == "released", ~_IS_WITHDRAWN)
NEWEST_RELEASED = Statement(OF_NEWEST_RELEASED, "design")
"""Selects the newest released revision of a `design` that is not withdrawn; or null."""


def newest_released(session: Session, design: str) -> int:
    """Return the number of the newest released revision of a design.

    Raises
    ------
    NotFound
        If none is released, or all of them are withdrawn.
    """
    number: int | None = NEWEST_RELEASED.scalar(session, {"design": design})
    if number is None:
        raise NotFound(f"design {design[:80]!r} has no released revision")
    return number


def released_of(session: Session, designs: Collection[str]) -> dict[str, int]:
    """Return the newest released revision of each design that has one."""
    query = (
        select(ApprovalRow.design_id, func.max(ApprovalRow.revision))
        .where(ApprovalRow.design_id.in_(designs), ApprovalRow.step == "released", ~_IS_WITHDRAWN)
        .group_by(ApprovalRow.design_id)
    )
    return dict(session.execute(query).all())


def state_of(session: Session, row: RevisionRow) -> Step | None:
    """Return the latest step in the approval of a revision; None before the first."""
    newest = select(ApprovalRow.step).where(
        ApprovalRow.design_id == row.design_id, ApprovalRow.revision == row.number
    )
    return last_of(set(session.scalars(newest)))


def last_of(steps: Collection[str]) -> Step | None:
    """Return the latest of several approval steps; None if there are none."""
    return next((step for step in reversed(ORDER) if step in steps), None)
