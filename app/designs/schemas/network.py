"""Response models of the dependencies in a design."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer


class NetworkBlock(Answer):
    """A parameter, step or model of a design, and its column in the order of calculation."""

    name: str
    kind: Literal["parameter", "step", "model"]
    column: int = Field(
        description="counted from 0; a block is in a later column than all blocks on which it depends"
    )


class NetworkRelation(Answer):
    """One name that a relation uses."""

    target: str = Field(description="the value that the relation sets, such as `model.inner_diameter`")
    source: str = Field(description="the value that the relation uses, such as `film.bearing_diameter`")
    relation: str = Field(description="as typed")
    forward: bool = Field(
        description="false if the source is in the same or a later column: an iteration, or an input "
        "of a block that is calculated later"
    )


class NetworkName(Answer):
    """A name that relations of the design may use."""

    name: str
    role: Literal["parameter", "input", "output", "measure"]
    words: str
    unit: str = Field(description="1 for a pure number")
    dimension: str = Field(
        description="equal for quantities of the same kind, such as a length in mm or inch"
    )


class DesignNetwork(Answer):
    """The dependencies in a design, and the names that its relations may use."""

    blocks: list[NetworkBlock] = Field(description="in the order of calculation")
    relations: list[NetworkRelation]
    names: list[NetworkName]
    table: list[str] = Field(
        description="values that the table of results shows: the chosen columns, else the main results"
    )
