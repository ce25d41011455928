"""Answers of `decide`: the decided criteria, and the work that this took."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity
from app.schemas.criteria import Criterion, Verdict

Stopped = Annotated[
    Literal["decided", "no_finer_level", "budget", "pending", "estimated"],
    Field(
        description="`no_finer_level`: no level states a smaller error of the same truth; "
        "`pending`: a level is still calculated; `estimated`: nothing was, as asked"
    ),
]


class LevelTrial(Answer):
    """A step at one level."""

    variant: str | None = Field(None, description="the variant that was calculated; absent for the design")
    step: str
    level: str
    rows: int = Field(0, description="points that were calculated")
    seconds: float = Field(0.0, description="time that they took, in s")
    expected: float = Field(0.0, description="time that was estimated before, in s")
    decided: list[str] = Field([], description="criteria that it decided")
    reason: str | None = Field(None, description="why it was left out, or of no use")


class VariantDecision(Answer):
    """Criteria of one variant, decided as far as the levels of its steps go."""

    name: str
    criteria: list[Criterion] = Field(description="all of them, worst first")
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")
    asked: list[str] = Field(description="criteria that were undecided, or whose error a level would state")
    undecided: list[str] = Field(description="those that still are undecided")
    error_unknown: list[str] = Field(description="those that follow from values of unknown error")
    stopped: Stopped


class Decision(Answer):
    """Criteria of a design and its variants, decided as far as the levels of its steps go.

    Nothing is saved.
    """

    revision: int = Field(description="the revision that was judged")
    criteria: list[Criterion] = Field(
        description="all of them, worst first; with variants each at the worst of the design and its variants"
    )
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")
    variants: list[VariantDecision] = Field([], description="the same of every variant that was calculated")
    asked: list[str] = Field(
        description="of those wanted, the criteria that were undecided, or whose error a level would state"
    )
    undecided: list[str] = Field(description="those that still are undecided")
    error_unknown: list[str] = Field([], description="those that follow from values of unknown error")
    tried: list[LevelTrial] = Field(description="what was calculated, in order")
    skipped: list[LevelTrial] = Field(description="levels that were left out, and why")
    seconds: float = Field(description="time that all levels took, in s")
    planned: list[LevelTrial] = Field(
        [], description="with `estimate_only`, the level that would be calculated first of each design"
    )
    expected: float = Field(0.0, description="processor time that is estimated for these, in s")
    budget: Quantity
    stopped: Stopped
