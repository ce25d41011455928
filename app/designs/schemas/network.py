"""The dependencies in a design, as the interface shows them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer


class NetworkBlock(Answer):
    """A parameter, step or model of a design, in its place in the order of calculation."""

    name: str
    kind: Literal["parameter", "step", "model"]
    column: int = Field(description="from 0; a block stands in a later column than all that drives it")


class NetworkRelation(Answer):
    """One name that a relation uses."""

    target: str = Field(description="what the relation sets, such as `model.inner_diameter`")
    source: str = Field(description="what it uses, such as `film.bearing_diameter`")
    relation: str = Field(description="as typed")
    forward: bool = Field(
        description="false where the source stands in the same or a later column: an iteration, or an input "
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
