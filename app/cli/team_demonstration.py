"""`crankwright demo --team`: run the demonstration with two servers, two workers, PostgreSQL and S3."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType
from typing import NoReturn

import click

from app.cli.demonstration import MAPPED, build_of, changed, created, dimensions_of
from app.client import Client
from app.designs.schemas.designs import Design
from app.team.errors import DidNotStart, Missing
from app.team.parts import running

WORKERS = 2
TIMEOUT = 120.0  # longest wait for an answer, on a busy machine [s]


def demonstrate_team(workers: int = WORKERS) -> None:
    """Run the demonstration with a temporary team on loopback, and leave nothing behind.

    Raises
    ------
    ClickException
        If a program is not installed, or a part does not start.
    """
    try:
        with _ending_in_order(), TemporaryDirectory(prefix="crankwright-team-") as folder:
            with running(Path(folder), _say, workers=workers) as team:
                _run([server.url for server in team.servers], Path(folder))
    except Missing as error:
        lacking = "\n".join(f"  {line}" for line in str(error).splitlines())
        raise click.ClickException(f"a team needs programs that are not installed:\n{lacking}") from None
    except DidNotStart as error:
        raise click.ClickException(str(error)) from None
    click.echo("all parts have ended, and their files are removed")


def _run(urls: list[str], folder: Path) -> None:
    with ExitStack() as stack:
        here, there = (stack.enter_context(Client(url, timeout=TIMEOUT)) for url in urls)
        click.echo("server A, with the workers:")
        before = created(here)
        _say_bore(here, before, "server A")
        click.echo("server B, with the workers:")
        after = changed(there, there.design(before.id), "tie inner_diameter to the worksheet", MAPPED)
        file = here.download(after.id, "step", revision=after.revision)
        size = file.save(folder).stat().st_size
        click.echo(f"server A gives the STEP file of revision {after.revision}, {size} bytes from the bucket")
        _say_bore(here, here.design(after.id), "server A")


def _say_bore(client: Client, design: Design, name: str) -> None:
    bore = dimensions_of(client, build_of(client, design))["inner_diameter"]
    click.echo(
        f"{name}: revision {design.revision} has a bore of {bore.value:.6g} {bore.unit}, measured on the "
        "re-imported STEP file"
    )


def _say(text: str) -> None:
    click.echo(text)


@contextmanager
def _ending_in_order() -> Iterator[None]:
    """Raise SystemExit if the terminal closes or the program is terminated, so that all parts stop."""
    numbers = (signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.signal(number, _end) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _end(number: int, frame: FrameType | None) -> NoReturn:
    sys.exit(128 + number)
