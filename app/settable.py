"""Commands whose settings come from the environment: a wrong one is named, not where the program noticed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails


class SettableCommands(click.Group):
    """Commands that say which setting is wrong."""

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except ValueError as error:
            if message := _wrong_settings(error):
                raise click.ClickException(message) from None
            raise


def _wrong_settings(error: ValueError) -> str:
    """A sentence on wrong settings; empty for another error."""
    # Pydantic is imported here: a command without settings, such as `--version`, does without it.
    from pydantic import ValidationError
    from pydantic_settings import SettingsError

    if isinstance(error, SettingsError):
        return f"{error}; a list is written as JSON, such as '[\"crank.example\"]'"
    if isinstance(error, ValidationError):
        return "\n".join(map(_wrong_setting, error.errors()))
    return ""


def _wrong_setting(error: ErrorDetails) -> str:
    return f"CRANKWRIGHT_{str(error['loc'][0]).upper()}: {error['msg'].removeprefix('Value error, ')}"
