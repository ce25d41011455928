"""`crankwright download`: download a file of a design from a running service."""

from __future__ import annotations

from pathlib import Path

import click
import httpx

from app.client import Client, File, Problem
from app.settings import Settings
from cad.file_kinds import BY_PART, MEDIA_TYPES

KINDS = ", ".join(MEDIA_TYPES)


@click.command(
    "download",
    help="Save a file of DESIGN (an id) as {design}_{model}_r{revision}.KIND.\n\n"
    f"KIND is one of {KINDS}; or zip, for the STEP files of all variants. If the service must create the "
    "file first, the command waits for it.",
)
@click.argument("design")
@click.argument("kind", default="step")
@click.option("--model", default=None, help="name of the model in the design, if there are several")
@click.option("--part", default=None, help=f"the only part in a file of kind {', '.join(BY_PART)}")
@click.option("--variant", default=None, help="variant of the design; default: the design itself")
@click.option(
    "--revision",
    type=click.IntRange(1),
    default=None,
    help="revision; default: that of the newest valid model",
)
@click.option("--folder", type=click.Path(exists=True, file_okay=False, path_type=Path), default=Path())
@click.option(
    "--url", default=None, help="address of the service; default: this machine, port CRANKWRIGHT_PORT"
)
def download_command(
    design: str,
    kind: str,
    model: str | None,
    part: str | None,
    variant: str | None,
    revision: int | None,
    folder: Path,
    url: str | None,
) -> None:
    """Save a file of a design."""
    place = url or f"http://127.0.0.1:{Settings().port}"
    try:
        with Client(place) as client:
            file = _file(client, design, kind, model, part, variant, revision)
        click.echo(file.save(folder))
    except Problem as problem:
        raise click.ClickException(str(problem)) from None
    except httpx.HTTPError as error:
        raise click.ClickException(f"no service answers at {place}: {error}") from None
    except OSError as error:
        raise click.ClickException(f"{folder.absolute()} cannot hold the file: {error.strerror}") from None


def _file(
    client: Client,
    design: str,
    kind: str,
    model: str | None,
    part: str | None,
    variant: str | None,
    revision: int | None,
) -> File:
    if part is not None and (kind == "zip" or variant is not None):
        raise click.UsageError("--part names a part of the design itself; omit --variant and zip")
    if kind == "zip":
        return client.download_variants(design, revision, on_progress=_progress)
    if variant is not None:
        return client.download_variant(
            design, variant, kind, model=model, revision=revision, on_progress=_progress
        )
    return client.download(design, kind, model=model, revision=revision, part=part, on_progress=_progress)


def _progress(done: float, text: str) -> None:
    click.echo(f"  {done:4.0%}  {text}", err=True)
