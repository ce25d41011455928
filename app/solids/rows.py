"""All SQL for builds and their artifacts, and the ages of unused builds.

A build that no revision uses is deleted after some time, see `app.retention`. A caller that needs a build
renews its age in the same unit of work, or learns there that the build was deleted.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import NamedTuple

from sqlalchemy import bindparam, select, update
from sqlalchemy.orm import Session

from app.identity import usage
from app.identity.principal import ACTING, BUILT_IN
from app.plain import JsonObject
from app.storage.clock import now, operated
from app.storage.database import Database
from app.storage.tables import (
    ApprovalRow,
    ArtifactRow,
    Base,
    BuildRow,
    DesignRow,
    RevisionModelRow,
    variant_of,
)
from app.storage.units import Row, Statement, upsert_values
from cad.model import CadModel
from cad.regenerate import build_key

_BUILDS = Base.metadata.tables[BuildRow.__tablename__]
_ARTIFACTS = Base.metadata.tables[ArtifactRow.__tablename__]


class Build(NamedTuple):
    """A recorded build."""

    key: str
    model: str
    version: int
    parameters: JsonObject
    measurements: JsonObject
    made_by: str


class Artifact(NamedTuple):
    """A file of a build."""

    build_key: str
    kind: str
    sha256: str


_BUILD = Statement(
    select(*(_BUILDS.c[name] for name in Build._fields)).where(_BUILDS.c.key == bindparam("of")), "of"
)
_MEASURED = Statement(select(_BUILDS.c.measurements).where(_BUILDS.c.key == bindparam("of")), "of")
_ARTIFACT = Statement(
    select(*(_ARTIFACTS.c[name] for name in Artifact._fields)).where(
        _ARTIFACTS.c.build_key == bindparam("of"), _ARTIFACTS.c.kind == bindparam("like")
    ),
    "of",
    "like",
)


def build(session: Session, key: str) -> Build | None:
    """Return a build by its key, if it exists."""
    for row in _BUILD.run(session, {"of": key}):
        return Build(*row)
    return None


def measures(session: Session, key: str) -> Mapping[str, float] | None:
    """Return the measurements of a build, if it exists."""
    for (measured,) in _MEASURED.run(session, {"of": key}):
        return dict(measured["measures"])
    return None


def built(database: Database) -> Callable[[CadModel], Mapping[str, float] | None]:
    """Return a function that looks up the measurements of built models.

    It reads them only when a step needs them, because a step may take minutes, and holds no connection
    meanwhile.
    """

    def measured(shape: CadModel) -> Mapping[str, float] | None:
        with database.read() as session:
            return measures(session, build_key(shape))

    return measured


def artifact(session: Session, key: str, kind: str) -> Artifact | None:
    """Return one artifact of a build, if it exists."""
    for row in _ARTIFACT.run(session, {"of": key, "like": kind}):
        return Artifact(*row)
    return None


def artifact_named(session: Session, sha256: str) -> ArtifactRow | None:
    """Return an artifact by the hash of its bytes; several builds may have files with equal bytes."""
    return session.scalar(select(ArtifactRow).where(ArtifactRow.sha256 == sha256).limit(1))


def artifacts(session: Session, key: str | None) -> dict[str, str]:
    """Return the SHA-256 of every artifact of a build, by kind."""
    rows = session.scalars(select(ArtifactRow).where(ArtifactRow.build_key == key))
    return {row.kind: row.sha256 for row in rows}


def builds(session: Session, keys: Collection[str]) -> dict[str, BuildRow]:
    """Return those of several builds that exist, by key."""
    return {row.key: row for row in session.scalars(select(BuildRow).where(BuildRow.key.in_(keys)))}


def artifacts_of(session: Session, keys: Collection[str]) -> dict[str, dict[str, str]]:
    """Return the SHA-256 of every artifact of several builds, by key and kind."""
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
    """Record a build; a build that was made twice is stored once."""
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
    upsert_values(session, _BUILDS, row)


def add_artifact(session: Session, key: str, kind: str, sha256: str, size: int) -> None:
    """Record an artifact of a build."""
    if ACTING.get().id not in BUILT_IN and session.get(ArtifactRow, (key, kind)) is None:
        usage.note_bytes(session, size)
    row = {"build_key": key, "kind": kind, "sha256": sha256, "size": size, "created": now()}
    upsert_values(session, _ARTIFACTS, row)


def users_of(session: Session, key: str) -> list[dict[str, object]]:
    """Return the revisions that use a build, oldest first, and whether each is its design's newest.

    A revision is listed once for its own models, and once for each of its variants.
    """
    query = (
        select(RevisionModelRow.design_id, RevisionModelRow.number, RevisionModelRow.name, DesignRow.head)
        .join(DesignRow, DesignRow.id == RevisionModelRow.design_id)
        .where(RevisionModelRow.build_key == key)
        .order_by(RevisionModelRow.design_id, RevisionModelRow.number, RevisionModelRow.name)
    )
    return [_use(*row) for row in session.execute(query).all()]


def is_signed(session: Session, key: str) -> bool:
    """Return whether a signed revision uses a build; hand-over for checking counts as signed."""
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
    """Return a use of a build; the stored name of a variant's model is the variant, a dot, and the model."""
    variant = variant_of(model)
    more = {} if variant is None else {"variant": variant}
    return {"design": design, "revision": number, "current": number == head, **more}


FRESH = (
    3600  # a build wanted this recently need not be renewed: it is kept for a day or longer [s of operation]
)


def is_fresh(session: Session, keys: Collection[str]) -> bool:
    """Return whether all of these builds exist, and will remain longer than any request or job takes."""
    wanted, present = set(keys), operated(session)
    seen = _seen(session, wanted)
    return len(seen) == len(wanted) and min(map(itemgetter(1), seen), default=present) >= present - FRESH


def renew(session: Session, keys: Collection[str]) -> bool:
    """Renew the age of builds in a unit of work; return whether all of them exist.

    The row of a build that was renewed within the last hour is not touched, so units that share a build do
    not wait for each other's row lock.
    """
    if not keys:
        return True
    wanted, present = set(keys), operated(session)
    seen = _seen(session, wanted)
    old = {key for key, age in seen if age < present - FRESH}
    if not old:
        return len(seen) == len(wanted)
    renewal = update(BuildRow).where(BuildRow.key.in_(old)).values(operated=present)
    renewed = session.scalars(renewal.returning(BuildRow.key)).all()  # those not deleted in the meantime
    return len(seen) - len(old) + len(renewed) == len(wanted)


def _seen(session: Session, keys: Collection[str]) -> Sequence[Row]:
    """Return the key and age of those of these builds that exist."""
    ages = _ages(len(keys))
    return ages.run(session, dict(zip(ages.names, keys, strict=True)))


@lru_cache(16)
def _ages(count: int) -> Statement:
    names = [f"key{n}" for n in range(count)]
    seen = select(_BUILDS.c.key, _BUILDS.c.operated).where(_BUILDS.c.key.in_(list(map(bindparam, names))))
    return Statement(seen, *names)
