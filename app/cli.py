"""The command line: `crankwright serve | demo | study | sweep | impact | evaluate | template | …`.

The module of a command is imported when the command is called. So `crankwright --version` imports none, and
`evaluate` neither the service nor the geometry kernel.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module

import click

from app.settable import SettableCommands


@dataclass(frozen=True)
class OnDemand:
    """A command that is imported when it is called."""

    module: str
    attribute: str
    summary: str  # for the list of commands in `--help`

    def load(self) -> click.Command:
        """Import the command."""
        command = getattr(import_module(self.module), self.attribute)
        assert isinstance(command, click.Command)
        return command


COMMANDS = {
    "approve": OnDemand("app.approval_commands", "approve_command", "Take a step of an approval."),
    "audit": OnDemand("app.audit_commands", "audit_command", "List and verify who did what."),
    "backup": OnDemand("app.maintenance.commands", "backup_command", "Back up database and artifacts."),
    "check": OnDemand("app.maintenance.commands", "check_command", "Check database and artifacts."),
    "check-template": OnDemand(
        "app.catalogue.commands", "check_template_command", "Check the file of a template or model."
    ),
    "demo": OnDemand("app.demo_command", "demo_command", "Run the paper's demonstration."),
    "download": OnDemand("app.downloads", "download_command", "Save a file of a design."),
    "evaluate": OnDemand("app.template_commands", "evaluate_command", "Evaluate a template."),
    "freeze": OnDemand("app.template_commands", "freeze_command", "Write the golden record of a version."),
    "impact": OnDemand("app.impact_commands", "impact_command", "Try another version on every design."),
    "keys": OnDemand("app.key_commands", "keys_command", "Add, list and revoke keys."),
    "model": OnDemand("app.model_commands", "model_command", "Import models drawn by other programs."),
    "restore": OnDemand("app.maintenance.commands", "restore_command", "Restore a backup."),
    "scheduler": OnDemand("app.workers.remote.commands", "scheduler_command", "Pass jobs to workers."),
    "serve": OnDemand("app.serve_command", "serve_command", "Serve the REST interface and the pages."),
    "study": OnDemand("app.study_commands", "study_command", "Carry out a study of a design."),
    "sweep": OnDemand("app.study_commands", "sweep_command", "Calculate a design over a grid."),
    "template": OnDemand("app.template_commands", "template_command", "List and show templates."),
    "verify-report": OnDemand("app.approval_commands", "verify_report_command", "Verify a report (PDF)."),
    "worker": OnDemand("app.workers.remote.commands", "worker_command", "Run jobs of a scheduler."),
    "worksheet": OnDemand("app.worksheet_commands", "worksheet_command", "Manage templates written as text."),
}


class Commands(SettableCommands):
    """All commands, each imported when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, sorted."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is no such command."""
        return COMMANDS[cmd_name].load() if cmd_name in COMMANDS else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands by their summaries, without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, COMMANDS[name].summary) for name in self.list_commands(ctx)])


@click.group(cls=Commands)
@click.version_option(package_name="crankwright")
def main() -> None:
    """Engine-bearing calculations that drive geometry."""
