"""Answers of `decide`: the decided criteria, and the work that this took."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity
from app.schemas.criteria import Criterion, Verdict


class LevelTrial(Answer):
    """A step at one level."""

    step: str
    level: str
    rows: int = Field(0, description="points that were calculated")
    seconds: float = Field(0.0, description="time that they took, in s")
    expected: float = Field(0.0, description="time that was estimated before, in s")
    decided: list[str] = Field([], description="criteria that it decided")
    reason: str | None = Field(None, description="why it was left out, or of no use")


class Decision(Answer):
    """Criteria of a design, decided as far as the levels of its steps go; nothing is saved."""

    revision: int = Field(description="the revision that was judged")
    criteria: list[Criterion] = Field(description="all of them, worst first")
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")
    asked: list[str] = Field(
        description="of those wanted, the criteria that were undecided, or whose error a level would state"
    )
    undecided: list[str] = Field(description="those that still are undecided")
    error_unknown: list[str] = Field([], description="those that follow from values of unknown error")
    tried: list[LevelTrial] = Field(description="what was calculated, in order")
    skipped: list[LevelTrial] = Field(description="levels that were left out, and why")
    seconds: float = Field(description="time that all levels took, in s")
    budget: Quantity
    stopped: Literal["decided", "no_finer_level", "budget", "pending"] = Field(
        description="`no_finer_level`: no level states a smaller error of the same truth; "
        "`pending`: a level is still calculated"
    )
