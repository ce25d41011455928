"""`crankwright impact`: show how a new version of a template would change the designs with an old one."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from app.cli.connections import connected, data_option, url_option
from app.impact.schemas import CriterionChange, DesignImpact, Impact
from app.presentation import numbers


@click.command("impact")
@click.argument("template")
@click.argument("version", type=click.IntRange(1, 10**6))
@click.option("--name", default=None, help="only designs whose name contains this text")
@click.option("--tag", "tags", multiple=True, help="only designs with this tag (repeatable)")
@click.option("--limit", default=20, type=click.IntRange(1, 1000), help="largest number of designs listed")
@click.option("--json", "as_json", is_flag=True, help="the whole answer as JSON")
@url_option
@data_option
def impact_command(
    template: str,
    version: int,
    name: str | None,
    tags: tuple[str, ...],
    limit: int,
    as_json: bool,
    url: str | None,
    data: Path | None,
) -> None:
    """Show how designs that use another version of TEMPLATE would change with VERSION, worst first.

    Nothing is saved. An upgrade is a new revision: PATCH /api/v1/designs/{id}, or the button on its page.
    """
    with (
        connected(url, data) as client,
        click.progressbar(length=1000, label="designs", file=sys.stderr) as bar,
    ):
        done = 0

        def update(fraction: float, text: str) -> None:
            nonlocal done
            bar.update(max(0, int(1000 * fraction) - done))
            done = max(done, int(1000 * fraction))

        impact = client.impact(template, version, name=name, tags=tags, limit=limit, on_progress=update)
        bar.update(1000 - done)
    if as_json:
        click.echo(json.dumps(impact.plain(), indent=2, ensure_ascii=False))
    else:
        _print(impact)


def _print(impact: Impact) -> None:
    """Print the counts, then a line for each design."""
    counts = f"{impact.moved} move, {impact.refused} refuse it, {impact.unchanged} stay as they are"
    solids = f", {impact.needs_solids} need solids" if impact.needs_solids else ""
    archived = f" ({impact.archived} archived ones are left out)" if impact.archived else ""
    click.echo(f"{impact.concerned} designs use another version{archived}: {counts}{solids}")
    for one in impact.designs:
        click.echo(f"{one.design}  {one.name}, revision {one.revision}: {_line(one)}")


def _moved(verdict: CriterionChange) -> str:
    """Return a criterion whose verdict changes, as in `film.film of main_1 met → not met`."""
    variant = f" of {verdict.variant}" if verdict.variant else ""
    words = f"{verdict.old or 'none'} → {verdict.new or 'none'}".replace("_", " ")
    return f"{verdict.name}{variant} {words}"


def _line(one: DesignImpact) -> str:
    """Return the effect on a design as one short line."""
    if one.effect == "refused":
        return f"refused: {'; '.join(f'{fault.name}: {fault.detail}' for fault in one.refusals[:3])}"
    parts = [_moved(verdict) for verdict in one.verdicts[:3]]
    if one.margin:
        share = f" ({numbers.percent(one.margin.relative)})" if one.margin.relative is not None else ""
        parts.append(f"{one.margin.name} loses {numbers.in_line(one.margin.lost)} of margin{share}")
    if one.output and one.output.change is not None:
        sign = "+" if one.output.change > 0 else "−"
        parts.append(f"{one.output.name} {sign}{numbers.percent(abs(one.output.change))}")
    if one.parameters:
        parts.append(f"{len(one.parameters)} CAD parameters change")
    if one.needs_solids:
        parts.append(f"needs solids for {', '.join(one.needs_solids[:3])}")
    return "; ".join(parts) or f"{', '.join(one.gone[:3])} gone"
