"""Jobs as the interface shows them."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer, Page
from app.schemas.problems import Problem

State = Literal["queued", "running", "done", "failed", "cancelled"]


class Job(Answer):
    """A piece of long work."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    kind: str
    state: State
    design: str | None = Field(description="the design it works for")
    revision: int | None = Field(description="the revision of that design")
    progress: float = Field(ge=0, le=1)
    log: list[str] = Field(description="what it has done, one line a step")
    problem: Problem | None = Field(description="why it failed")
    result: str | None = Field(description="link to its result")
    created: str
    updated: str


class JobList(Page[Job]):
    """A page of jobs, newest first."""
