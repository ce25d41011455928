"""Commands whose settings come from the environment: a wrong one is named, not where the program noticed."""

from __future__ import annotations

import click
from pydantic import ValidationError
from pydantic_core import ErrorDetails
from pydantic_settings import SettingsError


class SettableCommands(click.Group):
    """Commands that say which setting is wrong."""

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except SettingsError as error:
            message = f"{error}; a list is written as JSON, such as '[\"crank.example\"]'"
            raise click.ClickException(message) from None
        except ValidationError as error:
            raise click.ClickException("\n".join(map(_wrong_setting, error.errors()))) from None


def _wrong_setting(error: ErrorDetails) -> str:
    return f"CRANKWRIGHT_{str(error['loc'][0]).upper()}: {error['msg'].removeprefix('Value error, ')}"
