"""The rules of signing: which principal may take which step, and in which order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from app.approvals.errors import OutOfOrder, SamePrincipal, Unacknowledged
from app.designs.releases import last_of
from app.identity.errors import RoleNeeded
from app.identity.principal import Principal, Role
from app.schemas.approval_steps import ORDER, ApprovalState, Step
from app.schemas.criteria import Criterion
from app.storage.tables import ApprovalRow, RevisionRow

ROLES: dict[Step, Role] = {
    "calculated": "author",
    "checked": "checker",
    "released": "checker",
    "withdrawn": "checker",
}

ACKNOWLEDGING: tuple[Step, ...] = ("checked", "released")
"""The steps in which a person confirms that a design is right."""
MOST_NAMED = 3  # largest number of criteria that a refusal lists


def unconfirmed(criteria: Iterable[Criterion]) -> list[str]:
    """Return one sentence for each criterion that is not waived and not met with a known error."""
    return [f"{one.name}: {one.stated()}" for one in criteria if one.waived is None and not one.is_confirmed]


def require_acknowledgement(
    step: Step, acknowledged: str | None, sentences: Sequence[str], number: int
) -> None:
    """Require a statement on unconfirmed criteria if there are any, and refuse one if there are none.

    Raises
    ------
    Unacknowledged
        If the statement is missing, or every criterion is confirmed.
    """
    is_due = step in ACKNOWLEDGING and bool(sentences)
    if is_due and acknowledged is None:
        more = f"; and {len(sentences) - MOST_NAMED} more" if len(sentences) > MOST_NAMED else ""
        raise Unacknowledged(
            f"criteria of revision {number} are not confirmed: {'; '.join(sentences[:MOST_NAMED])}{more}. "
            "State in `acknowledged` why it may be signed nevertheless"
        )
    if acknowledged is not None and not is_due:
        why = (
            f"every criterion of revision {number} is confirmed"
            if step in ACKNOWLEDGING
            else f"{step} needs none"
        )
        raise Unacknowledged(f"omit `acknowledged`: {why}")


def state_of(taken: Sequence[ApprovalRow]) -> ApprovalState:
    """Return the last completed step of an approval."""
    return last_of({row.step for row in taken}) or "unsigned"


def next_step(taken: Sequence[ApprovalRow]) -> Step | None:
    """Return the next step towards a release; None once the revision is released."""
    steps = {row.step for row in taken}
    return next((step for step in ORDER[:3] if step not in steps), None)


def require_turn(step: Step, taken: Sequence[ApprovalRow], number: int) -> None:
    """Check that a step is the next step.

    Raises
    ------
    OutOfOrder
        If the step was already taken, or another step must be taken first.
    """
    for row in taken:
        if row.step in (step, "withdrawn"):
            raise OutOfOrder(f"revision {number} was {row.step} by {row.name} at {row.at}")
    following = next_step(taken)
    if following is not None and step != following:
        raise OutOfOrder(f"revision {number} must be {following} before it is {step}")
    if following is None and step != "withdrawn":
        raise OutOfOrder(f"revision {number} is released")


def require_principal(step: Step, who: Principal, row: RevisionRow, taken: Sequence[ApprovalRow]) -> None:
    """Check that a principal may take a step.

    Raises
    ------
    RoleNeeded
        If the principal's roles do not allow the step.
    SamePrincipal
        If the principal took another step, or submits a revision of another author.
    """
    if not who.may(ROLES[step]):
        raise RoleNeeded(who, (ROLES[step],))
    if step == "withdrawn":
        return
    if step == "calculated":
        if row.author not in (None, who.id):  # null: saved before the service had principals
            detail = f"revision {row.number} was saved by another principal, who hands it over for checking"
            raise SamePrincipal(f"{detail}; or save a revision of your own", who.id)
        return
    if row.author == who.id:
        raise SamePrincipal(
            f"{who.name} is the author of revision {row.number}: somebody else has to act", who.id
        )
    for before in taken:
        if before.principal_id == who.id:
            raise SamePrincipal(
                f"{who.name} took the step {before.step} of revision {row.number}: somebody else has to act",
                who.id,
            )
