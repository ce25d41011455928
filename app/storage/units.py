"""Units of work: functions that run in one transaction, and their statements, compiled once.

At every execution SQLAlchemy looks up the compiled statement, prepares each value and wraps each row, which
takes several times as long as SQLite itself. On SQLite a `Statement` passes its text and values directly to
the driver, in the transaction of the session; on PostgreSQL SQLAlchemy executes it.

An upsert writes a row that several servers may insert at the same time, without reading it first.
"""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Protocol, TypeVar

from sqlalchemy import ClauseElement, Engine, Executable, FromClause, Table, inspect
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.dialects.sqlite import dialect
from sqlalchemy.engine.interfaces import Dialect
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.schema import ScalarElementColumnDefault

from app.plain import Json
from app.storage.tables import Base

logger = logging.getLogger(__name__)

T = TypeVar("T")
Unit = Callable[[Session], T]

AFTER, REPEATABLE = "after commit", "repeatable"
"""Keys in a session's `info`: the functions that follow its unit, and whether the unit may run again."""


class Writer(Protocol):
    """The interface that runs units of work, each stored whole or not at all; see `Database.write`."""

    engine: Engine

    def write(self, unit: Unit[T]) -> T:
        """Run a unit and return its result once it is durable."""
        ...

    def submit(self, unit: Unit[T]) -> Future[T]:
        """Queue a unit; its future raises the same errors as `write`."""
        ...

    def close(self) -> None:
        """Accept no more units, and wait for those that were submitted."""
        ...


def after_commit(session: Session, function: Callable[[], object]) -> None:
    """Call a function once the unit of work of this session is durable; never if the unit is lost.

    The thread of the writer calls it before the caller of the unit continues. The function must not write.
    """
    session.info.setdefault(AFTER, []).append(function)


def repeatable(session: Session) -> None:
    """Declare that this unit of work may run again, even if it has been stored already.

    The writer may then repeat it if the connection is lost during its commit and its outcome is unknown.
    """
    session.info[REPEATABLE] = True


def follow(functions: list[Callable[[], object]]) -> None:
    """Call the functions registered to follow a unit; an error in one does not affect the others."""
    for function in functions:
        try:
            function()
        except Exception:
            logger.exception("A function that follows a unit of work has failed; the unit is stored")


DRIVER = "driver"
"""Key in a session's `info` for the connection of SQLite's driver, in a unit of work."""
READS = "reads by the driver"
"""Key in a session's `info` which states that a snapshot session has such a connection."""

Values = Mapping[str, object]
Row = Sequence[Json]  # the caller that selects columns knows their types
_Convert = Callable[[object], object]
_SQLITE: Dialect = dialect(paramstyle="qmark")


class Statement:
    """A statement of SQLAlchemy Core with named values, to be executed in many units of work.

    The statement does not see rows that the session has not written yet: flush the session first.

    Parameters
    ----------
    clause
        The statement; defaults of columns that it inserts must be constants.
    names
        The values that are given at every execution.
    """

    def __init__(self, clause: Executable, *names: str) -> None:
        self.clause, self.names = clause, names

    def run(self, session: Session, values: Values | None = None) -> Sequence[Row]:
        """Execute the statement and return all rows, if it returns any."""
        driver: sqlite3.Connection | None = session.info.get(DRIVER)
        if driver is None and READS in session.info:
            driver = session.connection().connection.driver_connection
        if driver is None:
            result = session.connection().execute(self.clause, values)
            return result.all() if result.returns_rows else ()
        compiled = self._compiled
        row = compiled.parameters(values or {})
        try:
            rows = driver.execute(compiled.text, row).fetchall()
        except sqlite3.Error as error:
            raise translated(compiled.text, row, error) from error
        if compiled.reading:
            rows = list(map(list, rows))
            for row in rows:
                for n, convert in compiled.reading.items():
                    row[n] = convert(row[n])
        return rows

    def scalar(self, session: Session, values: Values | None = None) -> int | None:
        """Return the number in the first column of the first row; None if there is no row."""
        for row in self.run(session, values):
            number: int | None = row[0]
            return number
        return None

    def run_many(self, session: Session, many: Sequence[Values]) -> None:
        """Execute the statement once for each of several sets of values; return no rows."""
        driver: sqlite3.Connection | None = session.info.get(DRIVER)
        if driver is None:
            session.connection().execute(self.clause, many)
            return
        compiled = self._compiled
        rows = [compiled.parameters(values) for values in many]
        try:
            driver.executemany(compiled.text, rows)
        except sqlite3.Error as error:
            raise translated(compiled.text, rows, error) from error

    @cached_property
    def _compiled(self) -> _DriverStatement:
        assert isinstance(self.clause, ClauseElement)
        compiled = self.clause.compile(dialect=_SQLITE, column_keys=list(self.names))
        assert isinstance(compiled, SQLCompiler)
        assert compiled.positiontup is not None
        late = compiled.literal_execute_params or compiled.post_compile_params or compiled.update_prefetch
        assert not late, "it needs SQLAlchemy at every execution"
        constants = compiled.construct_params(dict.fromkeys(self.names), _check=False)
        for column in compiled.insert_prefetch:
            assert isinstance(column.default, ScalarElementColumnDefault), "its value is computed"
            constants[column.key] = column.default.arg
        places = compiled.positiontup
        assert set(self.names) <= set(places), "each name is that of a value"
        types = [column.type for column in getattr(self.clause, "exported_columns", ())]
        return _DriverStatement(
            str(compiled),
            places,
            {name: constants[name] for name in places if name not in self.names},
            {n: one for n, name in enumerate(places) if callable(one := compiled._bind_processors.get(name))},
            {n: one for n, kind in enumerate(types) if (one := kind.result_processor(_SQLITE, None))},
        )


@dataclass(frozen=True)
class _DriverStatement:
    """A statement in the form that SQLite's driver executes.

    `places` names the value of each parameter; `constants` are values that callers do not give. `writing`
    converts parameters by position, and `reading` converts columns of rows. None is NULL in all columns.
    """

    text: str
    places: list[str]
    constants: Values
    writing: dict[int, _Convert]
    reading: dict[int, _Convert]

    def parameters(self, values: Values) -> list[object]:
        """Return the parameters of one execution."""
        row = list(map({**self.constants, **values}.__getitem__, self.places))
        for n, convert in self.writing.items():
            if row[n] is not None:
                row[n] = convert(row[n])
        return row


def translated(text: str, parameters: object, error: sqlite3.Error) -> BaseException:
    """Return a driver's error in the form that SQLAlchemy raises."""
    return DBAPIError.instance(text, parameters, error, sqlite3.Error, dialect=_SQLITE)  # type: ignore[call-overload,no-any-return]


def insert_new(session: Session, row: Base) -> bool:
    """Insert a row unless its key exists; return whether it was inserted.

    If another transaction is inserting the same key, the call waits for the end of that transaction.
    """
    values = inspect(row).dict
    statement = _insertion(row.__table__, tuple(values), _dialect(session))
    return session.execute(statement.clause, values).first() is not None


def insert_new_values(session: Session, table: FromClause, values: Values) -> bool:
    """Insert a row, given by values of its columns, unless its key exists; return whether it did so."""
    return bool(_insertion(table, tuple(values), _dialect(session)).run(session, values))


def upsert(session: Session, row: Base) -> None:
    """Insert a row, or update the row with its key; columns that it does not set are not changed."""
    values = inspect(row).dict
    session.execute(_replacement(row.__table__, tuple(values), _dialect(session)).clause, values)


def upsert_values(session: Session, table: FromClause, values: Values) -> None:
    """Insert a row, given by the values of its columns, or update these columns of the row with its key."""
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
    """Return the dialect's own insert statement, because standard SQL has no conflict clause."""
    assert isinstance(table, Table)
    return sqlite.insert(table) if dialect == "sqlite" else postgresql.insert(table)
