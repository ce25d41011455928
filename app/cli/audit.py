"""`crankwright audit …`: read the audit directly from the database, whether or not the service runs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.identity import audit, chain
from app.identity.audit import AuditFilter
from app.maintenance.errors import CannotRun
from app.maintenance.folder import database_file
from app.settings import Settings
from app.storage.connection import require_connection, require_database
from app.storage.engines import reading_engine, sqlite_file
from app.storage.errors import StorageError
from app.storage.migrations import refuse_unknown, schema_of
from app.storage.record import before_close
from templates.core.errors import plain

_data = click.option(
    "--data", type=click.Path(path_type=Path), default=None, help="folder of designs and artifacts"
)


@click.group("audit")
def audit_command() -> None:
    """List who changed what, and verify the hash chain of the audit."""


@audit_command.command("list")
@click.option("--object", default=None, help="a path below /api/v1/, such as designs/ID")
@click.option("--principal", default=None, help="id or name of the principal")
@click.option("--action", default=None, help="such as design.create, or design")
@click.option("--limit", type=click.IntRange(1, 100_000), default=50, show_default=True)
@_data
def list_command(
    object: str | None, principal: str | None, action: str | None, limit: int, data: Path | None
) -> None:
    """Print changes, newest first."""
    with _reading(data) as session:
        for row in audit.page(session, limit, None, AuditFilter(object, principal, action))[:limit]:
            seal = f"{row.seq}" if row.seq is not None else "not sealed"
            click.echo(plain(f"{row.at}  {row.name}  {row.action}  {row.object}  ({seal})", 500))


@audit_command.command("verify")
@click.option("--head", default=None, help="a hash that you recorded earlier; it must be in the chain")
@_data
@click.pass_context
def verify_command(ctx: click.Context, head: str | None, data: Path | None) -> None:
    """Verify the hash chain, and name the first changed, missing or inserted row.

    The exit code is 0 if the chain is intact, 1 if not, 2 if the database cannot be read. Missing rows at the
    end, or a chain that was completely rewritten, are detected only with a hash of `GET /api/v1/audit/head`
    that was recorded elsewhere: pass it as --head.
    """
    with _reading(data) as session:
        result = chain.verify(session, head)
    if result.fault:
        click.secho(plain(result.fault, 1000), fg="red")
    waiting = f"; {result.unsealed} more wait for the sealer" if result.unsealed else ""
    click.echo(f"{result.head.seq} rows are sound{waiting}; head {result.head.hash or 'none'}")
    ctx.exit(1 if result.fault else 0)


class CannotRead(click.ClickException):
    """The audit cannot be read, so nothing is known about its rows."""

    exit_code = 2


@contextmanager
def _reading(data: Path | None) -> Iterator[Session]:
    """Open a snapshot of the database in the settings."""
    settings = Settings(data=data) if data else Settings()
    try:
        engine = reading_engine(url := _url(settings))
        try:
            with Session(engine) as session:
                _require_audit(session)
                yield session
        finally:
            if file := sqlite_file(url):
                before_close(file)
            engine.dispose()
    except (CannotRun, StorageError) as error:
        raise CannotRead(str(error)) from None
    except DBAPIError as error:
        why = plain(str(error.orig).strip(), 300)
        raise CannotRead(f"The database cannot be read ({why}): see `crankwright check`.") from None


def _url(settings: Settings) -> str:
    url = settings.database_url
    if url:
        require_database(url)
    if url and sqlite_file(url) is None:
        require_connection(url)
        return url
    return f"sqlite:///{database_file(settings.data, url).absolute()}"


def _require_audit(session: Session) -> None:
    """Check that the database has an audit that this program can read; raises CannotRun or StorageError."""
    schema = schema_of(session.connection())
    if schema is None:
        raise CannotRun("The database holds no tables of Crankwright.")
    refuse_unknown(schema)
