"""Response schemas for jobs."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer, Page
from app.schemas.problems import Problem

State = Literal["queued", "running", "done", "failed", "cancelled"]


class Job(Answer):
    """A job, the unit of long work."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    kind: str
    state: State
    design: str | None = Field(description="the design that the job belongs to")
    revision: int | None = Field(description="the revision of that design")
    progress: float = Field(ge=0, le=1)
    log: list[str] = Field(description="steps done so far, one line each")
    problem: Problem | None = Field(description="why the job failed; null if it did not")
    result: str | None = Field(description="link to the result of the job")
    created: str
    updated: str


class JobList(Page[Job]):
    """A page of jobs, newest first."""
