"""Read the approval of a revision, sign a step, or withdraw a release."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.approvals.content import (
    STEP,
    criteria_of,
    digest,
    present,
    prints,
    require_files,
    shown,
    steps_taken,
    to_sign,
)
from app.approvals.errors import ApprovalError, NotReady, OtherDigest
from app.approvals.rules import (
    next_step,
    require_acknowledgement,
    require_principal,
    require_turn,
    state_of,
    unconfirmed,
)
from app.approvals.schemas import (
    ApprovalIn,
    Approvals,
    Present,
    PrintedReport,
    ReleasedRevision,
    SignedContent,
)
from app.designs import repository
from app.designs.releases import NEWEST_RELEASED, newest_released
from app.identity import audit
from app.identity.errors import RoleNeeded
from app.identity.principal import acting
from app.schemas.approval_steps import Step
from app.storage.artifacts import Artifacts
from app.storage.clock import now
from app.storage.database import Database
from app.storage.idempotency import Once
from app.storage.tables import ApprovalRow, RevisionRow


class ApprovalService:
    """Approvals of revisions."""

    def __init__(self, database: Database, store: Artifacts) -> None:
        self.database, self.store = database, store

    def show(self, id: str, number: int) -> Approvals:
        """Return the approval of a revision as the acting principal sees it.

        Raises
        ------
        NotFound
            If there is no such revision.
        """
        with self.database.read() as session:
            return _shown(session, repository.lean(session, id, number))

    def sign(self, id: str, number: int, body: ApprovalIn, expected: str, once: Once) -> Approvals:
        """Take a step on behalf of the acting principal.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        RoleNeeded, SamePrincipal
            If the principal may not take this step.
        OutOfOrder, NotReady
            If another step must be taken first, or this step was already taken.
        Unacknowledged
            If criteria are not confirmed and the body does not say why that is acceptable.
        OtherDigest
            If `expected` (an If-Match) is not the digest of the content to sign.
        """
        self._require_good_files(id, number)

        def unit(session: Session) -> Approvals:
            if once.begin(session) is None:
                repository.locked(session, id)
                _take(session, repository.revision(session, id, number), body, expected)
                once.keep(session, 201, {"design": id, "revision": number})
            return _shown(session, repository.revision(session, id, number))

        return self.database.write(unit)

    def released(self, id: str) -> ReleasedRevision:
        """Return the newest released revision of a design.

        Raises
        ------
        NotFound
            If there is none.
        """
        with self.database.read() as session:
            repository.design(session, id)
            row = repository.revision(session, id, newest_released(session, id))
            release = next(one for one in steps_taken(session, row) if one.step == "released")
            now, place = present(session, row), f"/api/v1/designs/{id}/revisions/{row.number}"
        own = {name: kinds for name, kinds in now.files.items() if "." not in name}
        return ReleasedRevision(
            design=id,
            revision=row.number,
            title=row.document["name"],
            approval=shown(release),
            report=f"{place}/report.pdf",
            files={name: _links(f"{place}/models/{name}", kinds) for name, kinds in own.items()},
        )

    def _require_good_files(self, id: str, number: int) -> None:
        """Check that the stored STEP files of a revision are intact; raises NotReady."""
        with self.database.read() as session:
            files = present(session, repository.revision(session, id, number)).files
        for name, kinds in files.items():
            if STEP in kinds and not self.store.exists(kinds[STEP]):
                raise NotReady(f"the STEP file of {name} is lost: GET it to rebuild it, then sign")


def _links(place: str, kinds: dict[str, str]) -> dict[str, str]:
    return {kind: f"{place}/model.{kind}" for kind in sorted(kinds)}


def _take(session: Session, row: RevisionRow, body: ApprovalIn, expected: str) -> None:
    """Check a step, and store it."""
    who, taken, held = acting(), steps_taken(session, row), present(session, row)
    require_principal(body.step, who, row, taken)
    require_turn(body.step, taken, row.number)
    files = require_files(row, held)
    previous = taken[-1].digest if taken else None
    if expected.strip() != f'"{(right := to_sign(row, held, previous))}"':
        raise OtherDigest(right)
    open_ones = unconfirmed(criteria_of(session, row))
    require_acknowledgement(body.step, body.acknowledged, open_ones, row.number)
    statement = {"unconfirmed": open_ones, "acknowledged": body.acknowledged} if body.acknowledged else {}
    signed = SignedContent(
        design=row.design_id,
        revision=row.number,
        title=row.document["name"],
        step=body.step,
        principal=who.id,
        name=who.name,
        at=max(now(), taken[-1].at if taken else ""),  # the clock may have been set back
        document=held.document,
        results=held.results,
        files=files,
        previous=previous,
        prints="recorded",
        **({"account_by": creator} if (creator := audit.creator(session, who.id)) else {}),
        **({"reason": body.reason} if body.reason else {}),
        **statement,
    )
    _write(session, signed)


def _write(session: Session, signed: SignedContent) -> None:
    content = signed.plain()
    session.add(
        ApprovalRow(
            design_id=signed.design,
            revision=signed.revision,
            step=signed.step,
            principal_id=signed.principal,
            name=signed.name,
            digest=digest(content),
            content=content,
            at=signed.at,
        )
    )
    session.flush()
    place = f"designs/{signed.design}/revisions/{signed.revision}"
    audit.record(session, f"revision.{_VERBS[signed.step]}", place, digest(content), signed.at)


_VERBS: dict[Step, str] = {
    "calculated": "hand_over",
    "checked": "check",
    "released": "release",
    "withdrawn": "withdraw",
}


def _shown(session: Session, row: RevisionRow) -> Approvals:
    taken, held = steps_taken(session, row), present(session, row)
    session.flush()  # the step taken may be the release
    following, newest = next_step(taken), NEWEST_RELEASED.scalar(session, {"design": row.design_id})
    return Approvals(
        design=row.design_id,
        revision=row.number,
        state=state_of(taken),
        steps=[shown(one) for one in taken],
        next=following,
        unconfirmed=unconfirmed(criteria_of(session, row)),
        obstacle=_obstacle(row, taken, held),
        to_sign=to_sign(row, held, taken[-1].digest if taken else None),
        present=held,
        prints=[PrintedReport.model_validate(one) for one in prints(session, row)],
        supersedes=row.supersedes,
        superseded_by=newest if newest is not None and newest > row.number else None,
    )


def _obstacle(row: RevisionRow, taken: list[ApprovalRow], held: Present) -> str | None:
    """Return the reason why the acting principal cannot take the next step now."""
    following = next_step(taken)
    if following is None:
        return None
    try:
        require_files(row, held)
        require_principal(following, acting(), row, taken)
    except (ApprovalError, RoleNeeded) as error:
        return str(error)
    return None
