"""SQLAlchemy engines for SQLite and PostgreSQL: for reading, writing and migrating."""

import sqlite3
from pathlib import Path

from sqlalchemy import Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import OperationalError

from app.storage.errors import NotForTeams
from app.storage.units import translated

_SHARED = ("busy_timeout = 10000", "foreign_keys = on")
_WRITER = (*_SHARED, "journal_mode = wal", "synchronous = full")
_READER = (*_SHARED, "query_only = on")
_CONNECTING = {"connect_timeout": 5, "keepalives_idle": 10, "keepalives_interval": 5, "keepalives_count": 3}
"""Time limits for a connection to PostgreSQL, and for the checks that the server still answers [s]."""
_PATIENCE = 10.0  # longest wait for a free connection to PostgreSQL [s]
# Batch migrations drop and rename tables; enforced foreign keys would treat that as deletions.
_MIGRATOR = ("busy_timeout = 10000", "journal_mode = wal")


def writing_engine(url: str, pool: int = 1) -> Engine:
    """Return the engine of the writer.

    On SQLite, transactions take the write lock first and are synced at commit. On PostgreSQL the engine has
    `pool` connections, in whose transactions every statement sees what others have committed before it.
    """
    if is_sqlite(url):
        return _sqlite_engine(url, _WRITER, "BEGIN IMMEDIATE")
    return _postgres_engine(url, pool, isolation_level="READ COMMITTED")


def migrating_engine(url: str) -> Engine:
    """Return the engine with which the schema may be changed."""
    if is_sqlite(url):
        return _sqlite_engine(url, _MIGRATOR, "BEGIN IMMEDIATE")
    return _postgres_engine(url, 1, isolation_level="READ COMMITTED")


def reading_engine(url: str, pool: int = 1) -> Engine:
    """Return an engine of read-only snapshots, with `pool` connections on PostgreSQL."""
    if is_sqlite(url):
        return _sqlite_engine(url, _READER, "BEGIN")
    engine = _postgres_engine(url, pool, isolation_level="REPEATABLE READ", pool_pre_ping=True)
    return engine.execution_options(postgresql_readonly=True)


def sqlite_file(url: str) -> Path | None:
    """Return the file of a SQLite database; None for any other database."""
    chosen = make_url(url)
    return Path(chosen.database) if is_sqlite(url) and chosen.database else None


def is_sqlite(url: str) -> bool:
    """Return whether a database is a file of SQLite."""
    return make_url(url).get_backend_name() == "sqlite"


def _postgres_engine(url: str, pool: int, **options: str | bool) -> Engine:
    """Return an engine of PostgreSQL that soon reports a server that cannot be reached.

    Raises
    ------
    NotForTeams
        If the driver is not installed.
    """
    chosen = make_url(url)
    if chosen.drivername in ("postgresql", "postgres"):
        chosen = chosen.set(drivername="postgresql+psycopg")
    given = {name: value for name, value in _CONNECTING.items() if name not in chosen.query}
    try:
        return create_engine(
            chosen, pool_size=pool, max_overflow=0, pool_timeout=_PATIENCE, connect_args=given, **options
        )
    except ModuleNotFoundError as error:
        if error.name != "psycopg":
            raise
        raise NotForTeams(
            "The driver of PostgreSQL is not installed: pip install 'crankwright[team]'"
        ) from None


def _sqlite_engine(url: str, pragmas: tuple[str, ...], begin: str) -> Engine:
    engine = create_engine(url)

    @event.listens_for(engine, "connect")
    def configure(connection: sqlite3.Connection, record: object) -> None:
        connection.isolation_level = None  # the driver must not begin transactions by itself
        for pragma in pragmas:
            connection.execute(f"PRAGMA {pragma}")
        connection.create_function("lower", 1, _lower, deterministic=True)

    @event.listens_for(engine, "begin")
    def start(connection: Connection) -> None:
        driver = connection.connection.driver_connection
        assert driver is not None
        try:
            driver.execute(begin)
        except sqlite3.Error as error:
            raise translated(begin, (), error) from error

    event.listen(engine, "savepoint", _expect_transaction)
    event.listen(engine, "commit", _expect_transaction)
    return engine


def _lower(value: str | float | None) -> str | float | None:
    """Return a text in lower case for SQLite, whose own function only converts A to Z.

    With that function, `Ä` would not match `ä`.
    """
    return value.lower() if isinstance(value, str) else value


def _expect_transaction(connection: Connection, name: str | None = None) -> None:
    """Refuse to continue in a transaction that SQLite has rolled back; see `rolled_back`."""
    driver = connection.connection.driver_connection
    if isinstance(driver, sqlite3.Connection) and not driver.in_transaction:
        raise rolled_back()


def rolled_back() -> OperationalError:
    """Return the error of a transaction that SQLite has rolled back by itself, as it does on a full disk.

    Later statements would be committed alone, and the driver would report the final commit as a success.
    """
    error = sqlite3.OperationalError("SQLite has rolled the transaction back")
    return OperationalError("COMMIT", None, error)
