"""`crankwright worker` and `crankwright scheduler`: run a worker machine of a team, or its scheduler."""

from __future__ import annotations

import json
import os
import sys
from typing import NoReturn

import click

from app.settings import Settings
from app.settings.hosts import is_loopback
from app.settings.machines import EXAMPLE, FILES, LOCAL, TEAM, is_installed

_BOOT = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from app.workers.remote.{} import main; main()"
)


@click.command("worker")
@click.option("--scheduler", help="address of the scheduler; default: CRANKWRIGHT_ENGINE", metavar="URL")
@click.option("--lanes", help='simultaneous jobs by lane: {"geometry": 2, "analysis": 1}', metavar="JSON")
def worker_command(scheduler: str | None, lanes: str | None) -> None:
    """Run jobs for the servers that use the same scheduler and the same version of the program.

    The command waits until the scheduler runs, and reconnects when the connection breaks.
    """
    given = {"CRANKWRIGHT_ENGINE": scheduler, "CRANKWRIGHT_LANES": lanes}
    os.environ.update({name: value for name, value in given.items() if value is not None})
    settings = Settings()
    if settings.engine == LOCAL:
        raise click.ClickException(f"name the scheduler with --scheduler, such as {EXAMPLE}")
    _become("machine")


@click.command("scheduler")
@click.option("--host", default="127.0.0.1", show_default=True, help="address to listen on")
@click.option("--port", default=8786, show_default=True, type=click.IntRange(0, 65535))
def scheduler_command(host: str, port: int) -> None:
    """Pass jobs from servers to workers; with TLS if CRANKWRIGHT_DASK_CA, _CERT and _KEY are set."""
    settings = Settings()
    if not is_installed():
        raise click.ClickException(TEAM)
    files = (settings.dask_ca, settings.dask_cert, settings.dask_key)
    if any(files) and not all(files):
        raise click.ClickException(f"{FILES} belong together")
    if not any(files) and not is_loopback(host.lower()):
        detail = f"whoever reaches it can run code: set {FILES}"
        raise click.ClickException(f"refusing to listen on {host} without TLS: {detail}")
    _become("scheduler", host, str(port))


def _become(module: str, *args: str) -> NoReturn:
    """Replace this process with another program, which imports only the modules that it needs."""
    command = [sys.executable, "-c", _BOOT.format(module), json.dumps(sys.path), *args]
    sys.stdout.flush()
    os.execv(sys.executable, command)
