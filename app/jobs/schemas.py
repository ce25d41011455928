"""Jobs as the API shows them."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from app.jobs.job import State


class JobOut(BaseModel):
    """A piece of long work."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    kind: str
    state: State
    design: str | None = Field(description="the design it works for")
    revision: int | None = Field(description="the revision of that design")
    progress: float = Field(ge=0, le=1)
    log: list[str] = Field(description="what it has done, one line a step")
    problem: dict[str, Any] | None = Field(description="why it failed (RFC 9457)")
    result: str | None = Field(description="link to what it has made")
    created: str
    updated: str


class JobList(BaseModel):
    """A page of jobs, newest first."""

    items: list[JobOut]
    next: str | None = Field(description="cursor of the next page")
