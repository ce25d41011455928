"""Response schemas for models that a team has imported."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer


class ImportedParameter(Answer):
    """A parameter's location in the imported file, and how the solid shows it."""

    name: str
    unit: str
    value: float = Field(description="value in the original file, in `unit`")
    source: str = Field(description="object, kind and name in the file: `Sizes.cell.bore`")
    read_back: str | None = Field(
        description="`diameter`, `radius` or `distance`: the size of every solid that is compared with it"
    )
    moves: str | None = Field(
        None,
        description="what a trial at the import changed on the solids; `nothing` if it changed none; null if "
        "there was no trial",
    )


class ModelOrigin(Answer):
    """The origin of an imported model, and how far its solids can be trusted."""

    program: str = Field(description="program that draws it: `freecad`, `creo`, `step` or `assembly`")
    file: str = Field(description="name of the original file")
    sha256: str = Field(description="SHA-256 of the original file, which is kept")
    made_with: str = Field(description="program and version that examined the file")
    trust: str = Field(description="which checks its solids pass, and which are not made")
    findings: list[str] = Field(
        [],
        description="what the examination at the import found, as sentences: changes of volume, loose faces, "
        "overlaps, new names, and what was left out",
    )
    ends: list[str] = Field(
        [], description="objects of a FreeCAD document that are its parts; every drawing must have the same"
    )
    author: str | None = None
    created: str
    parameters: list[ImportedParameter]


class DrawingProgram(Answer):
    """A program that draws imported models, and whether it is installed."""

    name: str
    files: str = Field(description="kinds of files that it accepts")
    available: bool
    detail: str = Field(description="where it is installed, or why it cannot be used and how to install it")


class DrawingPrograms(Answer):
    """The programs that draw imported models."""

    items: list[DrawingProgram]
