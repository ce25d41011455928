"""The history of the schema. A change of the tables adds a file to `versions`; a test compares the two."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, func, select

from app.storage.engines import is_sqlite, migrating_engine
from app.storage.errors import DatabaseNewer

_LOCK = 0x4372616E6B  # of PostgreSQL: simultaneous starts would create the same tables


def migrate(url: str) -> None:
    """Bring the database to the schema of this program, in one transaction; one server at a time does it.

    Raises
    ------
    DatabaseNewer
        The database has been migrated by a newer program.
    """
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    engine = migrating_engine(url)
    try:
        with engine.begin() as connection:
            if not is_sqlite(url):
                connection.execute(select(func.pg_advisory_xact_lock(_LOCK)))
            _refuse_newer(connection)
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
    finally:
        engine.dispose()


def schema_of(connection: Connection) -> str | None:
    """The version of a database's schema; None of an empty database."""
    return MigrationContext.configure(connection).get_current_revision()


def known_schemas() -> list[str]:
    """The versions that this program can bring up to date, newest first; the first is its own."""
    scripts = ScriptDirectory(str(Path(__file__).parent)).walk_revisions()
    return [script.revision for script in scripts]


def _refuse_newer(connection: Connection) -> None:
    current = schema_of(connection)
    if current is not None and current not in known_schemas():
        raise DatabaseNewer(current)
