"""Fields on the surfaces of solids as the interface shows them."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer


class SolidField(Answer):
    """A field that can be painted on a solid."""

    id: str = Field(description="as in the address of its files, such as `life.load_use`")
    title: str
    unit: str
    low: float = Field(description="the value of the first colour, violet")
    high: float = Field(description="the value of the last colour, yellow")
    glb: str = Field(description="address of the solid with the field as colours of its corners")
    png: str = Field(description="address of a picture of it")


class SolidFieldList(Answer):
    """The fields of a model; none where no step follows from finite elements of it."""

    items: list[SolidField]
