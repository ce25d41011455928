"""Curves read from a table of comma-separated values."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Values


class Curves(Answer):
    """The columns of a table, each a quantity that an input can take."""

    curves: dict[str, Values] = Field(description="by the name of the column")
    assumed: list[str] = Field(
        [],
        description="what was assumed: the decimal mark, the letters of the file, cycles that were averaged",
    )
