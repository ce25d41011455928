"""Record who did what, in the same transaction as the change itself, and list these records."""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import ColumnElement, insert, or_, select
from sqlalchemy.orm import Session

from app.identity.principal import BUILT_IN, acting
from app.identity.schemas.principals import Author
from app.storage.clock import now
from app.storage.tables import AuditRow, Base
from app.storage.units import Statement

_RECORDED = Statement(
    insert(Base.metadata.tables[AuditRow.__tablename__]),
    "id",
    "at",
    "principal",
    "name",
    "action",
    "object",
    "digest",
)


def record(
    session: Session, action: str, object: str, digest: str | None = None, at: str | None = None
) -> None:
    """Record an action of the acting principal on an object, in the same unit of work.

    The id of the row begins with the time of this machine's clock instead of a database counter, so that
    units of work that only record something do not wait for each other.

    Parameters
    ----------
    session
        The unit of work.
    action
        The object's kind and the verb, such as `design.create`.
    object
        The object's path in the interface, without `/api/v1/`, such as `designs/<id>/revisions/3`.
    digest
        SHA-256 of the written or signed content, if there is one.
    at
        The time stored with the change, as text; by default the present time.
    """
    who = acting()
    row = {
        "id": f"{time.time_ns():016x}{secrets.token_hex(4)}",
        "at": at or now(),
        "principal": who.id,
        "name": who.name,
        "action": action,
        "object": object,
        "digest": digest,
    }
    _RECORDED.run(session, row)


@dataclass(frozen=True)
class AuditFilter:
    """A filter of audit rows; a field that is None matches every row."""

    object: str | None = None  # the path of the object, or of the one it belongs to: designs/<id>
    principal: str | None = None  # id or name
    action: str | None = None  # design.create, or design for all actions on designs


def creator(session: Session, principal: str) -> Author | None:
    """Return the administrator who created a principal; None if the operator or a provider did."""
    created = AuditRow.action == "principal.add", AuditRow.object == f"principals/{principal}"
    query = select(AuditRow.principal, AuditRow.name).where(*created)
    for id, name in session.execute(query):
        if id not in BUILT_IN:
            return Author(id=id, name=name)
    return None


def page(session: Session, limit: int, before: str | None, wanted: AuditFilter) -> list[AuditRow]:
    """Return one page of rows, newest first, and one more row if another page follows."""
    query = select(AuditRow).where(*_conditions(wanted)).order_by(AuditRow.id.desc())
    if before:
        query = query.where(AuditRow.id < before)
    return list(session.scalars(query.limit(limit + 1)))


def _conditions(wanted: AuditFilter) -> Iterator[ColumnElement[bool]]:
    if wanted.object is not None:
        inside = AuditRow.object.startswith(f"{wanted.object}/", autoescape=True)
        yield or_(AuditRow.object == wanted.object, inside)
    if wanted.principal is not None:
        yield or_(AuditRow.principal == wanted.principal, AuditRow.name == wanted.principal)
    if wanted.action is not None:
        of_kind = AuditRow.action.startswith(f"{wanted.action}.", autoescape=True)
        yield or_(AuditRow.action == wanted.action, of_kind)
