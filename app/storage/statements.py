"""Statements of every save, compiled once.

SQLAlchemy looks up a compiled statement, converts each value and wraps each row again at every execution, which
takes ten times as long as SQLite itself. A `Statement` does this once. In a unit of work on SQLite it hands its
text and its values to the driver; everywhere else (PostgreSQL, reading sessions) SQLAlchemy executes it.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

from sqlalchemy import ClauseElement, Executable
from sqlalchemy.dialects.sqlite import dialect
from sqlalchemy.engine.interfaces import Dialect
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.schema import ScalarElementColumnDefault

DRIVER = "driver"
"""Under which the session of a unit of work keeps, in its `info`, the connection of SQLite's driver."""

Values = Mapping[str, object]
Row = Sequence[Any]  # as SQLAlchemy's: whoever selects columns knows their types
_Convert = Callable[[Any], object]
_SQLITE: Dialect = dialect(paramstyle="qmark")


class Statement:
    """A statement of SQLAlchemy's Core with named values, to be executed in many units of work.

    Rows that the session has not written yet do not exist for it: flush the session first.

    Parameters
    ----------
    clause
        The statement; defaults of columns that it inserts are constants.
    names
        The values that are given at every execution.
    """

    def __init__(self, clause: Executable, *names: str) -> None:
        self.clause, self.names = clause, names

    def run(self, session: Session, values: Values | None = None) -> Sequence[Row]:
        """Execute it and return all rows, if it returns any."""
        driver: sqlite3.Connection | None = session.info.get(DRIVER)
        if driver is None:
            result = session.connection().execute(self.clause, values)
            return result.all() if result.returns_rows else ()
        text, bound, converts = self._compiled
        row = [convert(given) for convert, given in _arguments(bound, values or {})]
        try:
            rows = driver.execute(text, row).fetchall()
        except sqlite3.Error as error:
            raise _translated(text, row, error) from error
        return [_converted(found, converts) for found in rows] if converts else rows

    def scalar(self, session: Session, values: Values | None = None) -> Any:
        """The first column of the first row; None if there is no row."""
        for row in self.run(session, values):
            return row[0]
        return None

    def run_many(self, session: Session, many: Sequence[Values]) -> None:
        """Execute it once for each of several sets of values; it returns no rows."""
        driver: sqlite3.Connection | None = session.info.get(DRIVER)
        if driver is None:
            session.connection().execute(self.clause, many)
            return
        text, bound, _ = self._compiled
        rows = [[convert(given) for convert, given in _arguments(bound, values)] for values in many]
        try:
            driver.executemany(text, rows)
        except sqlite3.Error as error:
            raise _translated(text, rows, error) from error

    @cached_property
    def _compiled(self) -> tuple[str, list[_Bound], dict[int, _Convert]]:
        """Its text for SQLite, where each of its parameters comes from, and how columns of rows are read."""
        assert isinstance(self.clause, ClauseElement)
        compiled = self.clause.compile(dialect=_SQLITE, column_keys=list(self.names))
        assert isinstance(compiled, SQLCompiler) and compiled.positiontup is not None
        late = compiled.literal_execute_params or compiled.post_compile_params
        assert not (late or compiled.update_prefetch), "it needs SQLAlchemy"
        constants = compiled.construct_params(dict.fromkeys(self.names), _check=False)
        for column in compiled.insert_prefetch:
            assert isinstance(column.default, ScalarElementColumnDefault), "its value is computed"
            constants[column.key] = column.default.arg
        assert set(self.names) <= set(compiled.positiontup), "each name is that of a value"
        bound = [
            _Bound(
                name if name in self.names else None,
                constants[name],
                compiled._bind_processors.get(name, _same),
            )
            for name in compiled.positiontup
        ]
        types = [column.type for column in getattr(self.clause, "exported_columns", ())]
        converts = {n: one for n, kind in enumerate(types) if (one := kind.result_processor(_SQLITE, None))}
        return str(compiled), bound, converts


class _Bound(NamedTuple):
    """A parameter: the name of its value, or a constant; and how it is converted."""

    name: str | None
    constant: object
    convert: _Convert


def _same(value: object) -> object:
    return value


def _arguments(bound: Iterable[_Bound], values: Values) -> Iterable[tuple[_Convert, object]]:
    for name, constant, convert in bound:
        yield convert, constant if name is None else values[name]


def _converted(row: Row, converts: Mapping[int, _Convert]) -> Row:
    return [converts[n](value) if n in converts else value for n, value in enumerate(row)]


def _translated(text: str, parameters: object, error: sqlite3.Error) -> BaseException:
    """The error as SQLAlchemy raises it."""
    return DBAPIError.instance(text, parameters, error, sqlite3.Error, dialect=_SQLITE)  # type: ignore[call-overload,no-any-return]
