"""Response models of fields on the surfaces of solids."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer


class SolidField(Answer):
    """A field that can be shown on a solid."""

    id: str = Field(description="id in the address of its files, such as `life.load_use`")
    title: str
    unit: str
    low: float = Field(description="the value of the first colour, violet")
    high: float = Field(description="the value of the last colour, yellow")
    glb: str = Field(description="address of the solid with the field as vertex colours")
    png: str = Field(description="address of a picture of the field")


class SolidFieldList(Answer):
    """The fields of a model; empty if no step uses finite-element results of it."""

    items: list[SolidField]
