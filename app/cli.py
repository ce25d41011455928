"""The command line: `crankwright serve | demo | study | sweep | impact | evaluate | template | …`."""

from __future__ import annotations

import json
from pathlib import Path

import click
import numpy as np

from app import server
from app.approval_commands import approve_command, verify_report_command
from app.audit_commands import audit_command
from app.calculations import rendering
from app.calculations.arguments import argument
from app.catalogue.catalogues import loaded
from app.catalogue.commands import check_template_command
from app.demo import demonstrate
from app.downloads import download_command
from app.hosts import is_loopback
from app.impact_commands import impact_command
from app.key_commands import asks_for_keys, keys_command
from app.main import create_app
from app.maintenance.commands import backup_command, check_command, restore_command
from app.plain import Json, JsonObject, Raw
from app.settable import SettableCommands
from app.settings import Settings
from app.storage.connecting import require_answer
from app.storage.errors import StorageError
from app.storage.folder import DataFolder
from app.storage.integrity import refuse_damage
from app.storage.ownership import require_own_store
from app.study_commands import study_command, sweep_command
from app.workers.remote.commands import scheduler_command, worker_command
from app.worksheet_commands import worksheet_command
from cad.model import CadModel
from templates.core.catalogue.finding import Catalogue
from templates.core.catalogue.golden import freeze as freeze_template
from templates.core.errors import InvalidInputs, UnknownTemplate, UnusableFile
from templates.core.language.evaluate import Answer
from templates.core.language.evaluate import evaluate as evaluate_template
from templates.core.language.template import Template
from templates.core.paper.mathml import unit_symbol
from templates.core.paper.schema import describe

GOLDEN = Path("tests/golden")


class Commands(SettableCommands):
    """Commands that say what is wrong with the catalogue, not where the program noticed."""

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except (UnknownTemplate, UnusableFile) as error:
            raise click.ClickException(str(error)) from None


@click.group(cls=Commands)
@click.version_option(package_name="crankwright")
def main() -> None:
    """Engine-bearing calculations that drive geometry."""


@main.command()
@click.option(
    "--host", default=None, help="address to listen on; 127.0.0.1 unless CRANKWRIGHT_HOST says else"
)
@click.option(
    "--port", default=None, type=click.IntRange(0, 65535), help="8000 unless CRANKWRIGHT_PORT says else"
)
@click.option("--data", type=click.Path(path_type=Path), default=None, help="folder of designs and artifacts")
@click.option("--insecure", is_flag=True, help="listen beyond this machine although nothing asks for a key")
def serve(host: str | None, port: int | None, data: Path | None, insecure: bool) -> None:
    """Serve the REST interface; its documentation is at /docs."""
    given: JsonObject = {"data": data, "host": host, "port": port}
    settings = Settings(**{name: value for name, value in given.items() if value is not None})
    try:
        require_answer(settings)
        _check_reach(settings, insecure)
        folder = DataFolder(settings.data)
        refuse_damage(settings.database_url or folder.database_url)
        if settings.artifacts_url is not None:
            require_own_store(settings, folder)
        folder.release()
    except StorageError as error:
        raise click.ClickException(str(error)) from None
    except OSError as error:
        message = f"{settings.data.absolute()} cannot hold the data: {error.strerror}"
        raise click.ClickException(f"{message}; name another folder by --data") from None
    place = f"[{settings.host}]" if ":" in settings.host else settings.host
    click.echo(
        f"Crankwright at http://{place}:{settings.port}/docs, data in {settings.data.absolute()}", err=True
    )
    server.run(create_app(settings), settings)


def _check_reach(settings: Settings, insecure: bool) -> None:
    """Refuse to listen beyond this machine where nothing asks for a key, unless the operator insists.

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
            f"refusing to listen on {host} {danger}. {remedy}; or add --insecure if all of them may."
        )
    click.secho(f"WARNING: listening on {host} {danger}. {remedy}.", fg="yellow", err=True)


main.add_command(approve_command)
main.add_command(verify_report_command)
main.add_command(audit_command)
main.add_command(check_command)
main.add_command(download_command)
main.add_command(backup_command)
main.add_command(restore_command)
main.add_command(check_template_command)
main.add_command(study_command)
main.add_command(sweep_command)
main.add_command(worksheet_command)
main.add_command(impact_command)
main.add_command(keys_command)
main.add_command(worker_command)
main.add_command(scheduler_command)


@main.command()
@click.option("--data", type=click.Path(path_type=Path), default=None, help="that of `serve`, if not given")
@click.option("--team", is_flag=True, help="on PostgreSQL, S3, Dask and two servers; nothing stays")
def demo(data: Path | None, team: bool) -> None:
    """The paper's demonstration: SCALE and D drive a ball bearing from 50 mm to 48 mm.

    Its design stays: `crankwright serve` shows it. With --team nothing stays.
    """
    if not team:
        demonstrate(data or Settings().data)
        return
    if data is not None:
        raise click.UsageError("--team keeps nothing, so it takes no --data")
    from app.team.demonstration import demonstrate_team

    demonstrate_team()


@main.command()
@click.argument("template")
@click.argument("inputs", nargs=-1, metavar="NAME=QUANTITY…")
@click.option("--version", type=int, default=None, help="the latest, if not given")
@click.option("--output", "outputs", multiple=True, help="compute this only (repeatable)")
@click.option("--json", "as_json", is_flag=True, help="print the whole answer as JSON")
def evaluate(
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
        raise click.ClickException(f"{cls.id} version {cls.version} refuses:\n{lines}") from None
    if as_json:
        click.echo(json.dumps(rendering.evaluation(evaluation), indent=2, ensure_ascii=False))
        return
    for name, answer in evaluation.outputs.items():
        click.echo(f"{name:32} {_result(answer)}")
    for warning in evaluation.warnings:
        click.secho(f"warning: {warning.name}: {warning.detail}", fg="yellow", err=True)


def _result(answer: Answer) -> str:
    """An answer on a line; of an array its length and its range."""
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
        raise click.BadParameter(f"{text!r} is no NAME=QUANTITY, such as radial_load='25 kN'")
    return name, argument(name, value)


@main.group()
def template() -> None:
    """What templates there are."""


@template.command("list")
def list_templates() -> None:
    """Every version of every template."""
    for cls in _catalogue():
        state = f"withdrawn: {cls.withdrawn}" if cls.withdrawn else "released"
        click.echo(f"{cls.id} {cls.version}  ({state})  {cls.title()}")


@template.command("show")
@click.argument("id")
@click.option("--version", type=int, default=None, help="the latest, if not given")
def show_template(id: str, version: int | None) -> None:
    """Inputs, outputs, limits and errata of one version."""
    cls = _find(id, version)
    description = describe(cls)
    click.echo(f"{cls.id} version {cls.version}, digest {description['digest'][:12]}")
    click.echo(f"{cls.summary()}\n\nInputs")
    for name, schema in description["inputs"]["properties"].items():
        default = f"  [{_shown(schema['default'])}]" if "default" in schema else ""
        click.echo(f"  {name:32} {schema.get('unit', ''):10} {schema['title']}{default}")
    click.echo("\nOutputs")
    for name, schema in description["outputs"]["properties"].items():
        click.echo(f"  {name:32} {schema['unit']:10} {schema['title']}")
    for title in ("limits", "errata", "references"):
        lines = (entry["text"] if isinstance(entry, dict) else entry for entry in description[title])
        click.echo(f"\n{title.capitalize()}\n" + "\n".join(f"  {line}" for line in lines))


def _shown(default: Json) -> str:
    return f"{default['value']} {default['unit']}" if isinstance(default, dict) else str(default)


@main.command()
@click.argument("id")
@click.argument("version", type=int)
@click.option("--folder", type=click.Path(path_type=Path), default=GOLDEN, show_default=True)
def freeze(id: str, version: int, folder: Path) -> None:
    """Write the golden record of a template or model about to be released; never over an existing one."""
    catalogue: Catalogue[CadModel] = loaded(Settings().template_folders).models
    try:
        cls = catalogue.get(id, version) if id in catalogue.ids else _find(id, version)
        click.echo(f"written: {freeze_template(cls, folder)}")
    except FileExistsError as error:
        raise click.ClickException(f"{error}: a released version is not changed; make a new one") from None


def _catalogue() -> Catalogue[Template]:
    """The templates; a file that cannot be used is reported, and the others are there."""
    snapshot = loaded(Settings().template_folders)
    for file in snapshot.files:
        for fault in file.faults:
            click.secho(f"{file.path} is not used: {fault.sentence}", fg="yellow", err=True)
    return snapshot.templates


def _find(id: str, version: int | None) -> type[Template]:
    return _catalogue().latest(id) if version is None else _catalogue().get(id, version)
