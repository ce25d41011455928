"""Rows that several servers may insert at the same time: the database decides, not a look beforehand."""

from __future__ import annotations

from functools import cache

from sqlalchemy import Insert, Table, inspect
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.storage.tables import Base


def insert_new(session: Session, row: Base) -> bool:
    """Insert a row unless there is one of its key; return whether it was inserted.

    While another transaction is inserting it, this one waits for its end.
    """
    values, dialect = inspect(row).dict, session.get_bind().dialect.name
    return session.execute(_insertion(row.__table__, dialect), values).first() is not None


def upsert(session: Session, row: Base) -> None:
    """Insert a row, or give the one of its key its values; columns that it does not set stay."""
    values, dialect = inspect(row).dict, session.get_bind().dialect.name
    session.execute(_replacement(row.__table__, tuple(values), dialect), values)


@cache
def _insertion(table: Table, dialect: str) -> Insert:
    key = list(table.primary_key)
    return _insert(table, dialect).on_conflict_do_nothing(index_elements=key).returning(*key)


@cache
def _replacement(table: Table, names: tuple[str, ...], dialect: str) -> Insert:
    key = list(table.primary_key)
    statement = _insert(table, dialect)
    columns = {column.name for column in table.columns if not column.primary_key}
    changed = {name: statement.excluded[name] for name in names if name in columns}
    return statement.on_conflict_do_update(index_elements=key, set_=changed)


def _insert(table: Table, dialect: str) -> postgresql.Insert | sqlite.Insert:
    """The insertion of the database's own kind: the standard knows no conflicts."""
    return sqlite.insert(table) if dialect == "sqlite" else postgresql.insert(table)
