"""Schema of curves that were read from a table file."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Values


class Curves(Answer):
    """The columns of a table, each as a quantity that an input accepts."""

    curves: dict[str, Values] = Field(description="curves by the name of their column")
    assumed: list[str] = Field(
        [],
        description="assumptions made: decimal mark, encoding of the file, averaging of cycles",
    )
