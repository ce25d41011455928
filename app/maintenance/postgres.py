"""Maintain PostgreSQL: consistent dumps, restores into an empty database, reading rows."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import Connection, create_engine, inspect, make_url, text
from sqlalchemy.exc import OperationalError

from app.maintenance.errors import CannotRun
from app.maintenance.team_check import Rows
from app.storage.migrations import known_schemas
from app.storage.postgres_programs import postgres_program

SWEEP = "sweep of files"  # name of the lock for deleting files; see `app.retention.files`


class Snapshot(Rows):
    """The rows of a database at one moment; `name` is PostgreSQL's name of the snapshot."""

    def __init__(self, connection: Connection) -> None:
        super().__init__(connection)
        self.name = str(connection.scalar(text("SELECT pg_export_snapshot()")))


@contextmanager
def snapshot(url: str) -> Iterator[Snapshot]:
    """Open a snapshot of the database, during which no server deletes unused files.

    Raises
    ------
    CannotRun
        If the database does not answer, or has another schema than this program's.
    """
    engine = create_engine(url)
    try:
        with engine.connect() as guard, engine.connect() as connection:
            guard.execute(text("SELECT pg_advisory_xact_lock(hashtextextended(:work, 0))"), {"work": SWEEP})
            connection = connection.execution_options(isolation_level="REPEATABLE READ")
            _require_schema(connection)
            yield Snapshot(connection)
    except OperationalError as error:
        raise CannotRun(f"The database does not answer: {str(error.orig).strip()}.") from None
    finally:
        engine.dispose()


def schema_of(url: str) -> str:
    """Return the version of a database's schema; empty if it has no tables.

    Raises
    ------
    CannotRun
        If the database does not answer, or belongs to another program.
    """
    engine = create_engine(url)
    try:
        with engine.connect() as connection:
            tables = inspect(connection).get_table_names()
            if tables and "alembic_version" not in tables:
                raise CannotRun("The database holds tables of another program.")
            query = text("SELECT version_num FROM alembic_version")
            return str(connection.scalar(query)) if tables else ""
    except OperationalError as error:
        raise CannotRun(f"The database does not answer: {str(error.orig).strip()}.") from None
    finally:
        engine.dispose()


def dump(url: str, moment: Snapshot, target: Path) -> None:
    """Write the database as of a snapshot into a file by `pg_dump -Fc`; raises CannotRun."""
    options = ["-Fc", "--no-owner", f"--snapshot={moment.name}", "-f", str(target)]
    _run("pg_dump", url, [*options, "-d"])


def load(url: str, source: Path) -> None:
    """Restore a dump into an empty database by `pg_restore`, completely or not at all; raises CannotRun."""
    options = ["--no-owner", "--exit-on-error", "--single-transaction", str(source), "-d"]
    _run("pg_restore", url, options)


def _run(name: str, url: str, options: list[str]) -> None:
    program = postgres_program(name)
    if program is None:
        raise CannotRun(f"{name} is not installed: apt-get install postgresql-client")
    place = make_url(url).set(drivername="postgresql")
    password = str(place.password or "")  # passed in the environment, because others can read arguments
    command = [str(program), *options, place.set(password=None).render_as_string()]
    environment = {**os.environ, **({"PGPASSWORD": password} if password else {})}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CannotRun(f"{name} failed: {done.stderr.strip()[-1000:]}")


def _require_schema(connection: Connection) -> None:
    newest = known_schemas()[0]
    if not inspect(connection).has_table("alembic_version"):
        raise CannotRun("The database is empty, or it does not belong to Crankwright.")
    schema = connection.scalar(text("SELECT version_num FROM alembic_version"))
    if schema != newest:
        raise CannotRun(
            f"The database has schema {schema}, this program needs {newest}: use the version of the servers."
        )
