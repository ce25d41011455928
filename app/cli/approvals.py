"""`crankwright approve` and `crankwright verify-report`."""

from __future__ import annotations

from pathlib import Path

import click

from app.approvals.schemas import Block
from app.cli.connections import connected, data_option, url_option
from app.client import Client
from app.reports.verification import Line, NotReport, read_block, verify
from app.schemas.approval_steps import ORDER, Step
from templates.core.errors import plain


@click.command("approve")
@click.argument("design")
@click.option("--revision", type=click.IntRange(1), required=True)
@click.option("--step", type=click.Choice(ORDER), required=True)
@click.option("--reason", default=None, help="reason for a withdrawal; required there")
@click.option("--acknowledge", default=None, help="why unconfirmed criteria are acceptable")
@url_option
@data_option
def approve_command(
    design: str,
    revision: int,
    step: Step,
    reason: str | None,
    acknowledge: str | None,
    url: str | None,
    data: Path | None,
) -> None:
    """Take a step of the approval of a revision of DESIGN: calculated, checked, released or withdrawn."""
    with connected(url, data) as client:
        signed = client.approve(client.approvals(design, revision), step, reason, acknowledged=acknowledge)
    last = signed.steps[-1]
    click.echo(
        plain(f"revision {revision}: {last.step} by {last.name} at {last.at}, digest {last.digest}", 500)
    )


@click.command("verify-report")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@url_option
@data_option
@click.pass_context
def verify_report_command(ctx: click.Context, file: Path, url: str | None, data: Path | None) -> None:
    """Verify FILE, a report (PDF), against the service that has the revision.

    The command prints the result of each check: every signature, that the revision is unchanged since it was
    signed, that it is released, and that the pages equal those that the service prints. The exit code is 1
    if a check fails.
    """
    pdf = file.read_bytes()
    try:
        block = read_block(pdf)
    except ImportError:
        raise click.ClickException("this needs pypdf: pip install 'crankwright[team]'") from None
    except NotReport as error:
        raise click.ClickException(f"{file}: {error}") from None
    click.echo(f"report of revision {block.revision} of design {block.design}")
    with connected(url, data) as client:
        lines = _verified(client, pdf, block)
    for line in lines:
        click.secho(("holds  " if line.holds else "FAILS  ") + line.words, fg=None if line.holds else "red")
    ctx.exit(0 if all(line.holds for line in lines) else 1)


def _verified(client: Client, pdf: bytes, block: Block) -> list[Line]:
    approvals = client.approvals(block.design, block.revision)
    printed = client.report(
        block.design,
        revision=block.revision,
        units=block.units,
        variants=block.has_variants,
        appendix=block.has_appendix,
    )
    return list(verify(pdf, block, approvals, printed))
