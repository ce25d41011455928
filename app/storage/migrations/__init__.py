"""The history of the schema. Every change of the tables adds a file to `versions`; a test compares both."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, func, select

from app.storage.engines import is_sqlite, migrating_engine
from app.storage.errors import DatabaseBeforeRelease, DatabaseNewer

BEFORE_RELEASE = frozenset(f"{number:04}" for number in range(1, 10))
"""Schemas of programs before the first release, which were never distributed."""
_LOCK = (
    0x4372616E6B  # number of a lock in PostgreSQL, because simultaneous starts would create the same tables
)


def migrate(url: str) -> None:
    """Bring the database to the schema of this program, in one transaction; one server at a time does it.

    Raises
    ------
    DatabaseBeforeRelease, DatabaseNewer
        If a program before the first release, or a newer one, wrote the database.
    """
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    engine = migrating_engine(url)
    try:
        with engine.begin() as connection:
            if not is_sqlite(url):
                connection.execute(select(func.pg_advisory_xact_lock(_LOCK)))
            if (current := schema_of(connection)) is not None:
                refuse_unknown(current)
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
    finally:
        engine.dispose()


def schema_of(connection: Connection) -> str | None:
    """Return the version of a database's schema; None for an empty database."""
    return MigrationContext.configure(connection).get_current_revision()


def known_schemas() -> list[str]:
    """Return the versions that this program can bring up to date, newest first, beginning with its own."""
    scripts = ScriptDirectory(str(Path(__file__).parent)).walk_revisions()
    return [script.revision for script in scripts]


def refuse_unknown(schema: str) -> None:
    """Check that this program can bring a schema up to date.

    Raises
    ------
    DatabaseBeforeRelease
        If the schema is older than the first release, from which no migration exists.
    DatabaseNewer
        If the schema is newer than this program.
    """
    if schema in BEFORE_RELEASE:
        raise DatabaseBeforeRelease(schema)
    if schema not in known_schemas():
        raise DatabaseNewer(schema)
