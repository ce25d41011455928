"""Connect commands to a running service, or to one that the command starts on a data folder."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click
import httpx

from app.cli.demonstration import service
from app.client import Client, Problem
from app.client.names import authorization
from app.settings import Settings

KEY = "CRANKWRIGHT_KEY"
PATIENCE = 600.0  # longest wait for an answer; a busy service plans studies one at a time [s]

url_option = click.option(
    "--url", default=None, help="address of the service; default: this machine, port CRANKWRIGHT_PORT"
)
data_option = click.option(
    "--data",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=None,
    help="use a data folder that no service uses, instead of a service",
)


@contextmanager
def connected(url: str | None, data: Path | None) -> Iterator[Client]:
    """Open a client of the named service, or of a new service on a data folder."""
    place = url or f"http://127.0.0.1:{Settings().port}"
    try:
        if data is not None:
            with service(data, err=True, key=key_of_user()) as client:
                yield client
        else:
            with Client(place, timeout=PATIENCE, key=key_of_user()) as client:
                yield client
    except Problem as problem:
        raise click.ClickException(reasons(problem)) from None
    except httpx.HTTPError as error:
        where = "the service on the data folder does not answer" if data else f"no service answers at {place}"
        raise click.ClickException(f"{where}: {error}") from None


def key_of_user() -> str | None:
    """Return the key in CRANKWRIGHT_KEY, for a service that requires one.

    Raises
    ------
    ClickException
        If it does not have the form of a key.
    """
    key = os.environ.get(KEY) or None
    try:
        authorization(key)
    except ValueError as error:
        raise click.ClickException(f"{KEY}: {error}") from None
    return key


def reasons(problem: Problem) -> str:
    """Return a problem as text, with each of its faults on a separate line."""
    return "\n".join([str(problem), *(f"  {fault.name}: {fault.detail}" for fault in problem.errors)])
