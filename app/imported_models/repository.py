"""All SQL for imported models; every function runs in its caller's transaction."""

from __future__ import annotations

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.identity.principal import BUILT_IN, acting
from app.storage.clock import now
from app.storage.errors import NotFound
from app.storage.tables import ImportedModelRow as Row
from app.storage.units import insert_new
from cad.imported_models import Description


def all_rows(session: Session) -> list[Row]:
    """Return every version of every imported model."""
    return list(session.scalars(select(Row).order_by(Row.id, Row.number)))


def count(session: Session) -> int:
    """Return the number of versions, which only grows: rows never change and are never deleted."""
    return session.scalar(select(func.count()).select_from(Row)) or 0


def version(session: Session, id: str, number: int) -> Row:
    """Return one version of an imported model.

    Raises
    ------
    NotFound
        If there is none.
    """
    if (row := session.get(Row, (id, number))) is None:
        raise NotFound(f"model {id[:64]!r} version {number} was not imported from a file")
    return row


def numbers(session: Session, id: str) -> list[int]:
    """Return the version numbers of an imported model, ascending."""
    return list(session.scalars(select(Row.number).where(Row.id == id).order_by(Row.number)))


def add(session: Session, id: str, described: Description, sent: str) -> int:
    """Add the next version of a model, unless an identical one exists, and return its number."""
    rows = list(session.scalars(select(Row).where(Row.id == id).order_by(Row.number)))
    for row in rows:
        if row.description == described.text:
            return row.number
    number = (rows[-1].number if rows else 0) + 1
    while not insert_new(session, _row(id, number, described, sent)):
        number += 1  # another server was faster
    return number


def _row(id: str, number: int, described: Description, sent: str) -> Row:
    who = acting()
    author, principal = (None, None) if who.id in BUILT_IN else (who.name, who.id)
    return Row(
        id=id,
        number=number,
        program=described.program,
        description=described.text,
        file_sha256=described.file,
        sent_sha256=sent,
        author=author,
        author_principal=principal,
        created=now(),
    )
