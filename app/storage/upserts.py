"""Upserts: rows that several servers may insert at the same time, without reading first."""

from __future__ import annotations

from functools import cache

from sqlalchemy import FromClause, Table, inspect
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.storage.statements import DRIVER, Statement, Values
from app.storage.tables import Base


def insert_new(session: Session, row: Base) -> bool:
    """Insert a row unless there is one of its key; return whether it was inserted.

    While another transaction is inserting it, this one waits for its end.
    """
    values = inspect(row).dict
    statement = _insertion(row.__table__, tuple(values), _dialect(session))
    return session.execute(statement.clause, values).first() is not None


def insert_new_values(session: Session, table: FromClause, values: Values) -> bool:
    """Insert a row given as the values of its columns unless its key exists; return whether it did."""
    return bool(_insertion(table, tuple(values), _dialect(session)).run(session, values))


def upsert(session: Session, row: Base) -> None:
    """Insert a row, or give the one of its key its values; columns that it does not set stay."""
    values = inspect(row).dict
    session.execute(_replacement(row.__table__, tuple(values), _dialect(session)).clause, values)


def upsert_values(session: Session, table: FromClause, values: Values) -> None:
    """Insert a row given as the values of its columns, or set these columns of the row of its key."""
    dialect = "sqlite" if DRIVER in session.info else _dialect(session)
    _replacement(table, tuple(values), dialect).run(session, values)


def _dialect(session: Session) -> str:
    return "sqlite" if DRIVER in session.info else session.get_bind().dialect.name


@cache
def _insertion(table: FromClause, names: tuple[str, ...], dialect: str) -> Statement:
    key = list(table.primary_key)
    statement = _insert(table, dialect).on_conflict_do_nothing(index_elements=key).returning(*key)
    return Statement(statement, *names)


@cache
def _replacement(table: FromClause, names: tuple[str, ...], dialect: str) -> Statement:
    key = list(table.primary_key)
    statement = _insert(table, dialect)
    columns = {column.name for column in table.columns if not column.primary_key}
    changed = {name: statement.excluded[name] for name in names if name in columns}
    return Statement(statement.on_conflict_do_update(index_elements=key, set_=changed), *names)


def _insert(table: FromClause, dialect: str) -> postgresql.Insert | sqlite.Insert:
    """Return the insertion of the database's own kind: the standard knows no conflicts."""
    assert isinstance(table, Table)
    return sqlite.insert(table) if dialect == "sqlite" else postgresql.insert(table)
