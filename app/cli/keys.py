"""`crankwright keys …`: manage principals and keys directly in the database, even if all keys are lost.

A service may be running at the same time; it applies the change within a few seconds.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import click

from app.identity.errors import IdentityError
from app.identity.principal import ROLES, Role
from app.identity.rows import is_over
from app.identity.service import Changes, Identity, Kind
from app.settings import Settings
from app.storage.connection import opened_database, require_connection
from app.storage.database import Database
from app.storage.engines import sqlite_file
from app.storage.errors import DataFolderInUse, StorageError
from app.storage.folder import DATABASE, DataFolder
from app.storage.migrations import migrate
from app.storage.tables import ApiKeyRow, PrincipalRow

_EVERY = 500  # principals read in one query
_SPAN = re.compile(r"([1-9][0-9]{0,4})([dh])")

data_option = click.option(
    "--data",
    type=click.Path(file_okay=False, path_type=Path),
    default=None,
    help="data folder; default: CRANKWRIGHT_DATA, or the database of CRANKWRIGHT_DATABASE_URL",
)


@click.group("keys")
def keys_command() -> None:
    """Add, list and revoke keys; disable and enable principals.

    As soon as one key exists, the service requires keys.
    """


@keys_command.command("add")
@click.argument("name")
@click.option("--role", "roles", type=click.Choice(ROLES), multiple=True, help="role of NAME (repeatable)")
@click.option("--kind", type=click.Choice(["person", "service"]), default="person", show_default=True)
@click.option("--expires", default=None, metavar="90d", help="lifetime of the key in days (d) or hours (h)")
@click.option(
    "--scope",
    "scopes",
    type=click.Choice(ROLES),
    multiple=True,
    help="limit the key to this role (repeatable)",
)
@data_option
def add_command(
    name: str,
    roles: tuple[Role, ...],
    kind: Kind,
    expires: str | None,
    scopes: tuple[Role, ...],
    data: Path | None,
) -> None:
    """Print a new key of NAME, once; if there is no principal NAME, the command adds it with its roles."""
    until = _moment(expires)
    with opened(data) as identity:
        row = identity.named(name)
        if row is None:
            if not roles:
                raise click.ClickException(
                    f"there is no principal {name!r} yet: give --role, one of {', '.join(ROLES)}"
                )
            row = identity.add(name, roles, kind)
        elif roles and set(roles) != set(row.roles):
            raise click.ClickException(
                f"{name} has the roles {', '.join(row.roles)}; omit --role for another key, or change "
                f"them: POST /api/v1/principals/{row.id}"
            )
        key, _ = identity.add_key(row.id, scopes=scopes, expires=until)
    click.echo(f"a key of {name} ({', '.join(scopes or row.roles)}), shown only once:", err=True)
    click.echo(key.text)


@keys_command.command("list")
@data_option
def list_command(data: Path | None) -> None:
    """List every principal with its keys, by prefix, and for each key the key that created it.

    A key ends with the key that created it.
    """
    with opened(data) as identity:
        after = None
        while rows := identity.page(_EVERY, after):
            for row in rows:
                state = "  DISABLED" if row.disabled else ""
                click.echo(f"{row.name}  {row.kind}  {', '.join(row.roles)}{state}")
                for key in identity.keys(row.id):
                    click.echo(f"  {_described(key)}")
            after = rows[-1].id


@keys_command.command("revoke")
@click.argument("prefix")
@data_option
def revoke_command(prefix: str, data: Path | None) -> None:
    """Revoke the key with this PREFIX, the part between `cw_` and the next `_`.

    Keys that it created are revoked too; the command names them.
    """
    with opened(data) as identity:
        key, *others = identity.revoke(prefix.removeprefix("cw_")[:10])
    click.echo(f"{key.prefix} is revoked; running servers take notice within a few seconds")
    for other in others:
        click.echo(f"{_named_key(other)} is also revoked, because {other.made_by} created it")


@keys_command.command("disable")
@click.argument("name")
@data_option
def disable_command(name: str, data: Path | None) -> None:
    """Disable NAME: its keys and sessions are no longer accepted."""
    _set_disabled(name, data, True)


@keys_command.command("enable")
@click.argument("name")
@data_option
def enable_command(name: str, data: Path | None) -> None:
    """Enable NAME again."""
    _set_disabled(name, data, False)


def _set_disabled(name: str, data: Path | None, disabled: bool) -> None:
    with opened(data) as identity:
        identity.change(_named(identity, name).id, Changes(disabled=disabled))
    click.echo(f"{name} is {'disabled' if disabled else 'enabled'}")


def _named(identity: Identity, name: str) -> PrincipalRow:
    if (row := identity.named(name)) is None:
        raise click.ClickException(f"there is no principal {name!r}; `crankwright keys list` names them")
    return row


def _named_key(key: ApiKeyRow) -> str:
    return f"{key.prefix} ({key.name})" if key.name else key.prefix


def _described(key: ApiKeyRow) -> str:
    origin = f"  made by {key.made_by}" if key.made_by else ""
    return f"{key.prefix}  {', '.join(key.scopes) or 'all roles'}  {_state(key)}{origin}"


def _state(key: ApiKeyRow) -> str:
    if key.revoked:
        return f"revoked {key.revoked[:10]}"
    if key.expires is None:
        return "valid"
    return f"{'expired' if is_over(key.expires) else 'valid until'} {key.expires[:16]}Z"


def _moment(span: str | None) -> datetime | None:
    """Return the moment that follows the present one by a duration such as `90d`."""
    if span is None:
        return None
    if (match := _SPAN.fullmatch(span)) is None:
        raise click.BadParameter(f"{span!r} is not a duration; write days as 90d or hours as 12h")
    amount = int(match[1])
    return datetime.now(UTC) + (timedelta(days=amount) if match[2] == "d" else timedelta(hours=amount))


@contextmanager
def opened(data: Path | None) -> Iterator[Identity]:
    """Open the principals and keys in the database of a data folder or of the settings.

    The database may be in use.
    """
    settings = Settings() if data is None else Settings(data=data)
    try:
        database = Database(_prepared(settings))
        try:
            yield Identity(database, settings)
        finally:
            database.close()
    except (StorageError, IdentityError) as error:
        raise click.ClickException(str(error)) from None
    except OSError as error:
        raise click.ClickException(f"{settings.data} cannot hold the data: {error.strerror}") from None


def _prepared(settings: Settings) -> str:
    """Return the URL of the database; migrate it first, unless a running server holds the data folder.

    A shared database needs no folder, so this also works without a writable one.
    """
    if (shared := settings.database_url) is not None:
        require_connection(shared)
        if sqlite_file(shared) is None:
            migrate(shared)
            return shared
    try:
        folder = DataFolder(settings.data)
    except DataFolderInUse:
        if settings.database_url is not None:
            migrate(settings.database_url)
        return settings.database_url or f"sqlite:///{settings.data.absolute() / DATABASE}"
    try:
        database = opened_database(settings, folder, lambda units, seconds, failed: None)
        database.close()
        return database.url
    finally:
        folder.release()


def asks_for_keys(settings: Settings) -> bool:
    """Return whether a service with these settings requires keys from its first request."""
    if settings.oidc_issuer is not None:
        return True
    url = settings.database_url
    file = sqlite_file(url) if url else settings.data / DATABASE
    if file is not None and not file.exists():
        return False
    with opened(settings.data) as identity:
        return bool(identity.page(1))
