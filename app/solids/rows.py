"""All SQL of builds and their artifacts."""

from __future__ import annotations

from collections.abc import Collection

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.identity import usage
from app.identity.acting import ACTING, BUILT_IN
from app.plain import JsonObject
from app.storage.clock import operated
from app.storage.identity import now
from app.storage.tables import (
    ApprovalRow,
    ArtifactRow,
    BuildRow,
    DesignRow,
    RevisionModelRow,
    variant_of,
)
from app.storage.upserts import upsert_values


def build(session: Session, key: str) -> BuildRow | None:
    """A build by its key, if it was made."""
    return session.get(BuildRow, key)


def artifact(session: Session, key: str, kind: str) -> ArtifactRow | None:
    """One artifact of a build, if it was made."""
    return session.get(ArtifactRow, (key, kind))


def artifact_named(session: Session, sha256: str) -> ArtifactRow | None:
    """An artifact by the hash of its bytes; several builds may have files of equal bytes."""
    return session.scalar(select(ArtifactRow).where(ArtifactRow.sha256 == sha256).limit(1))


def artifacts(session: Session, key: str | None) -> dict[str, str]:
    """The SHA-256 of every artifact of a build, by kind."""
    rows = session.scalars(select(ArtifactRow).where(ArtifactRow.build_key == key))
    return {row.kind: row.sha256 for row in rows}


def builds(session: Session, keys: Collection[str]) -> dict[str, BuildRow]:
    """Those of several builds that were made, by key."""
    return {row.key: row for row in session.scalars(select(BuildRow).where(BuildRow.key.in_(keys)))}


def artifacts_of(session: Session, keys: Collection[str]) -> dict[str, dict[str, str]]:
    """The SHA-256 of every artifact of several builds, by key and kind."""
    artifacts: dict[str, dict[str, str]] = {}
    for row in session.scalars(select(ArtifactRow).where(ArtifactRow.build_key.in_(keys))):
        artifacts.setdefault(row.build_key, {})[row.kind] = row.sha256
    return artifacts


def add_build(
    session: Session,
    key: str,
    model: str,
    version: int,
    parameters: JsonObject,
    measured: JsonObject,
    maker: str,
) -> None:
    """Record a build; the same build made twice is one."""
    row = {
        "key": key,
        "model": model,
        "version": version,
        "parameters": parameters,
        "measurements": measured,
        "created": now(),
        "operated": operated(session),
        "made_by": maker,
    }
    upsert_values(session, BuildRow.__table__, row)


def add_artifact(session: Session, key: str, kind: str, sha256: str, size: int) -> None:
    """Record an artifact of a build."""
    if ACTING.get().id not in BUILT_IN and session.get(ArtifactRow, (key, kind)) is None:
        usage.note_bytes(session, size)
    row = {"build_key": key, "kind": kind, "sha256": sha256, "size": size, "created": now()}
    upsert_values(session, ArtifactRow.__table__, row)


def users_of(session: Session, key: str) -> list[dict[str, object]]:
    """The revisions that use a build, oldest first, and whether each is its design's newest.

    A revision stands there once for its own models, and once for each of its variants.
    """
    query = (
        select(RevisionModelRow.design_id, RevisionModelRow.number, RevisionModelRow.name, DesignRow.head)
        .join(DesignRow, DesignRow.id == RevisionModelRow.design_id)
        .where(RevisionModelRow.build_key == key)
        .order_by(RevisionModelRow.design_id, RevisionModelRow.number, RevisionModelRow.name)
    )
    return [_use(*row) for row in session.execute(query).all()]


def is_signed(session: Session, key: str) -> bool:
    """Return whether a revision that was handed over for checking, or signed further, uses a build."""
    signed = (
        select(ApprovalRow.step)
        .join(
            RevisionModelRow,
            (RevisionModelRow.design_id == ApprovalRow.design_id)
            & (RevisionModelRow.number == ApprovalRow.revision),
        )
        .where(RevisionModelRow.build_key == key)
    )
    return session.scalar(signed.limit(1)) is not None


def _use(design: str, number: int, model: str, head: int) -> dict[str, object]:
    """A use of a build; a dot in the name of the model stands behind that of a variant."""
    variant = variant_of(model)
    more = {} if variant is None else {"variant": variant}
    return {"design": design, "revision": number, "current": number == head, **more}
