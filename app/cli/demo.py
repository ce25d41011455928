"""`crankwright demo`: run the paper's demonstration, in one process or with all processes of a team."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.demonstration import demonstrate
from app.settings import Settings


@click.command("demo")
@click.option(
    "--data", type=click.Path(path_type=Path), default=None, help="data folder; default: that of `serve`"
)
@click.option("--team", is_flag=True, help="run on PostgreSQL, S3, Dask and two servers; nothing is kept")
def demo_command(data: Path | None, team: bool) -> None:
    """Run the paper's demonstration: SCALE and D drive a ball bearing from 50 mm to 48 mm.

    The design is kept, and `crankwright serve` shows it; with --team, nothing is kept.
    """
    if not team:
        demonstrate(data or Settings().data)
        return
    if data is not None:
        raise click.UsageError("--team stores nothing, so it takes no --data")
    from app.cli.team_demonstration import demonstrate_team

    demonstrate_team()
