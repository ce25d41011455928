"""Check, only by reading, the data that servers share: rows of PostgreSQL, and the files that they name.

PostgreSQL verifies its own pages (`initdb --data-checksums`, `pg_amcheck`); this module checks the contents
of the rows.
"""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection
from sqlalchemy.exc import SQLAlchemyError

from app.maintenance.check import Faults, check_files
from app.maintenance.errors import CannotRun
from app.maintenance.files import Files
from app.maintenance.rows import LEADING_NOWHERE, named_files
from app.storage.engines import reading_engine
from app.storage.migrations import known_schemas


class Rows:
    """The rows of PostgreSQL, with the interface of those of SQLite."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def execute(self, query: str) -> Iterable[tuple[str, ...]]:
        """Return the rows of a query without parameters; most values are texts."""
        return (tuple(row) for row in self._connection.exec_driver_sql(query))


def check_shared(url: str, files: Files) -> Faults:
    """Find faulty references and files; the newest files of running servers may lack their rows.

    Raises
    ------
    CannotRun
        If the database does not answer, or has another schema.
    """
    findings = Faults(quarantined=files.quarantined())
    ages = files.ages()  # before the rows: a row added meanwhile already has its file
    engine = reading_engine(url)
    try:
        with engine.connect() as connection:
            _require_schema(connection)
            findings.references += _broken_references(connection)
            rows = list(named_files(Rows(connection)))
        check_files(files, rows, findings)
        with engine.connect() as connection:
            still = set(named_files(Rows(connection)))
    except SQLAlchemyError as error:
        why = f"PostgreSQL cannot be read ({type(error).__name__}): see CRANKWRIGHT_DATABASE_URL."
        raise CannotRun(why) from None
    finally:
        engine.dispose()
    findings.damaged = {row: text for row, text in findings.damaged.items() if row in still}
    findings.add_unnamed(files, ages, rows, in_use=True)
    return findings


def _require_schema(connection: Connection) -> None:
    rows = connection.exec_driver_sql("SELECT version_num FROM alembic_version").all()
    schema = str(rows[0][0]) if rows else "none"
    if schema != known_schemas()[0]:
        raise CannotRun(
            f"The database has schema {schema}, this program needs {known_schemas()[0]}: upgrade both."
        )


def _broken_references(connection: Connection) -> Iterable[str]:
    """Yield a sentence for each row with a broken reference; PostgreSQL checks foreign keys itself."""
    for sentence, query in LEADING_NOWHERE.items():
        for (name,) in connection.exec_driver_sql(query):
            yield sentence.format(name)
