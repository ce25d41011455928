"""The request body for the impact of a version."""

from __future__ import annotations

from typing import Annotated

from pydantic import ConfigDict, Field, StringConstraints

from app.designs.schemas.labels import MOST_TAGS, Tag
from app.schemas.bounds import Bounded

MOST_SHOWN = 1000
PRINTABLE = r"^[^\x00-\x1f\x7f]*$"


class ImpactIn(Bounded):
    """The designs to compare, and how many of them the answer lists."""

    model_config = ConfigDict(
        strict=True, extra="forbid", json_schema_extra={"examples": [{"tags": ["main"], "limit": 50}]}
    )

    designs: (
        Annotated[list[Annotated[str, StringConstraints(max_length=64)]], Field(max_length=10_000)] | None
    ) = Field(None, description="ids of the designs to compare; by default all that use another version")
    name: Annotated[str, StringConstraints(max_length=200, pattern=PRINTABLE)] | None = Field(
        None, description="part of the design's name; case does not matter"
    )
    tags: Annotated[list[Tag], Field(max_length=MOST_TAGS)] = Field(
        [], description="tags, all of which a design must have"
    )
    limit: Annotated[int, Field(ge=1, le=MOST_SHOWN)] = Field(
        100, description="largest number of designs in the answer"
    )
