"""Files of a team's templates and models that have faults."""

from __future__ import annotations

from pydantic import Field

from app.schemas.answers import Answer, Page


class FileFault(Answer):
    """One fault of a file."""

    code: str = Field(
        description="machine-readable kind of fault: `syntax`, `dimensions`, `cycle`, `example`, …"
    )
    line: int | None = Field(description="line in the file; null if the fault has no line")
    what: str = Field(description="what is wrong")
    remedy: str = Field(description="how to correct it")
    quarantines: bool = Field(description="false if the fault is only reported and the version stays usable")


class FaultyFile(Answer):
    """A file of a team's folder, with all its faults."""

    file: str = Field(description="name of the folder and path of the file in it")
    id: str | None = Field(description="id from the file's name; null if the name is not that of a version")
    version: int | None
    quarantined: bool = Field(description="whether the version cannot be used")
    digest: str = Field(description="SHA-256 of the file and its accompanying files")
    faults: list[FileFault]


class FaultList(Page[FaultyFile]):
    """A page of files with faults, sorted by folder and name."""
