"""All SQL statements for designs and revisions."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from sqlalchemy import bindparam, select, tuple_
from sqlalchemy.orm import Session, defer
from sqlalchemy.orm.util import identity_key

from app.designs import statements
from app.designs.errors import DesignSigned, StaleRevision
from app.designs.filters import DesignFilter, conditions
from app.designs.releases import EVER_SIGNED
from app.designs.results import ModelState
from app.identity.audit import record
from app.identity.principal import acting
from app.jobs.events import Event, Events, are_events_kept
from app.plain import JsonObject
from app.storage.clock import new_id, now
from app.storage.errors import NotFound
from app.storage.tables import DesignRow, RevisionModelRow, RevisionRow, canonical_json
from app.storage.units import Row, Values, upsert_values

_LEAN = defer(RevisionRow.results)
_LEAN_REVISION = (
    select(RevisionRow)
    .where(RevisionRow.design_id == bindparam("of"), RevisionRow.number == bindparam("at"))
    .options(_LEAN)
)


@dataclass(frozen=True)
class StoredRevision:
    """The content of a new revision."""

    document: JsonObject
    results: JsonObject | None
    models: Sequence[ModelState]
    state: str
    note: str | None
    action: str = "design.change"  # the name of the action in the audit log


def design(session: Session, id: str) -> DesignRow:
    """Return a design, unless it is deleted.

    Raises
    ------
    NotFound
        If there is no such design, or it is deleted.
    """
    row = session.get(DesignRow, id)
    if row is None or row.deleted:
        raise NotFound(f"there is no design {id[:80]!r}")
    return row


def locked(session: Session, id: str) -> DesignRow:
    """Return a design, read anew and locked until the end of the transaction, unless it is deleted.

    Raises
    ------
    NotFound
        If there is no such design, or it is deleted.
    """
    of_id = select(DesignRow).where(DesignRow.id == id, DesignRow.deleted.is_(None)).with_for_update()
    row = session.scalar(of_id.execution_options(populate_existing=True))
    if row is None:
        raise NotFound(f"there is no design {id[:80]!r}")
    return row


def heads(session: Session, rows: Sequence[DesignRow]) -> dict[str, RevisionRow]:
    """Return the newest revision of each design, without results, by the design's id."""
    places = [(row.id, row.head) for row in rows]
    query = select(RevisionRow).where(tuple_(RevisionRow.design_id, RevisionRow.number).in_(places))
    return {row.design_id: row for row in session.scalars(query.options(_LEAN))}


def revision(session: Session, id: str, number: int) -> RevisionRow:
    """Return a revision, including one of a deleted design.

    Raises
    ------
    NotFound
        If there is none.
    """
    row = session.get(RevisionRow, (id, number))
    if row is None:
        raise _no_revision(id, number)
    return row


def lean(session: Session, id: str, number: int) -> RevisionRow:
    """Return a revision whose results are loaded only when they are first read.

    Raises
    ------
    NotFound
        If there is no such revision.
    """
    row = session.scalar(_LEAN_REVISION, {"of": id, "at": number})
    if row is None:
        raise _no_revision(id, number)
    return row


def head(session: Session, id: str) -> RevisionRow:
    """Return the newest revision of a design."""
    return revision(session, id, design(session, id).head)


def lean_head(session: Session, id: str) -> RevisionRow:
    """Return the newest revision of a design; its results are loaded only when they are first read."""
    return lean(session, id, design(session, id).head)


class Newest(NamedTuple):
    """A revision without its results, and the time when its design was created."""

    number: int
    document: JsonObject
    created: str
    changed: str
    state: str
    problem: Mapping[str, object] | None


def newest(session: Session, id: str, number: int | None = None) -> Newest:
    """Return a revision of a design that is not deleted, by default the newest, without its results.

    Raises
    ------
    NotFound
        If there is no such design, or no such revision.
    """
    for row in statements.NEWEST.run(session, {"of": id, "at": number}):
        return Newest(*row)
    raise _no_revision(id, number or design(session, id).head)


def model_names(session: Session, id: str, number: int) -> list[str]:
    """Return the models of a revision, without those of its variants.

    Raises
    ------
    NotFound
        If there is no such revision.
    """
    names = [row[0] for row in statements.NAMES.run(session, {"of": id, "at": number})]
    if not names:
        lean(session, id, number)
    return names


def document(session: Session, id: str, number: int) -> JsonObject:
    """Return the document of a revision, without its results.

    Raises
    ------
    NotFound
        If there is none.
    """
    for stored, _ in statements.DOCUMENT.run(session, {"of": id, "at": number}):
        return dict(stored)
    raise _no_revision(id, number)


def _no_revision(id: str, number: int) -> NotFound:
    return NotFound(f"design {id[:80]!r} has no revision {number}")


def of_ids(session: Session, ids: Collection[str]) -> list[DesignRow]:
    """Return the designs with these ids, except deleted ones."""
    return list(session.scalars(select(DesignRow).where(DesignRow.id.in_(ids), DesignRow.deleted.is_(None))))


def newest_number(session: Session, id: str) -> int:
    """Return the number of a design's newest revision, even if the design is deleted."""
    row = session.get(DesignRow, id)
    assert row is not None, "a revision has its design"
    return row.head


def designs(
    session: Session, limit: int, cursor: str | None, wanted: DesignFilter | None = None
) -> list[DesignRow]:
    """Return one page of the designs that match a filter, newest first, plus one design if there are more.

    Deleted designs are left out, unless the filter asks for them alone.
    """
    is_deleted = (
        DesignRow.deleted.is_not(None) if wanted and wanted.is_deleted else DesignRow.deleted.is_(None)
    )
    query = select(DesignRow).where(is_deleted).order_by(DesignRow.id.desc())
    if wanted is not None:
        query = query.where(*conditions(session, wanted))
    if cursor:
        query = query.where(DesignRow.id < cursor)
    return list(session.scalars(query.limit(limit + 1)))


def revisions(session: Session, id: str, limit: int, before: int | None) -> list[RevisionRow]:
    """Return one page of a design's revisions, newest first, plus one revision if there are more."""
    query = select(RevisionRow).where(RevisionRow.design_id == id).order_by(RevisionRow.number.desc())
    query = query.options(_LEAN)
    if before is not None:
        query = query.where(RevisionRow.number < before)
    return list(session.scalars(query.limit(limit + 1)))


def create(session: Session, name: str, written: StoredRevision, at: str | None = None) -> tuple[str, int]:
    """Create a design with its first revision at time `at`, or now; return its id and revision number."""
    id, created = new_id(session), at or now()
    statements.NEW_DESIGN.run(session, {"id": id, "name": name, "created": created, "head": 0})
    return id, append(session, id, 0, written, created)


def append(session: Session, id: str, base: int, written: StoredRevision, at: str | None = None) -> int:
    """Append a revision after revision `base` at time `at`, or now; return its number.

    The row of the design is locked: if several servers append to the same revision, only one of them
    succeeds.

    Raises
    ------
    StaleRevision
        If there is already a newer revision.
    NotFound
        If there is no such design, or it is deleted.
    """
    session.flush()
    values = {"of": id, "base": base, "number": base + 1, "named": written.document["name"]}
    if statements.APPENDED.scalar(session, values) is None:
        raise StaleRevision(f'"{base}"', design(session, id).head)
    if session.identity_map and (row := session.identity_map.get(identity_key(DesignRow, id))) is not None:
        session.refresh(row)
    at = at or now()
    revision = {
        "design_id": id,
        "number": base + 1,
        "note": written.note,
        "created": at,
        "document": written.document,
        "results": written.results,
        "state": written.state,
        "problem": None,
        "author": acting().id,
        "design": id,
    }
    statements.NEW_REVISION.run(session, revision)
    digest = hashlib.sha256(canonical_json(written.document).encode()).hexdigest()
    record(session, written.action, f"designs/{id}/revisions/{base + 1}", digest, at)
    if written.models:
        models = map(partial(_model_row, id, base + 1), written.models)
        statements.NEW_MODEL.run_many(session, list(models))
    return base + 1


def _model_row(id: str, number: int, state: ModelState) -> Values:
    return {
        "design_id": id,
        "number": number,
        "name": state.name,
        "model": state.id,
        "model_version": state.version,
        "parameters": state.parameters,
        "relations": state.relations,
        "build_key": state.build,
    }


def attach(session: Session, id: str, number: int, results: JsonObject, models: Sequence[ModelState]) -> None:
    """Store the results of a regeneration in its revision, whose state becomes `current`."""
    statements.ATTACHED.run(session, {"of": id, "at": number, "computed": results})
    for state in models:
        upsert_values(session, statements.MODELS, _model_row(id, number, state))


def fail(session: Session, id: str, number: int, problem: JsonObject) -> None:
    """Record in a revision why its regeneration failed."""
    row = revision(session, id, number)
    row.state, row.problem = "failed", problem


def delete(session: Session, id: str) -> None:
    """Remove a design from the lists; everything of it is kept, so that it can be restored.

    Raises
    ------
    NotFound
        If there is no such design, or it is deleted.
    DesignSigned
        If one of its revisions has a signature.
    """
    row = locked(session, id)
    signed = EVER_SIGNED.scalar(session, {"design": id})
    if signed is not None:
        raise DesignSigned(id, signed)
    row.deleted = now()
    record(session, "design.delete", f"designs/{id}", at=row.deleted)


def restore(session: Session, id: str) -> None:
    """Return a deleted design to the lists; a design that is not deleted stays unchanged.

    Raises
    ------
    NotFound
        If there never was such a design.
    """
    row = session.get(DesignRow, id, with_for_update=True)
    if row is None:
        raise NotFound(f"there is no design {id[:80]!r}, deleted or not")
    if row.deleted is not None:
        row.deleted = None
        record(session, "design.restore", f"designs/{id}")


def newest_good(session: Session, id: str, model: str, until: int) -> RevisionModelRow | None:
    """Return the newest revision, up to a given one, for which the named model was built and accepted."""
    return _model(statements.GOOD.run(session, {"of": id, "model": model, "until": until}))


def built_model(session: Session, id: str, number: int, model: str) -> RevisionModelRow | None:
    """Return a model of a revision if it was built; otherwise None."""
    return _model(statements.BUILT.run(session, {"of": id, "model": model, "at": number}))


def _model(rows: Sequence[Row]) -> RevisionModelRow | None:
    names = statements.MODELS.c.keys()
    return next((RevisionModelRow(**dict(zip(names, row, strict=True))) for row in rows), None)


def changed_since_good(session: Session, id: str, number: int) -> list[str]:
    """Return the model parameters of a revision that differ from those of the last valid model."""
    changed: list[str] = []
    for model in revision(session, id, number).models:
        good = newest_good(session, id, model.name, number - 1)
        before = good.parameters if good else {}
        changed += (f"{model.name}.{n}" for n, v in model.parameters.items() if before.get(n) != v)
    return changed


@dataclass(frozen=True)
class RegenerationState:
    """The state of a design's regeneration, and the newest event that it reflects."""

    number: int
    revision: int
    state: str
    problem: object


def note_revision(session: Session, events: Events, design: str, revision: int, state: str) -> None:
    """Record an event for a new revision and its state, in the same transaction."""
    topic, data = f"design:{design}", {"revision": revision}
    events.note(session, Event(topic, "revision", data), Event(topic, state, data))


def standing(session: Session, id: str) -> RegenerationState:
    """Return the newest revision of a design, and the state of its regeneration.

    Raises
    ------
    NotFound
        If there is no such design.
    """
    newest = head(session, id)
    number = design(session, id).event
    return RegenerationState(number, newest.number, newest.state, newest.problem)


def can_resume(session: Session, id: str, last: int | None) -> bool:
    """Return whether all events of a design after the last one that a client received are still stored."""
    until = design(session, id).event
    return last is not None and are_events_kept(session, f"design:{id}", last, until)
