"""`crankwright evaluate | template | freeze`: use templates in this process, without a service.

If the settings name no team folders, `evaluate` imports only the template that it evaluates. Only the
commands that need them import the settings, the models with the geometry kernel, and the schema.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from app.cli import start  # noqa: F401  # must precede every import of Pint

# isort: split
from app.catalogue.discovery import find_templates
from app.cli.arguments import argument
from app.plain import Raw
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import InvalidInputs, UnknownTemplate, UnusableFile
from templates.core.language.answer import Answer
from templates.core.language.evaluate import assumed
from templates.core.language.evaluate import evaluate as evaluate_template
from templates.core.language.template import Template
from templates.core.units.units import unit_symbol

if TYPE_CHECKING:
    from app.catalogue.team import Snapshot

GOLDEN = Path("tests/golden")
FOLDERS = "CRANKWRIGHT_TEMPLATE_FOLDERS"


class CatalogueCommand(click.Command):
    """A command that reports the faults of the catalogue without a traceback."""

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except (UnknownTemplate, UnusableFile) as error:
            raise click.ClickException(str(error)) from None


@click.command("evaluate", cls=CatalogueCommand)
@click.argument("template")
@click.argument("inputs", nargs=-1, metavar="NAME=QUANTITY…")
@click.option("--version", type=int, default=None, help="version; default: the latest")
@click.option("--output", "outputs", multiple=True, help="compute only this output (repeatable)")
@click.option("--json", "as_json", is_flag=True, help="print the whole answer as JSON")
def evaluate_command(
    template: str, inputs: tuple[str, ...], version: int | None, outputs: tuple[str, ...], as_json: bool
) -> None:
    """Evaluate TEMPLATE, for example: crankwright evaluate oil_film radial_load="25 kN" …

    A curve may come from a CSV file, pressure=@diagram.csv, from the column of that name or from another:
    pressure_angle=@diagram.csv:crank_angle.
    """  # noqa: D400
    cls = _find(template, version)
    try:
        raw = dict(_pair(text) for text in inputs)
        evaluation = evaluate_template(cls, raw, outputs=outputs or None)
    except InvalidInputs as error:
        lines = "\n".join(f"  {fault.name}: {fault.detail}" for fault in error.faults)
        raise click.ClickException(f"{cls.id} version {cls.version} refuses these inputs:\n{lines}") from None
    if as_json:
        from app.calculations import json_values

        click.echo(json.dumps(json_values.evaluation(evaluation), indent=2, ensure_ascii=False))
        return
    for name, answer in evaluation.outputs.items():
        click.echo(f"{name:32} {_result(answer)}")
    for warning in evaluation.warnings:
        click.secho(f"warning: {warning.name}: {warning.detail}", fg="yellow", err=True)
    for one in assumed(evaluation.template, evaluation.outputs, evaluation.criteria):
        click.secho(f"assumed: {one.detail}", err=True)


def _result(answer: Answer) -> str:
    """Return an output as one line; for an array, its length and range."""
    printed = unit_symbol(answer.unit or "1")
    if answer.value is None:
        return f"{'none':>14} ({answer.reason})"
    if isinstance(answer.value, str):
        return f"{answer.value:>14}"
    if isinstance(answer.value, float):
        return f"{answer.value:>14.6g} {printed}"
    low, high = np.nanmin(answer.value), np.nanmax(answer.value)
    return f"{low:>14.6g} … {high:.6g} {printed} ({answer.value.size} values)"


def _pair(text: str) -> tuple[str, Raw]:
    name, sign, value = text.partition("=")
    if not sign:
        raise click.BadParameter(f"{text!r} is not of the form NAME=QUANTITY, such as radial_load='25 kN'")
    return name, argument(name, value)


@click.group("template")
def template_command() -> None:
    """List the templates."""


@template_command.command("list", cls=CatalogueCommand)
@click.option("--search", default="", help="a title, standard, author, symbol, or textbook name")
def list_templates(search: str) -> None:
    """List every version of every template, or the results of a search."""
    from app.catalogue.search import matching

    kept, notes = matching(_catalogue(), search) if search.strip() else (list(_catalogue()), [])
    for note in notes:
        click.echo(note, err=True)
    for cls in kept:
        state = f"withdrawn: {cls.withdrawn}" if cls.withdrawn else "released"
        click.echo(f"{cls.id} {cls.version}  ({state})  {cls.title()}")


@template_command.command("show", cls=CatalogueCommand)
@click.argument("id")
@click.option("--version", type=int, default=None, help="version; default: the latest")
def show_template(id: str, version: int | None) -> None:
    """Show inputs, outputs, limits and errata of one version."""
    from templates.core.paper.schema import describe

    cls = _find(id, version)
    description = describe(cls)
    click.echo(f"{cls.id} version {cls.version}, digest {description['digest'][:12]}")
    click.echo(f"{cls.summary()}\n\nInputs")
    for name, schema in description["inputs"]["properties"].items():
        default = f"  [{_shown(schema['default'])}]" if "default" in schema else ""
        click.echo(f"  {name:32} {schema.get('unit', ''):10} {schema['title']}{default}")
    click.echo("\nOutputs")
    for name, schema in description["outputs"]["properties"].items():
        click.echo(f"  {name:32} {schema.get('unit', ''):10} {schema['title']}")
    for title in ("limits", "errata", "references"):
        lines = (entry["text"] if isinstance(entry, dict) else entry for entry in description[title])
        click.echo(f"\n{title.capitalize()}\n" + "\n".join(f"  {line}" for line in lines))


def _shown(default: object) -> str:
    return f"{default['value']} {default['unit']}" if isinstance(default, dict) else str(default)


@click.command("freeze", cls=CatalogueCommand)
@click.argument("id")
@click.argument("version", type=int)
@click.option("--folder", type=click.Path(path_type=Path), default=GOLDEN, show_default=True)
def freeze_command(id: str, version: int, folder: Path) -> None:
    """Write the golden record of a template or model before its release; never overwrite an existing one."""
    from templates.core.catalogue.golden import freeze

    snapshot = _snapshot()
    try:
        is_model = id in snapshot.models.ids
        cls = snapshot.models.get(id, version) if is_model else snapshot.templates.get(id, version)
        click.echo(f"written: {freeze(cls, folder)}")
    except FileExistsError as error:
        raise click.ClickException(
            f"{error}: a released version cannot change; create a new version"
        ) from None


def _find(id: str, version: int | None) -> type[Template]:
    """Return one version, or the latest one that is not withdrawn."""
    catalogue = _catalogue(id, version)
    if not catalogue.versions:
        catalogue = _catalogue()  # its error lists the existing templates
    return catalogue.latest(id) if version is None else catalogue.get(id, version)


def _catalogue(id: str | None = None, version: int | None = None) -> Catalogue[Template]:
    """Return the catalogue of templates.

    Unless files of a team may have faults to report, it holds only the requested id and version.
    """
    has_team = FOLDERS in map(str.upper, os.environ)
    return _snapshot().templates if has_team else find_templates((), id, version)


def _snapshot() -> Snapshot:
    """Return all usable templates and models, and report files that cannot be used."""
    from app.catalogue.catalogues import loaded
    from app.settings import Settings

    snapshot = loaded(Settings().template_folders)
    for file in snapshot.files:
        for fault in file.faults:
            click.secho(f"{file.path} is not used: {fault.sentence}", fg="yellow", err=True)
    return snapshot
