"""Models that a team has imported, as the interface shows them."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer


class ImportedParameter(Answer):
    """The place of a parameter in its file, and whether the solid shows it."""

    name: str
    unit: str
    value: float = Field(description="in the file as it was sent, in `unit`")
    source: str = Field(description="object, kind and name in the file: `Sizes.cell.bore`")
    read_back: str | None = Field(
        description="`diameter`, `radius` or `distance`: as what it is read back from every solid and checked"
    )


class ModelOrigin(Answer):
    """The origin of an imported model, and how far its solids are to be trusted."""

    program: str = Field(description="`freecad`, `creo`, `step` or `assembly`")
    file: str = Field(description="the name under which it was sent")
    sha256: str = Field(description="of the file as it was sent, which is kept")
    made_with: str = Field(description="the program and version that examined it")
    trust: str = Field(description="which checks its solids pass, and which they do not have")
    author: str | None = None
    created: str
    parameters: list[ImportedParameter]


class DrawingProgram(Answer):
    """A program that draws imported models, and whether it is here."""

    name: str
    files: str = Field(description="what it takes")
    available: bool
    detail: str = Field(description="where it is; or why it cannot be used, and how to install it")


class DrawingPrograms(Answer):
    """The programs that draw imported models."""

    items: list[DrawingProgram]
