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
from app.signing.keys import StampKeys
from app.solids import rows
from app.storage.tables import ApprovalRow, PrincipalRow, RevisionModelRow
from cad.face_marks import parameters_in
from cad.file_kinds import plain_kind
from cad.model import material_named
from cad.signed_file import SIGNED, Claims
from cad.signed_file import signed as signed_copy
from cad.stamp import Stamp, stamped

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
        id=model.design_id,
        build=model.build_key or "",
    )


def sent(file: bytes, kind: str, sha: str, stamp: Stamp, keys: StampKeys | None) -> bytes:
    """Return a stored file as a client gets it: with its stamp, which is signed if its kind allows that.

    `sha` is the SHA-256 under which the file is stored. Without keys the stamp stays unsigned.
    """
    plain = plain_kind(kind)
    copy = stamped(file, plain, stamp)
    if keys is None or plain not in SIGNED:
        return copy
    return signed_copy(copy, plain, _claims(copy, kind, sha, stamp, keys.current.id), keys.sign)


def _claims(file: bytes, kind: str, sha: str, stamp: Stamp, key: str) -> Claims:
    """Return what a signed stamp claims about a file: to which revision and to which relations it belongs."""
    only = {"variant": stamp.variant, "part": stamp.part or None}
    return {
        "format": 1,
        "key": key,
        "kind": kind,
        "design": {"id": stamp.id, "name": stamp.design},
        "revision": stamp.revision,
        "date": stamp.date,
        "model": stamp.model,
        **{name: text for name, text in only.items() if text is not None},
        "build": {"key": stamp.build, "sha256": sha},
        "relations": {name: f"{stamp.model}.{name}" for name in parameters_in(file, plain_kind(kind))},
    }


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
