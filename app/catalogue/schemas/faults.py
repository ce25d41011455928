"""Files of a team's templates and models that have faults."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Page


class FileFault(Answer):
    """One fault of a file."""

    code: str = Field(description="`syntax`, `dimensions`, `cycle`, `example`, … : one word for programs")
    line: int | None = Field(description="the line of the file; null where the fault has none")
    what: str = Field(description="what is wrong")
    remedy: str = Field(description="what would be right")
    quarantines: bool = Field(description="false: it is reported, and the version is used all the same")


class FaultyFile(Answer):
    """A file of a team's folder with everything that is wrong with it."""

    file: str = Field(description="the file within its folder, the name of the folder first")
    id: str | None = Field(description="from the file's name; null where that is not a name of a version")
    version: int | None
    quarantined: bool = Field(description="whether the version cannot be used")
    digest: str = Field(description="SHA-256 of the file and of those beside it that belong to it")
    faults: list[FileFault]


class FaultList(Page[FaultyFile]):
    """Files with faults, in the order of the folders and of their names."""
