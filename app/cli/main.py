"""The command line: `crankwright serve | demo | study | sweep | impact | evaluate | template | …`.

The module of a command is imported only when the command runs. Therefore `crankwright --version` imports no
command, and `evaluate` imports neither the service nor the geometry kernel.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails


class SettableCommands(click.Group):
    """A group of commands that reports a wrong setting of the environment without a traceback."""

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except ValueError as error:
            if message := _wrong_settings(error):
                raise click.ClickException(message) from None
            raise


def _wrong_settings(error: ValueError) -> str:
    """Return a sentence about wrong settings; it is empty if the error is not about settings."""
    # Pydantic is imported here because commands without settings, such as `--version`, do not need it.
    from pydantic import ValidationError
    from pydantic_settings import SettingsError

    if isinstance(error, SettingsError):
        return f"{error}; a list is written as JSON, such as '[\"crank.example\"]'"
    if isinstance(error, ValidationError):
        return "\n".join(map(_wrong_setting, error.errors()))
    return ""


def _wrong_setting(error: ErrorDetails) -> str:
    return f"CRANKWRIGHT_{str(error['loc'][0]).upper()}: {error['msg'].removeprefix('Value error, ')}"


@dataclass(frozen=True)
class OnDemand:
    """A command that is imported when it runs."""

    module: str
    attribute: str
    summary: str  # shown in the list of commands by `--help`

    def load(self) -> click.Command:
        """Import the command."""
        command = getattr(import_module(self.module), self.attribute)
        assert isinstance(command, click.Command)
        return command


COMMANDS = {
    "accept": OnDemand("app.cli.maintenance", "accept_command", "Accept a database that was replaced."),
    "approve": OnDemand("app.cli.approvals", "approve_command", "Take a step of an approval."),
    "audit": OnDemand("app.cli.audit", "audit_command", "List and verify who did what."),
    "backup": OnDemand("app.cli.maintenance", "backup_command", "Back up database and artifacts."),
    "check": OnDemand("app.cli.maintenance", "check_command", "Check database and artifacts."),
    "check-template": OnDemand(
        "app.cli.check_template", "check_template_command", "Check the file of a template or model."
    ),
    "demo": OnDemand("app.cli.demo", "demo_command", "Run the paper's demonstration."),
    "download": OnDemand("app.cli.download", "download_command", "Save a file of a design."),
    "evaluate": OnDemand("app.cli.templates", "evaluate_command", "Evaluate a template."),
    "freeze": OnDemand("app.cli.templates", "freeze_command", "Write the golden record of a version."),
    "impact": OnDemand("app.cli.impact", "impact_command", "Try another version on every design."),
    "keys": OnDemand("app.cli.keys", "keys_command", "Add, list and revoke keys."),
    "mcp": OnDemand("app.cli.agents", "mcp_command", "Serve tools for agents (MCP)."),
    "model": OnDemand("app.cli.models", "model_command", "Import models drawn by other programs."),
    "restore": OnDemand("app.cli.maintenance", "restore_command", "Restore a backup."),
    "scheduler": OnDemand("app.cli.workers", "scheduler_command", "Pass jobs to workers."),
    "serve": OnDemand("app.cli.serve", "serve_command", "Serve the REST interface and the pages."),
    "skill": OnDemand("app.cli.agents", "skill_command", "Print the skill for agents."),
    "stamp-keys": OnDemand("app.cli.stamps", "stamp_keys_command", "List and replace keys of stamps."),
    "study": OnDemand("app.cli.studies", "study_command", "Carry out a study of a design."),
    "sweep": OnDemand("app.cli.studies", "sweep_command", "Calculate a design over a grid."),
    "template": OnDemand("app.cli.templates", "template_command", "List and show templates."),
    "verify": OnDemand("app.cli.stamps", "verify_command", "Verify the stamp of a STEP or GLB file."),
    "verify-report": OnDemand("app.cli.approvals", "verify_report_command", "Verify a report (PDF)."),
    "worker": OnDemand("app.cli.workers", "worker_command", "Run jobs of a scheduler."),
    "worksheet": OnDemand("app.cli.worksheets", "worksheet_command", "Manage templates written as text."),
}


class Commands(SettableCommands):
    """All commands, each imported when it runs."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, sorted."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is no such command."""
        return COMMANDS[cmd_name].load() if cmd_name in COMMANDS else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands with their summaries, without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, COMMANDS[name].summary) for name in self.list_commands(ctx)])


@click.group(cls=Commands)
@click.version_option(package_name="crankwright")
def main() -> None:
    """Engine-bearing calculations that drive geometry."""
