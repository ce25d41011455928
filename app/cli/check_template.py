"""`crankwright check-template FILE`: report the faults of a template file before it is installed."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import click

from app.catalogue.catalogues import loaded
from app.catalogue.check import CheckInProcess
from app.catalogue.team import TeamFile, TeamFiles, merged
from app.settings import Settings
from app.workers.base import Limits
from app.workers.local import LocalProcesses
from cad.model import CadModel
from templates.core.language.template import Template

PRELOAD = ("cad.surfaces", "cad.model", "templates.core.checks.check", "app.catalogue.check")


@click.command("check-template")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="print the faults as JSON")
@click.option(
    "--seconds",
    type=click.FloatRange(min=0, min_open=True),
    help="longest time of the check [s]; default: 30",
)
@click.pass_context
def check_template_command(ctx: click.Context, file: Path, as_json: bool, seconds: float | None) -> None:
    """Check FILE, a template or CAD model `<id>_v<version>.py`, as the service does when it loads the file.

    The exit code is 1 if the file has faults.
    """
    checked = _checked(file, seconds)
    if as_json:
        faults = [asdict(fault) for fault in checked.faults]
        click.echo(json.dumps({"file": str(file), "sound": not faults, "faults": faults}, indent=2))
    else:
        _print(file, checked)
    ctx.exit(1 if checked.faults else 0)


def _checked(path: Path, seconds: float | None) -> TeamFile:
    """Return the file with its faults, including conflicts with built-in versions."""
    settings = Settings()
    limits = Limits(seconds or settings.template_seconds, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB")
    worker = LocalProcesses(PRELOAD)
    try:
        file = TeamFiles.of_file(path, CheckInProcess(worker, limits))
    finally:
        worker.close()
    built_in = loaded(())
    return merged(built_in.templates, built_in.models, [file]).files[0]


def _print(path: Path, file: TeamFile) -> None:
    for fault in file.faults:
        place = f"{path}:{fault.line}" if fault.line else str(path)
        click.echo(f"{place}: {fault.what}\n    {fault.remedy}")
    if file.cls is not None and not file.faults:
        _summarise(file.cls)


def _summarise(cls: type[Template]) -> None:
    kind = "CAD model" if issubclass(cls, CadModel) else "template"
    click.echo(f"{cls.id} version {cls.version}, {kind}: {cls.title()}. No fault.")
    for title, declared in (("inputs", cls.inputs), ("outputs", cls.formulas)):
        click.echo(f"{len(declared)} {title}")
        for name, declaration in declared.items():
            click.echo(f"  {name:32} {declaration.meaning.unit}")
