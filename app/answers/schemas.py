"""Response models of `/answer`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from app.designs.schemas.designs import Sensitivity, State
from app.schemas.answers import Answer, Quantity, Shown, Warning
from app.schemas.criteria import Word

AnswerState = Annotated[
    Literal["confirmed", "unconfirmed", "undecided", "infeasible", "not_settled"],
    Field(
        description="`confirmed`: every requirement is met with its whole error band; `unconfirmed`: met, "
        "but an error is unknown; `undecided`: a limit lies within the error of the finest level; "
        "`infeasible`: see `conflict`; `not_settled`: the levels still disagree after the last round"
    ),
]


class ChosenValue(Answer):
    """The chosen value of a free place."""

    value: Shown = Field(description="the value, or the option")
    fit: str | None = Field(None, description="the chosen fit, such as `H7/f7`")
    least: Quantity | None = Field(None, description="the least value of the fit or zone")
    greatest: Quantity | None = Field(None, description="the greatest value of the fit or zone")
    at_bound: Literal["lower", "upper"] | None = Field(
        None, description="the bound of the place on which the value lies; absent if on none"
    )


class RequirementVerdict(Answer):
    """A requirement at the chosen values, at the worst end of each fit and zone."""

    name: str
    require: str
    verdict: Word
    confirmed: bool = Field(description="whether it is met and every error is known")
    sentence: str
    value: Quantity | None = None
    limit: Quantity | None = None
    margin: Quantity | None = Field(None, description="positive on the safe side")
    error: float | None = Field(description="relative error of the value; null if unknown")
    utilisation: float | None = None


class AnswerObjective(Answer):
    """The objective at the chosen values."""

    name: str
    sense: Literal["minimise", "maximise"]
    value: Quantity
    error: float | None = Field(description="relative error of the value; null if unknown")


class BindingRequirement(Answer):
    """A requirement that keeps the objective from being better, and the gain if its limit is relaxed."""

    name: str
    limit: Quantity = Field(description="the relaxed limit")
    by: float = Field(description="relaxation relative to the limit")
    gain: Quantity | None = Field(
        None, description="improvement of the objective, estimated; 0 if nothing better appears"
    )


class ReachableValue(Answer):
    """The best value that a requirement can have while all others are met."""

    name: str
    limit: Quantity
    best: Quantity


class Relaxation(Answer):
    """Limits with which the request is feasible, at the values `at`."""

    limits: dict[str, Quantity]
    by: float = Field(description="largest relaxation relative to a limit")
    at: dict[str, ChosenValue]


class RequirementConflict(Answer):
    """A minimal set of requirements that cannot all be met: without any one of them, the others can."""

    requirements: list[str]
    sentence: str
    reachable: list[ReachableValue] = Field(description="absent if another conflict prevents it")
    relaxation: Relaxation | None = Field(description="the smallest relaxation that makes it feasible")
    alternatives: list[Relaxation] = Field([], description="other relaxations, each feasible, smallest first")


class LevelUse(Answer):
    """Levels of the steps at one stage, and the cost of its rows."""

    levels: dict[str, str | None]
    rows: int = Field(description="rows calculated")
    seconds: float = Field(description="processor time, in s")


class SavedAnswer(Answer):
    """The revision that an answer was saved as."""

    design: str
    revision: int
    state: State


class DesignAnswer(Answer):
    """The values of the free places that meet the requirements, with the proof; or what conflicts."""

    design: str | None = Field(None, description="id of the design; absent if it was not saved")
    revision: int | None = Field(None, description="the revision that was asked; absent for a document")
    state: AnswerState
    feasible: bool = Field(description="whether all requirements are met")
    sentence: str
    values: dict[str, ChosenValue] = Field(
        description="the chosen values; for an infeasible request those of the least violation"
    )
    objective: AnswerObjective | None = Field(None, description="absent if the request names none")
    requirements: list[RequirementVerdict]
    others: list[str] = Field([], description="criteria that were not required and are not met")
    binding: BindingRequirement | None = Field(
        None, description="the requirement whose relaxation gains most; absent if none is required"
    )
    conflict: RequirementConflict | None = Field(None, description="absent if the request is feasible")
    explored: LevelUse
    confirmed_at: LevelUse = Field(description="the levels that gave the verdicts")
    sensitivities: dict[str, list[Sensitivity]] = Field(
        {}, description="of the objective and of the binding requirement, largest elasticity first"
    )
    optimum: Literal["not proven"] = Field("not proven", description="whether the optimum is proven global")
    patch: dict[str, object] = Field(description="the merge patch of the design that sets these values")
    saved: SavedAnswer | None = Field(None, description="absent unless the answer was saved")
    links: dict[str, str] = Field({}, description="paths of the requested files")
    warnings: list[Warning] = []
