"""The stamp of a downloaded model file: its design, revision, date, materials and signatures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.designs import repository, statements
from app.designs.result_records import results_of
from app.designs.schemas.designs import RoundedValue
from app.identity.principal import LOCAL
from app.plain import Json
from app.presentation.numbers import rounded
from app.reference import Reference
from app.schemas.approval_steps import ORDER
from app.solids import rows
from app.storage.tables import ApprovalRow, PrincipalRow, RevisionModelRow
from cad.model import material_named
from cad.stamp import Stamp

_MM3 = 1e-9  # 1 mm³ in m³


def stamp(session: Session, model: RevisionModelRow) -> Stamp:
    """Return the stamp of a built model; it never changes, because a revision never changes."""
    about = {"of": model.design_id, "at": model.number}
    ((document, created),) = statements.DOCUMENT.run(session, about)
    build = rows.build(session, model.build_key or "")
    return Stamp(
        design=document["name"],
        model=model.own_name,
        revision=model.number,
        date=created[:19],  # UTC, to the second
        materials=_materials(build) if build else {},
        variant=model.variant,
        is_only=len(document["models"]) == 1,
        mass=build.measurements["measures"]["mass"] if build else None,
    )


def signed(session: Session, model: RevisionModelRow, owner: str) -> Stamp:
    """Return the stamp with the title-block entries of the approval, which every approval step changes.

    After the submission, the name of the author no longer changes.
    """
    revision = repository.lean(session, model.design_id, model.number)
    of_revision = ApprovalRow.design_id == model.design_id, ApprovalRow.revision == model.number
    names = {row.step: row.name for row in session.scalars(select(ApprovalRow).where(*of_revision))}
    author = session.get(PrincipalRow, revision.author) if revision.author not in (None, LOCAL.id) else None
    return replace(
        stamp(session, model),
        owner=owner,
        author=names.get("calculated") or (author.name if author else ""),
        checker=names.get("checked", ""),
        approver=names.get("released", ""),
        rounded=_rounded(results_of(session, revision).rounded.get(model.variant, []), model.own_name),
        status=next((step for step in reversed(ORDER) if step in names), "unsigned"),
    )


def _rounded(values: Iterable[RoundedValue], model: str) -> str:
    """Return the rounded parameters of a model on one line; empty if there are none."""
    own = ((Reference.parse(value.name), value) for value in values)
    return "; ".join(
        f"{place.member.replace('_', ' ')}: {rounded(value)}" for place, value in own if place.block == model
    )


def _materials(build: rows.Build) -> Mapping[str, str]:
    """Return the materials of a build's parts.

    A build of an older recipe has one material, identified by its density.
    """
    measured: Mapping[str, Json] = build.measurements
    if "materials" in measured:
        materials: dict[str, str] = measured["materials"]
        return materials
    measures = measured["measures"]
    return {build.model: material_named("", measures["mass"] / (measures["volume"] * _MM3))}
