"""The content that a signature covers: the document, results, files, signer, time and previous step."""

from __future__ import annotations

import hashlib

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.approvals.errors import NotReady
from app.approvals.schemas import Approval, Files, Present, SignedContent
from app.designs.result_records import results_of
from app.schemas.approval_steps import ORDER
from app.schemas.criteria import Criterion
from app.solids import rows
from app.storage.tables import ApprovalRow, PrintedReportRow, RevisionRow, canonical_json

STEP = "step"


def digest(value: object) -> str:
    """Return the SHA-256 of a JSON value in its canonical form."""
    return hashlib.sha256(canonical_json(value).encode()).hexdigest()


def present(session: Session, row: RevisionRow) -> Present:
    """Return the hashes of the present contents of a revision."""
    builds = {m.name: m.build_key for m in (*row.models, *row.variant_models) if m.build_key}
    files = rows.artifacts_of(session, set(builds.values()))
    return Present(
        document=digest(row.document),
        results=results_of(session, row).digest,
        files={name: files.get(key, {}) for name, key in builds.items()},
    )


def criteria_of(session: Session, row: RevisionRow) -> list[Criterion]:
    """Return the judged criteria of a revision; with variants, each has the verdict of its worst variant."""
    judged = results_of(session, row).judged.get("criteria")
    return judged if isinstance(judged, list) else []


def to_sign(row: RevisionRow, now: Present, previous: str | None) -> str:
    """Return the digest of the content to sign; it stays the same until a step is taken.

    It covers only the STEP files, because the service derives all other files from them.
    """
    steps = {name: {STEP: kinds[STEP]} for name, kinds in now.files.items() if STEP in kinds}
    return digest(
        {
            "design": row.design_id,
            "revision": row.number,
            "document": now.document,
            "results": now.results,
            "files": steps,
            "previous": previous,
        }
    )


def require_files(row: RevisionRow, now: Present) -> Files:
    """Return the files of a revision that is calculated and has a solid for every model.

    Raises
    ------
    NotReady
        If the revision is not calculated, or a model has no solid.
    """
    if row.state != "current":
        why = "is being regenerated; wait for it" if row.state == "regenerating" else "failed; correct it"
        raise NotReady(f"revision {row.number} {why}")
    bare = [model.name for model in row.models if STEP not in now.files.get(model.name, {})]
    bare += [name for name, kinds in now.files.items() if STEP not in kinds and name not in bare]
    if bare:
        raise NotReady(f"{', '.join(bare)} has no solid: set its dimensions before signing")
    return now.files


def steps_taken(session: Session, row: RevisionRow) -> list[ApprovalRow]:
    """Return the completed steps of a revision's approval, in order."""
    of_revision = ApprovalRow.design_id == row.design_id, ApprovalRow.revision == row.number
    rows = {row.step: row for row in session.scalars(select(ApprovalRow).where(*of_revision))}
    return [rows[step] for step in ORDER if step in rows]


def prints(session: Session, row: RevisionRow) -> list[PrintedReportRow]:
    """Return the reports that were printed of a revision since its first signature, oldest first."""
    of_revision = PrintedReportRow.design_id == row.design_id, PrintedReportRow.revision == row.number
    query = select(PrintedReportRow).where(*of_revision)
    return list(session.scalars(query.order_by(PrintedReportRow.at, PrintedReportRow.sha256)))


def shown(row: ApprovalRow) -> Approval:
    """Return a step as the interface shows it."""
    return Approval.model_validate(
        {
            "step": row.step,
            "principal": row.principal_id,
            "name": row.name,
            "at": row.at,
            "digest": row.digest,
            "content": row.content,
        }
    )


def hashed(content: SignedContent) -> str:
    """Return the digest of the signed content."""
    return digest(content.plain())
