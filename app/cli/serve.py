"""`crankwright serve`: check the settings and the address, then start the service."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import click

from app.assembly import NETWORK, SHEETS
from app.calculations.assembly import PRELOAD
from app.catalogue.discovery import find_templates
from app.cli.keys import asks_for_keys
from app.http import server
from app.main import create_app
from app.plain import JsonObject
from app.settings import Settings
from app.settings.hosts import is_loopback
from app.settings.machines import LOCAL
from app.signing.keys import opened_keys
from app.storage.connection import require_answer, require_sound
from app.storage.errors import StorageError
from app.storage.folder import DataFolder
from app.storage.ownership import require_own_store
from app.workers import prefork
from app.workers.light import CHECKS
from app.workers.local import KERNEL
from cad import on_demand
from cad.catalogue import models


def fork_ahead(settings: Settings) -> None:
    """Fork the server processes that these settings need; call this before any thread or connection exists.

    Built-in templates and models are imported first, so that the processes share their memory. The fork
    server of jobs loads the kernel while the server opens its data; the others are ready at once.

    Raises
    ------
    UnusableFile
        If a template or model cannot be used.
    """
    find_templates(())
    models()
    if settings.engine == LOCAL:
        prefork.fork(KERNEL, on_demand.load)
    if settings.template_folders:
        prefork.fork(CHECKS)
    prefork.fork((*PRELOAD, *SHEETS, *NETWORK))


@click.command("serve")
@click.option("--host", default=None, help="address to listen on; 127.0.0.1 unless CRANKWRIGHT_HOST is set")
@click.option(
    "--port", default=None, type=click.IntRange(0, 65535), help="8000 unless CRANKWRIGHT_PORT is set"
)
@click.option("--data", type=click.Path(path_type=Path), default=None, help="folder of designs and artifacts")
@click.option("--insecure", is_flag=True, help="listen on other addresses although no key is required")
def serve_command(host: str | None, port: int | None, data: Path | None, insecure: bool) -> None:
    """Serve the REST interface; its documentation is at /docs."""
    given: JsonObject = {"data": data, "host": host, "port": port}
    settings = Settings(**{name: value for name, value in given.items() if value is not None})
    fork_ahead(settings)
    try:
        require_answer(settings)
        _check_reach(settings, insecure)
        _check_data(settings)
    except StorageError as error:
        raise click.ClickException(str(error)) from None
    except OSError as error:
        message = f"{settings.data.absolute()} cannot hold the data: {error.strerror}"
        raise click.ClickException(f"{message}; name another folder with --data") from None
    place = f"[{settings.host}]" if ":" in settings.host else settings.host
    with suppress(OSError):  # a log on a full disk does not stop the server
        click.echo(
            f"Crankwright at http://{place}:{settings.port}, data in {settings.data.absolute()}", err=True
        )
    server.run(create_app(settings), settings)


def _check_data(settings: Settings) -> None:
    """Check that database, file store and stamp keys can be used; raise StorageError or OSError if not."""
    folder = DataFolder(settings.data)
    try:
        require_sound(settings, folder)
        if settings.artifacts_url is not None:
            require_own_store(settings, folder)
        if opened_keys(settings) is None:
            click.echo("STEP and GLB files stay unsigned: set CRANKWRIGHT_STAMP_KEYS", err=True)
    finally:
        folder.release()


def _check_reach(settings: Settings, insecure: bool) -> None:
    """Refuse to listen on an address beyond this machine without keys, unless the operator insists.

    Raises
    ------
    ClickException
        If the host is not loopback, there is no key, and `insecure` is not set.
    """
    host = settings.host
    if is_loopback(host.lower()) or asks_for_keys(settings):
        return
    danger = "without authentication: whoever reaches this address can read and change every design"
    remedy = (
        "Add a key: crankwright keys add NAME --role admin. Or listen on 127.0.0.1, and put a reverse proxy "
        "with authentication in front"
    )
    if not insecure:
        raise click.ClickException(
            f"refusing to listen on {host} {danger}. {remedy}; or add --insecure to allow it."
        )
    click.secho(f"WARNING: listening on {host} {danger}. {remedy}.", fg="yellow", err=True)
