"""All SQL statements for worksheets; every function runs in its caller's transaction."""

from __future__ import annotations

from typing import NamedTuple

from sqlalchemy import and_, delete, func, select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from app.identity.usage import note_bytes
from app.storage.clock import new_id, now
from app.storage.errors import NotFound
from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets.errors import StaleWorksheet

RELEASED = ("released", "withdrawn")
"""States in which a version can no longer change, except by withdrawal."""


class State(NamedTuple):
    """The state of a version; `edit` changes with every change of the version."""

    id: str
    number: int
    state: str
    edit: str


def newest(session: Session, id: str) -> Row:
    """Return the newest version of a worksheet.

    Raises
    ------
    NotFound
        If there is no worksheet with this id.
    """
    rows = select(Row).where(Row.id == id).order_by(Row.number.desc()).limit(1)
    if (row := session.scalar(rows)) is None:
        raise NotFound(f"there is no worksheet {id[:64]!r}")
    return row


def version(session: Session, id: str, number: int) -> Row:
    """Return one version of a worksheet.

    Raises
    ------
    NotFound
        If there is no such worksheet or version.
    """
    if (row := session.get(Row, (id, number))) is None:
        raise NotFound(f"worksheet {id[:64]!r} has no version {number}")
    return row


def versions(session: Session, id: str) -> list[Row]:
    """Return all versions of a worksheet, in ascending order."""
    return list(session.scalars(select(Row).where(Row.id == id).order_by(Row.number)))


def page(session: Session, limit: int, after: str | None) -> list[Row]:
    """Return the newest versions in the order of their ids; one more than `limit` if there are more."""
    last = select(Row.id, func.max(Row.number).label("number")).group_by(Row.id).subquery()
    rows = select(Row).join(last, and_(Row.id == last.c.id, Row.number == last.c.number))
    if after is not None:
        rows = rows.where(Row.id > after)
    return list(session.scalars(rows.order_by(Row.id).limit(limit + 1)))


def states(session: Session) -> tuple[State, ...]:
    """Return the states of all versions."""
    rows = select(Row.id, Row.number, Row.state, Row.edit).order_by(Row.id, Row.number)
    return tuple(State(*row) for row in session.execute(rows))


def add(session: Session, row: Row) -> None:
    """Insert a new version.

    Raises
    ------
    StaleWorksheet
        If another server has inserted it in the meantime.
    """
    row.edit, row.created = new_id(session), now()
    row.updated = row.created
    session.add(row)
    try:
        session.flush()
    except IntegrityError:
        raise StaleWorksheet(row.id) from None
    note_bytes(session, _size(row.text))


def save(session: Session, row: Row, **changes: object) -> Row:
    """Change a version and return it; of several concurrent changes only one succeeds.

    Raises
    ------
    StaleWorksheet
        If the version has changed since it was read.
    """
    same = and_(Row.id == row.id, Row.number == row.number, Row.edit == row.edit)
    values = {**changes, "edit": new_id(session), "updated": now()}
    changed = update(Row).where(same).values(values).execution_options(synchronize_session=False)
    if not session.execute(changed.returning(Row.id)).all():
        raise StaleWorksheet(row.id)
    if isinstance(text := changes.get("text"), str):
        note_bytes(session, max(0, _size(text) - _size(row.text)))
    return version(session, row.id, row.number)


def _size(text: str) -> int:
    return len(text.encode())


def discard(session: Session, row: Row) -> None:
    """Delete a version that was never released.

    Raises
    ------
    StaleWorksheet
        If the version has changed since it was read.
    """
    same = and_(Row.id == row.id, Row.number == row.number, Row.edit == row.edit)
    gone = delete(Row).where(same).execution_options(synchronize_session=False)
    if not session.execute(gone.returning(Row.id)).all():
        raise StaleWorksheet(row.id)
