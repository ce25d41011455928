"""Evaluations of templates as the interface shows them."""

from __future__ import annotations

from typing import Annotated, Generic, Literal, Self, TypeVar

from pydantic import ConfigDict, Field, JsonValue, WithJsonSchema
from pydantic.config import JsonDict

from app.presentation.units import System
from app.schemas.answers import Answer, Measured, Quantity, Shown, Value, Values, Version, Warning
from app.schemas.criteria import Criterion, Verdict
from app.schemas.slopes import slope_between


class CalculatedBy(Version):
    """The template version that calculated a result, with the digest of its code."""

    digest: str | None = Field(None, description="SHA-256 of the code; absent if nothing was calculated")


class UsedInput(Answer):
    """An input as the calculation used it."""

    model_config = ConfigDict(populate_by_name=True)

    value: Value
    unit: str | None = None
    source: Literal["given", "default"] = Field(alias="from")
    plus: JsonValue = Field(None, description="upper tolerance, if given")
    minus: JsonValue = Field(None, description="lower tolerance, if given")
    upper: JsonValue = Field(None, description="upper deviation of a one-sided tolerance")
    lower: JsonValue = Field(None, description="lower deviation of a one-sided tolerance")
    zone: str | None = Field(None, description="ISO 286 tolerance zone that defines the limits")
    distribution: str | None = Field(None, description="distribution between the limits, if given")
    state_in_table: bool | None = Field(
        None, description="whether the table of a drawing states the tolerance if no face can carry it"
    )


class Output(Measured):
    """An output; its value is null if it is missing, and `reason` says why."""

    value: Value
    unit: str | None = Field(None, description="unit; absent if the output is a text")
    reason: str | None = Field(None, description="why there is no value")
    reasons: list[JsonValue] | None = Field(
        None, description="for an array: why each point has no value; null where it has one"
    )


class Assumption(Answer):
    """An assumption of a calculation that makes a part look safer than it may be."""

    name: str = Field(description="the input whose default is used, or the criterion; empty for the model")
    detail: str


ERROR: JsonDict = {
    "description": "estimated relative error of each point; for a curve, relative to its largest absolute "
    "value; null if unknown",
    "anyOf": [{"type": "number"}, {"type": "array", "items": {}}, {"type": "null"}],
}
Error = Annotated[object, WithJsonSchema(ERROR)]
LEVEL: JsonDict = {
    "description": "the level of fidelity; an array if points have different levels",
    "anyOf": [{"type": "string"}, {"type": "array", "items": {}}, {"type": "null"}],
}
Level = Annotated[object, WithJsonSchema(LEVEL)]


class Results(Answer):
    """The inputs as the calculation used them, and the resulting outputs."""

    template: CalculatedBy
    inputs: dict[str, UsedInput]
    outputs: dict[str, Output]
    level: Level
    error: dict[str, Error]
    warnings: list[Warning]
    assumed: list[Assumption] = Field([], description="default values in use that make a part look safer")
    criteria: list[Criterion] | None = Field(
        None, description="criteria, worst first; absent if the template has none for the requested outputs"
    )
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent if there are none")


class Evaluation(Results):
    """The answer to `evaluate`."""

    seconds: float = Field(description="elapsed time of the evaluation [s]")


class Root(Quantity):
    """A value of the unknown at which the output reaches its target."""

    crossing: Literal["rises", "falls", "touches"] = Field(
        description="how the output meets the target; `touches` where it is flat or does not cross"
    )
    slope: Quantity | None = Field(
        description="change of the output per change of the unknown, at the level of `curve`; null for the "
        "reason in `reason`"
    )
    reason: str | None = Field(None, description="why there is no slope; absent if there is one")
    level: str | None = Field(description="the level of fidelity at which it was calculated")
    error: float | None = Field(description="estimated relative error of the output; null if unknown")
    confirmed: bool = Field(description="false if only the level of the curve found this solution")

    def slope_per(self, over: str, under: str) -> Self:
        """Return the root with its slope in the unit `over` per `under`."""
        slope = self.slope and slope_between(over, under, self.slope)
        return self.model_copy(update={"slope": slope})


AnyRoot = TypeVar("AnyRoot", bound=Root)


class Jump(Quantity):
    """A value of the unknown at which the output jumps across the target."""

    before: Quantity = Field(description="the output just below this value")
    after: Quantity = Field(description="the output just above this value")

    def in_units(self, system: System) -> Self:
        """Return the jump, with the output on both sides, in a system of units."""
        sides = {"before": self.before.in_units(system), "after": self.after.in_units(system)}
        return super().in_units(system).model_copy(update=sides)


class TracedCurve(Answer):
    """The output as a function of the unknown in the interval, at one level of fidelity."""

    x: Values = Field(
        description="the unknown, ascending, in even steps, or logarithmic if it spans a decade; "
        "an expensive level has only the solutions and one value on each side of each solution"
    )
    y: Shown = Field(description="the output; null where it has no value")
    reasons: list[str | None] = Field(description="why there is no value; null where there is one")
    level: str | None = Field(description="the level of fidelity of all points")


class Solved(Answer, Generic[AnyRoot]):
    """Every value of an unknown that gives a wanted output, and the curve on which they were found."""

    roots: list[AnyRoot] = Field(description="every crossing of the target within the interval, ascending")
    touching: list[AnyRoot] = Field(description="extrema that just reach the target, ascending")
    jumps: list[Jump] = Field(description="values at which the output jumps across the target")
    curve: TracedCurve = Field(description="the curve that was searched")
    finer: list[TracedCurve] = Field(
        description="the curve of each finer level at which solutions were confirmed"
    )
    warnings: list[Warning]

    def in_units(self, system: System) -> Self:
        """Return the solution in a system of units; a slope has the units of the curve."""
        shown = super().in_units(system)
        units = shown.curve.y.unit or "1", shown.curve.x.unit
        return shown.model_copy(
            update={
                "roots": [root.slope_per(*units) for root in shown.roots],
                "touching": [root.slope_per(*units) for root in shown.touching],
            }
        )


class Solution(Solved[Root]):
    """The inputs that give a wanted output."""

    unknown: Shown = Field(description="the lowest value that gives the target; see `roots` for the others")
    evaluation: Evaluation = Field(description="evaluation at `unknown`")


class FormulaMathML(Answer):
    """The parts of a formula in MathML; a missing part is an empty text."""

    lead: str = Field(description="symbol = expression")
    numbers: str = Field(description="= the expression with numbers")
    result: str = Field(description="= the result with its unit")


class WorkedFormula(Answer):
    """One formula written out: symbol = expression = numbers = result, in LaTeX and MathML."""

    name: str
    words: str
    symbol: str
    expression: str
    numbers: str = Field(description="expression with numbers; empty for an array, which has no single value")
    result: str
    source: str | None
    mathml: FormulaMathML


class Worksheet(Evaluation):
    """An evaluation with every formula written out."""

    formulas: list[WorkedFormula]


AnyCalculation = Solution | Worksheet | Evaluation
"""The answer of a calculation that became a job."""
