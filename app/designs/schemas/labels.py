"""Labels of designs: tags, and whether a design is archived. Labels are not part of a revision."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from app.schemas.answers import Answer

MOST_TAGS = 20
TAG = r"^[^\x00-\x1f\x7f,]*[^\x00-\x20\x7f,][^\x00-\x1f\x7f,]*$"
"""One or more words without a comma, because commas separate the tags in a list."""

Tag = Annotated[str, Field(min_length=1, max_length=40, pattern=TAG, examples=["V8"])]


class Labels(Answer):
    """The labels of a design."""

    tags: list[str] = Field(description="in alphabetical order")
    archived: bool = Field(description="whether lists omit the design")


class TagUse(Answer):
    """A tag, and the number of designs that have it."""

    tag: str
    designs: int = Field(description="number of designs with this tag that are not archived")


class TagList(Answer):
    """Every tag in use, most used first."""

    items: list[TagUse]
