"""Open the database of the settings: check it, and migrate it to the schema of this program."""

from __future__ import annotations

from collections.abc import Callable

from sqlalchemy import make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, NoSuchModuleError

from app.settings import Settings
from app.storage.database import Database
from app.storage.engines import is_sqlite, writing_engine
from app.storage.errors import DatabaseUnavailable, NotForTeams
from app.storage.folder import DataFolder
from app.storage.integrity import refuse_damage
from app.storage.migrations import migrate
from app.storage.record import RecordKeeper, identity, require_kept, require_same

FORMS = "postgresql+psycopg://user:password@host:5432/database"
BACKENDS = ("sqlite", "postgresql", "postgres")


def opened_database(
    settings: Settings, folder: DataFolder, on_commit: Callable[[int, float, bool], object]
) -> Database:
    """Return the migrated database; a damaged database is refused before anything is written to it.

    Raises
    ------
    NotForTeams
        If the settings do not fit together; the text names the remedy.
    DatabaseLost, DatabaseDamaged, DatabaseBeforeRelease, DatabaseNewer, DatabaseUnavailable
        If the database cannot be used.
    """
    require_answer(settings)
    url = require_sound(settings, folder)
    migrate(url)
    database = Database(url, on_commit, settings.database_pool)
    if settings.database_url is None:
        database.record = RecordKeeper(folder.database, database.write(identity))
    return database


def require_sound(settings: Settings, folder: DataFolder) -> str:
    """Check that the database is intact and, in a data folder, the one it had; return its URL.

    Raises
    ------
    DatabaseLost, DatabaseDamaged
        If it is not; the text names the remedy.
    """
    if settings.database_url is not None:
        refuse_damage(settings.database_url)
        return settings.database_url
    require_kept(folder.database)
    refuse_damage(folder.database_url)
    require_same(folder.database)
    return folder.database_url


def require_answer(settings: Settings) -> None:
    """Check that the settings fit together and that a shared database accepts connections.

    Raises
    ------
    NotForTeams
        If the settings do not fit together.
    DatabaseUnavailable
        If the database server does not answer, or refuses this user.
    """
    url = settings.database_url
    if url is None:
        return
    require_database(url)
    if not is_sqlite(url) and settings.artifacts_url is None:
        raise NotForTeams(
            "Several servers share a PostgreSQL database, so they must share their files as well: set "
            "CRANKWRIGHT_ARTIFACTS_URL to s3://bucket, or to file:///folder if all of them see that folder."
        )
    require_connection(url)


def require_connection(url: str) -> None:
    """Check that a URL names a file, or a database that accepts connections.

    Raises
    ------
    NotForTeams
        If it names an unknown kind of database.
    DatabaseUnavailable
        If the database server does not answer, or refuses this user.
    """
    require_database(url)
    if is_sqlite(url):
        return
    engine = writing_engine(url)
    try:
        with engine.connect():
            pass
    except DBAPIError as error:
        reason = str(error.orig).strip().partition("\n")[0]
        raise DatabaseUnavailable(
            f"CRANKWRIGHT_DATABASE_URL does not point to a database ({reason})"
        ) from error
    finally:
        engine.dispose()


def require_database(url: str) -> None:
    """Check that a URL names a supported kind of database; raise NotForTeams if not."""
    try:
        backend = make_url(url).drivername.partition("+")[0]
    except (
        ArgumentError,
        NoSuchModuleError,
        ValueError,
    ):  # the message does not quote the URL, which may contain a password
        backend = ""
    if backend not in BACKENDS:
        raise NotForTeams(f"CRANKWRIGHT_DATABASE_URL names an unsupported kind of database; write {FORMS}.")
