"""`crankwright study | sweep`: calculate many variations of a design, by a service or on a data folder."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import IO

import click

from app.cli.connections import connected, data_option, url_option
from app.client import Client
from app.client.studies import ClientStudy, Kind
from app.plain import JsonObject
from app.studies.schemas import Study

_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_INTERVAL = re.compile(rf"({_NUMBER})\s*([^.]*?)\s*\.\.\s*({_NUMBER})\s*(.*?)/([0-9]{{1,7}})")
_VALUE = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*")
MOST_OUTPUTS = 50
KINDS: dict[str, Kind] = {".csv": "csv", ".xlsx": "xlsx", ".npz": "npz"}

_out = click.option(
    "--out", type=click.Path(dir_okay=False, path_type=Path), help="file for the rows: .csv, .xlsx or .npz"
)


_variant = click.option("--variant", help="variant to study; the design itself if not given")


@click.command("study")
@click.argument("file", type=click.File("r", encoding="utf-8"))
@_variant
@_out
@url_option
@data_option
def study_command(
    file: IO[str], variant: str | None, out: Path | None, url: str | None, data: Path | None
) -> None:
    """Run the study in FILE, a JSON body for POST /api/v1/studies, and print its result.

    FILE may be - for the standard input.
    """
    kind = _kind(out)
    try:
        body: JsonObject = json.load(file)
        design = str(body.pop("design"))
    except (ValueError, KeyError, AttributeError, TypeError):
        raise click.ClickException('FILE is not a JSON object with a "design"') from None
    body |= {"variant": variant} if variant else {}
    with connected(url, data) as client:
        study = client.study(design, **body)
        shown = _followed(study)
        if out is not None:
            _save(study, kind, out)
    click.echo(json.dumps(shown.plain(), indent=2, ensure_ascii=False))


@click.command("sweep")
@click.argument("design")
@click.argument("vary", nargs=-1, required=True, metavar="NAME=A..B/STEPS…")
@click.option(
    "--output",
    "outputs",
    multiple=True,
    help="output to list, as step.output (repeatable); default: all single values",
)
@_variant
@_out
@url_option
@data_option
def sweep_command(
    design: str,
    vary: tuple[str, ...],
    outputs: tuple[str, ...],
    variant: str | None,
    out: Path | None,
    url: str | None,
    data: Path | None,
) -> None:
    """Calculate DESIGN (an id) over a grid, for example: crankwright sweep ID clearance=0.03..0.09mm/41.

    Separate single values by commas: width=18,20mm. The rows go to the standard output, or with --out to a
    file.
    """
    kind, varied = _kind(out), dict(_varied(text) for text in vary)
    steps = {name: count for name, (_, count) in varied.items() if count}
    body: JsonObject = {"method": "grid", "vary": {name: entry for name, (entry, _) in varied.items()}}
    body |= {"steps": steps} if steps else {}
    body |= {"variant": variant} if variant else {}
    with connected(url, data) as client:
        body["outputs"] = list(outputs) or _single_outputs(client, design)
        study = client.study(design, **body)
        _followed(study)
        if out is not None:
            _save(study, kind, out)
        else:
            click.echo(study.file("csv").content.decode(), nl=False)


def _varied(text: str) -> tuple[str, tuple[JsonObject, int]]:
    """Return the name of a varied quantity, its values, and an interval's number of steps (0 for a list)."""
    name, sign, what = text.partition("=")
    if match := _INTERVAL.fullmatch(what.strip()):
        low, low_unit, high, unit, steps = match.groups()
        bounds = [f"{low} {low_unit or unit}".strip(), f"{high} {unit}".strip()]
        return name.strip(), ({"between": bounds}, int(steps))
    items = [_VALUE.fullmatch(item) for item in what.split(",")]
    if not sign or not all(items):
        message = f"{text!r} is neither NAME=A..B/STEPS, such as clearance=0.03..0.09mm/41, nor NAME=A,B,C"
        raise click.BadParameter(message)
    unit = next((item[2] for item in reversed(items) if item and item[2]), "")
    values = [f"{item[1]} {item[2] or unit}".strip() for item in items if item]
    return name.strip(), ({"values": values}, 0)


def _single_outputs(client: Client, design: str) -> list[str]:
    """Return the outputs of the newest revision that are single values."""
    newest = client.revision(design, client.design(design).revision)
    names = [
        f"{step}.{name}"
        for step, shown in newest.steps.items()
        for name, output in shown.outputs.items()
        if isinstance(output.value, float)
    ]
    if not 0 < len(names) <= MOST_OUTPUTS:
        raise click.ClickException(
            f"the design has {len(names)} single outputs; name some with --output step.name"
        )
    return names


def _followed(study: ClientStudy) -> Study:
    """Return the study once it has ended; meanwhile show its progress as a bar on a terminal."""
    shown = study.study
    seconds, solids = shown.estimate.seconds, shown.estimate.solids
    cost = [f"about {seconds:.2g} s"] * (seconds is not None) + [f"{solids} solids to build"] * bool(solids)
    click.echo(", ".join([f"study {study.id}: {shown.rows} rows", *cost]), err=True)
    with click.progressbar(length=1000, label="rows", file=sys.stderr) as bar:
        done = 0

        def update(fraction: float, text: str) -> None:
            nonlocal done
            bar.update(max(0, int(1000 * fraction) - done))
            done = max(done, int(1000 * fraction))

        ended = study.wait(update)
        bar.update(1000 - done)
    for reason, count in ended.refused.reasons.items():
        click.secho(f"{count} rows refused: {reason}", fg="yellow", err=True)
    return ended


def _kind(out: Path | None) -> Kind:
    if out is None:
        return "csv"
    if out.suffix.lower() not in KINDS:
        raise click.BadParameter(f"{out.name} ends with none of {', '.join(KINDS)}")
    return KINDS[out.suffix.lower()]


def _save(study: ClientStudy, kind: Kind, out: Path) -> None:
    try:
        out.write_bytes(study.file(kind).content)
    except OSError as error:
        raise click.ClickException(f"{out} cannot be written: {error.strerror}") from None
    click.echo(f"written: {out}", err=True)
