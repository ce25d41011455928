"""`crankwright check | backup | restore | accept`."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

import click

from app.maintenance.backup import Contents, back_up
from app.maintenance.check import Faults, check
from app.maintenance.errors import CannotRun
from app.maintenance.files import IN_BUCKET, IN_SHARED_FOLDER, files_of
from app.maintenance.folder import database_file, is_in_use
from app.maintenance.restore import restore
from app.settings import Settings
from app.storage.connection import opened_database
from app.storage.engines import sqlite_file
from app.storage.errors import DatabaseLost, DataFolderInUse, StorageError
from app.storage.folder import DataFolder
from app.storage.integrity import refuse_damage
from app.storage.record import record_of, require_kept
from app.storage.stores import is_bucket

CLEAN, FAULTS, CANNOT_RUN = 0, 1, 2

_data = click.option(
    "--data", type=click.Path(path_type=Path), default=None, help="folder of designs and artifacts"
)


@click.command("check")
@click.option("--repair", "repairing", is_flag=True, help="rebuild lost files; stop the service first")
@_data
def check_command(repairing: bool, data: Path | None) -> None:
    """Check the database, every artifact and every reference.

    The exit code is 0 without faults, 1 with faults, and 2 if the check cannot run.
    """
    settings = _settings(data)
    with _refusing():
        if repairing:
            _repair(settings)
        findings = _check(settings, in_use=is_in_use(settings.data))
    sys.exit(FAULTS if findings.count else CLEAN)


@click.command("backup")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--no-files", is_flag=True, help="back up only the database, if the bucket keeps versions")
@_data
def backup_command(file: Path, no_files: bool, data: Path | None) -> None:
    """Back up the database and its artifacts into FILE (.tar or .tar.gz), whether or not the service runs."""
    settings = _settings(data)
    with _refusing():
        if url := _team_url(settings):
            from app.maintenance import team

            contents = team.back_up(settings, url, file, _say, with_files=not no_files)
        elif no_files:
            raise CannotRun(
                "--no-files is for a team's bucket: with SQLite, files are stored with the database."
            )
        elif is_bucket(settings):
            raise CannotRun(IN_BUCKET.format(url=settings.artifacts_url))
        elif settings.artifacts_url is not None:
            raise CannotRun(IN_SHARED_FOLDER.format(url=settings.artifacts_url))
        else:
            contents = back_up(settings.data, settings.database_url, file, _say)
    _summarise(file, contents)
    sys.exit(FAULTS if contents.damaged else CLEAN)


@click.command("restore")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--data", type=click.Path(path_type=Path), default=None, help="a new or empty folder")
def restore_command(file: Path, data: Path | None) -> None:
    """Restore the backup FILE into a new folder, which appears only after complete verification.

    A team's backup is restored into the empty database of CRANKWRIGHT_DATABASE_URL and into its file store.
    """
    settings = Settings()
    with _refusing():
        if url := _team_url(settings):
            from app.maintenance import team

            restored, place = team.restore(settings, url, file, _say), "the database"
        elif data is None:
            raise click.UsageError("name a new folder with --data")
        else:
            restored, place = restore(file, data, _say), str(data.absolute())
    _say(f"restored to {place}, the state of {restored.manifest['created']}")
    _say("stamp keys are not in a backup: copy their folder, or the service creates a new key when it starts")
    if missing := (restored.end or {})["missing"]:
        _say(f"{len(missing)} files were lost before the backup was made: run `crankwright check --repair`")


@click.command("accept")
@click.option(
    "--data",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=None,
    help="folder of designs and artifacts",
)
def accept_command(data: Path | None) -> None:
    """Accept the database in a data folder as it is; without one, the next start creates an empty one.

    Use this if the service refuses to start because its database is missing, is another one or an older copy.
    """
    settings = _settings(data)
    if settings.database_url is not None:
        _refuse("CRANKWRIGHT_DATABASE_URL is set, so the data folder has no database to accept.")
    try:
        folder = DataFolder(settings.data)
        try:
            _say(_accepted(settings, folder))
        finally:
            folder.release()
    except (StorageError, OSError) as error:
        _refuse(str(error))


def _accepted(settings: Settings, folder: DataFolder) -> str:
    """Make the record beside the database anew, and return a sentence about it."""
    if folder.database.exists():
        refuse_damage(folder.database_url)
    record_of(folder.database).unlink(missing_ok=True)
    if not folder.database.exists():
        return f"{folder.path} has no database: the next start creates a new, empty one."
    opened_database(settings, folder, lambda units, seconds, failed: None).close()
    return f"{folder.database} is accepted as it is."


def _repair(settings: Settings) -> None:
    """Check and repair under the lock of the data folder."""
    from app.maintenance.repair import repair  # imports the geometry kernel, which other commands do not need

    if settings.database_url and sqlite_file(settings.database_url) is None:
        raise CannotRun("The servers rebuild lost files themselves when a client requests them.")
    path = database_file(settings.data, settings.database_url)
    try:
        folder = DataFolder(settings.data)
    except DataFolderInUse as error:
        raise CannotRun(
            f"The service is running (process {error.owner}) and rebuilds lost files itself when a client "
            "requests them. Stop it before a repair; `crankwright check` alone may run meanwhile."
        ) from None
    try:
        if settings.database_url is None:
            require_kept(path)
        findings = _check(settings, in_use=False)
        if findings.database:
            raise CannotRun("A damaged database cannot be repaired: restore the last backup.")
        repair(folder, f"sqlite:///{path.absolute()}", findings, settings, _say)
    finally:
        folder.release()
    _say("after the repair:")


def _team_url(settings: Settings) -> str | None:
    """Return the URL of a database that servers share; None if it is SQLite."""
    url = settings.database_url
    return url if url and sqlite_file(url) is None else None


def _check(settings: Settings, *, in_use: bool) -> Faults:
    files = files_of(settings)
    if url := _team_url(settings):
        from app.maintenance.team_check import (
            check_shared,
        )  # imports PostgreSQL, which other commands do not need

        findings = check_shared(url, files)
    else:
        findings = check(settings.data, settings.database_url, in_use=in_use, files=files)
    for line in findings.lines():
        click.echo(line)
    return findings


def _summarise(file: Path, contents: Contents) -> None:
    for sha, text in contents.damaged.items():
        _say(f"artifact {sha} is not in the backup: {text}")
    if contents.deleted:
        _say(f"{len(contents.deleted)} artifacts were deleted, with their rows, while the backup was made")
    _say(f"{file}: the database and {contents.artifacts} artifacts, {contents.size / 2**20:.1f} MiB")
    if contents.damaged:
        _say("the backup is not complete: run `crankwright check --repair`, then back up again")


def _settings(data: Path | None) -> Settings:
    return Settings(data=data) if data else Settings()


def _say(text: str) -> None:
    click.echo(text, err=True)


@contextmanager
def _refusing() -> Iterator[None]:
    """End the command with a message if an error prevents it from running."""
    try:
        yield
    except (CannotRun, DatabaseLost) as error:
        _refuse(str(error))
    except OSError as error:
        _refuse(f"{error.filename or 'the disk'}: {error.strerror}")


def _refuse(text: str) -> NoReturn:
    click.secho(f"Error: {text}", fg="red", err=True)
    sys.exit(CANNOT_RUN)
