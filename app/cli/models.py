"""`crankwright model …`: import models from FreeCAD, Creo or a STEP file."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.connections import connected, data_option, url_option
from app.imported_models.schemas import ImportedParameter
from templates.core.errors import plain


@click.group("model")
def model_command() -> None:
    """Manage models that other programs draw: import a file, show its origin, save the original."""


@model_command.command("programs")
@url_option
@data_option
def programs_command(url: str | None, data: Path | None) -> None:
    """List the programs that draw models for the service, and how to install missing ones."""
    with connected(url, data) as client:
        for one in client.drawing_programs():
            click.echo(f"{one.name} ({one.files}): {'' if one.available else 'missing, '}{plain(one.detail)}")


@model_command.command("import")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--id", required=True, help="id of the model: lower-case letters, digits and single _")
@url_option
@data_option
def import_command(file: Path, id: str, url: str | None, data: Path | None) -> None:
    """Import FILE as the model ID, or as its next version.

    FILE is a document of FreeCAD (.FCStd), a STEP file as a fixed part, or a manifest (JSON) of a model in
    Creo or of an assembly. The command prints the version, its parameters, and how far its solids can be
    trusted.
    """
    with connected(url, data) as client:
        model = client.import_model(id, file.read_bytes(), file.name, on_progress=_progress)
        origin = client.model_origin(model.id, model.version)
    click.echo(f"{model.id} version {model.version}: {plain(model.title)}")
    for one in origin.parameters:
        click.echo(plain(f"  {_line(one)}"))
    for finding in origin.findings:
        click.echo(plain(f"found: {finding}", 2000))
    click.echo(plain(f"trust: {origin.trust}", 2000))


@model_command.command("original")
@click.argument("id")
@click.option("--version", type=click.IntRange(1), required=True)
@click.option("--folder", type=click.Path(exists=True, file_okay=False, path_type=Path), default=Path())
@url_option
@data_option
def original_command(id: str, version: int, folder: Path, url: str | None, data: Path | None) -> None:
    """Save, under its own name, the file from which a version of the model ID was imported."""
    with connected(url, data) as client:
        file = client.original_model(id, version)
    try:
        click.echo(file.save(folder))
    except OSError as error:
        raise click.ClickException(f"{folder.absolute()} cannot hold the file: {error.strerror}") from None


def _line(one: ImportedParameter) -> str:
    read = f"read back as a {one.read_back}" if one.read_back else "not read back"
    moves = f"; moves {one.moves}" if one.moves else ""
    value = f"{one.value:g}{'' if one.unit == '1' else ' ' + one.unit}"
    return f"{one.name} = {value}  ({one.source}; {read}{moves})"


def _progress(done: float, text: str) -> None:
    click.echo(f"  {done:4.0%}  {text}", err=True)
