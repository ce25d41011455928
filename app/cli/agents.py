"""`crankwright mcp` and `crankwright skill`: tools for agents, and the text that teaches their use."""

from __future__ import annotations

import click

from app.cli.connections import key_of_user
from app.settings import Settings

URL = "CRANKWRIGHT_URL"
MISSING = "the package mcp is missing: pip install 'crankwright[agents]'"


@click.command("mcp")
@click.option("--url", envvar=URL, default=None, help="address of the service; default: this machine")
@click.option("--http", "over_http", is_flag=True, help="serve streamable HTTP at /mcp instead of stdio")
@click.option("--host", default="127.0.0.1", show_default=True, help="address to listen on, with --http")
@click.option("--port", default=8001, show_default=True, type=click.IntRange(0, 65535), help="with --http")
def mcp_command(url: str | None, over_http: bool, host: str, port: int) -> None:
    """Serve tools for agents by the Model Context Protocol; they call a running service.

    Over stdio, CRANKWRIGHT_KEY is the key. Over HTTP, each request brings its own: Authorization: Bearer.
    """
    settings = Settings()
    place = url or f"http://127.0.0.1:{settings.port}"
    try:
        from app.agents.server import serve_stdio
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("mcp", "mcp_types"):
            raise
        raise click.ClickException(MISSING) from None
    if over_http:
        from app.agents.http import serve_http  # imports the web framework, which stdio does not need

        click.echo(f"MCP at http://{host}:{port}/mcp, for the service at {place}", err=True)
        serve_http(place, host, port, settings.allowed_hosts)
    else:
        serve_stdio(place, key_of_user())


@click.command("skill")
def skill_command() -> None:
    """Print the skill: how an agent calculates, finds a part that meets requirements, and proves it."""
    from app.agents.skill import skill

    click.echo(skill(), nl=False)
