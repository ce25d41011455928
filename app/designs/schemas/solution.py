"""Response models of `solve` for designs: values of the unknown that reach the target, and the curve."""

from __future__ import annotations

from pydantic import Field

from app.calculations.schemas.evaluations import Root, Solved
from app.schemas.answers import Measured, Shown
from app.schemas.criteria import Word


class DesignRoot(Root):
    """A value of the unknown that gives the target, and the verdicts of the design's criteria there."""

    verdicts: dict[str, Word] = Field(description="verdict of every criterion at this value, by its name")
    rounded: Shown | None = Field(
        None, description="the target with rounded values as chosen; absent if nothing on the way is rounded"
    )
    error_unknown: list[str] = Field([], description="criteria that are judged from values of unknown error")


class Target(Measured):
    """The output and its requested value."""

    name: str
    value: float
    unit: str


class DesignSolution(Solved[DesignRoot]):
    """Every value of one parameter or input that gives a requested output; nothing is saved."""

    revision: int = Field(description="the revision that was solved")
    unknown: str = Field(description="the parameter or input that was varied")
    target: Target
    levels: dict[str, str | None] = Field(description="the level of each step along the curve")
    finer_levels: dict[str, str | None] = Field(
        {}, description="the level of each step along the finer curve, if there is one"
    )
