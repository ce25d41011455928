"""Response models of `decide`: the decided criteria, and the levels that were calculated."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity
from app.schemas.criteria import Criterion, Verdict

Stopped = Annotated[
    Literal["decided", "no_finer_level", "budget", "pending", "estimated"],
    Field(
        description="`no_finer_level`: no level states a smaller error against the same reference; "
        "`pending`: a level is still being calculated; `estimated`: nothing was calculated, as requested"
    ),
]


class LevelTrial(Answer):
    """A step calculated, or to be calculated, at one level."""

    variant: str | None = Field(None, description="the variant that was calculated; absent for the design")
    step: str
    level: str
    rows: int = Field(0, description="number of calculated points")
    seconds: float = Field(0.0, description="calculation time, in s")
    expected: float = Field(0.0, description="estimated calculation time, in s")
    decided: list[str] = Field([], description="criteria that this level decided")
    reason: str | None = Field(None, description="why the level was skipped, or was of no use")


class VariantDecision(Answer):
    """The criteria of one variant after refinement of the levels of its steps."""

    name: str
    criteria: list[Criterion] = Field(description="all criteria, worst first")
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent without criteria")
    asked: list[str] = Field(description="criteria that a finer level might decide")
    undecided: list[str] = Field(description="criteria that are still undecided")
    error_unknown: list[str] = Field(description="criteria that depend on values of unknown error")
    stopped: Stopped


class Decision(Answer):
    """The criteria of a design and its variants after refinement of the levels of their steps.

    Nothing is saved.
    """

    revision: int = Field(description="the revision that was judged")
    criteria: list[Criterion] = Field(
        description="all criteria, worst first; with variants, each as judged for the worst variant"
    )
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent without criteria")
    variants: list[VariantDecision] = Field([], description="decisions for the calculated variants")
    asked: list[str] = Field(description="requested criteria that a finer level might decide")
    undecided: list[str] = Field(description="criteria that are still undecided")
    error_unknown: list[str] = Field([], description="criteria that depend on values of unknown error")
    tried: list[LevelTrial] = Field(description="calculated levels, in order")
    skipped: list[LevelTrial] = Field(description="skipped levels, with reasons")
    seconds: float = Field(description="total calculation time, in s")
    planned: list[LevelTrial] = Field(
        [], description="with `estimate_only`, the first level to calculate for the design and each variant"
    )
    expected: float = Field(0.0, description="estimated processor time of the planned levels, in s")
    budget: Quantity
    stopped: Stopped
