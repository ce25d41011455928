"""The listing of the audit: newest first, all of it or only what matches a filter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import ColumnElement, or_, select
from sqlalchemy.orm import Session

from app.storage.tables import AuditRow


@dataclass(frozen=True)
class AuditFilter:
    """Filter of a list of rows; a field that is None lets every row pass."""

    object: str | None = None  # its path, or that of what it belongs to: designs/<id>
    principal: str | None = None  # id or name
    action: str | None = None  # design.create, or all of a kind: design


def page(session: Session, limit: int, before: str | None, wanted: AuditFilter) -> list[AuditRow]:
    """Return one page of rows, newest first, plus one row if there are more."""
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
