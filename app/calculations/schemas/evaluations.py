"""Evaluations of templates as the interface shows them."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, JsonValue, WithJsonSchema
from pydantic.config import JsonDict

from app.presentation.units import System
from app.schemas.answers import Answer, Measured, Quantity, Shown, Value, Values, Version, Warning
from app.schemas.criteria import Criterion, Verdict


class CalculatedBy(Version):
    """The version that calculated, with the digest of its code."""

    digest: str | None = Field(None, description="SHA-256 of the code; absent where nothing calculated")


class UsedInput(Answer):
    """An input as it was used."""

    model_config = ConfigDict(populate_by_name=True)

    value: Value
    unit: str | None = None
    source: Literal["given", "default"] = Field(alias="from")
    plus: JsonValue = Field(None, description="tolerance upwards, if one was given")
    minus: JsonValue = Field(None, description="tolerance downwards, if one was given")
    upper: JsonValue = Field(None, description="upper deviation of a tolerance that lies on one side")
    lower: JsonValue = Field(None, description="lower deviation of a tolerance that lies on one side")
    zone: str | None = Field(None, description="zone of ISO 286 from which the limits come")
    distribution: str | None = Field(None, description="between the limits, if one was given")


class Output(Measured):
    """An output; null where there is none, with the reason."""

    value: Value
    unit: str | None = Field(None, description="absent for a text")
    reason: str | None = Field(None, description="why there is no value")
    reasons: list[JsonValue] | None = Field(
        None, description="of an array: the reason at each point, or null"
    )


class Assumption(Answer):
    """Something that an answer takes for granted and that makes a part look safer."""

    name: str = Field(description="the input whose default stands, or the criterion; empty for the model")
    detail: str


ERROR: JsonDict = {
    "description": "estimated relative error of each point; of a curve, relative to its largest absolute "
    "value; null where none is stated",
    "anyOf": [{"type": "number"}, {"type": "array", "items": {}}, {"type": "null"}],
}
Error = Annotated[object, WithJsonSchema(ERROR)]
LEVEL: JsonDict = {
    "description": "the level of fidelity; an array where each point has its own",
    "anyOf": [{"type": "string"}, {"type": "array", "items": {}}, {"type": "null"}],
}
Level = Annotated[object, WithJsonSchema(LEVEL)]


class Results(Answer):
    """Inputs as they were used, and the outputs that follow."""

    template: CalculatedBy
    inputs: dict[str, UsedInput]
    outputs: dict[str, Output]
    level: Level
    error: dict[str, Error]
    warnings: list[Warning]
    assumed: list[Assumption] = Field([], description="defaults that make a part look safer, and stand")
    criteria: list[Criterion] | None = Field(
        None, description="worst first; absent where the template has none whose outputs are wanted"
    )
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")


class Evaluation(Results):
    """The answer to `evaluate`."""

    seconds: float = Field(description="time that the evaluation took, in s")


class Root(Quantity):
    """A value of the unknown that gives the target."""

    slope: Literal[-1, 0, 1] = Field(description="sign of the output's slope; 0: flat, or it only touches")
    level: str | None = Field(description="the level at which it was calculated")
    error: float | None = Field(
        description="estimated relative error of the output; null where none is stated"
    )
    confirmed: bool = Field(description="false: a solution at the level of the curve only")


class Jump(Quantity):
    """A value of the unknown at which the output jumps across the target."""

    before: Quantity = Field(description="the output just below")
    after: Quantity = Field(description="the output just above")

    def in_units(self, system: System) -> Self:
        """Return the root, with both sides of the equation, in a system of units."""
        sides = {"before": self.before.in_units(system), "after": self.after.in_units(system)}
        return super().in_units(system).model_copy(update=sides)


class TracedCurve(Answer):
    """The output over the unknown, between the bounds, at one level."""

    x: Values = Field(
        description="the unknown, ascending; even steps, in the logarithm where the bounds span a decade; of "
        "a level that takes few points, the solutions and a value to both sides of each"
    )
    y: Shown = Field(description="the output; null where it has no value")
    reasons: list[str | None] = Field(description="why there is no value; null where there is one")
    level: str | None = Field(description="the level of fidelity of all points")


class Solution(Answer):
    """The inputs that give a wanted output."""

    unknown: Shown = Field(description="the lowest value that gives the target; see `roots` for the others")
    warnings: list[Warning]
    roots: list[Root] = Field([], description="every crossing of the target within the bounds, ascending")
    touching: list[Root] = Field([], description="extrema that just reach the target, ascending")
    jumps: list[Jump] = Field([], description="where the output jumps across the target")
    curve: TracedCurve | None = Field(
        None, description="the curve that was searched; absent in answers of earlier program versions"
    )
    finer: list[TracedCurve] = Field(
        [], description="the curve of each finer level at which solutions were confirmed"
    )
    evaluation: Evaluation = Field(description="at `unknown`")


class FormulaMathML(Answer):
    """The parts of a formula in MathML; empty where there is none."""

    lead: str = Field(description="symbol = expression")
    numbers: str = Field(description="= the expression with numbers")
    result: str = Field(description="= the result with its unit")


class WorkedFormula(Answer):
    """One formula written out: symbol = expression = numbers = result, in LaTeX and MathML."""

    name: str
    words: str
    symbol: str
    expression: str
    numbers: str = Field(description="empty where an array has no single value")
    result: str
    source: str | None
    mathml: FormulaMathML


class Worksheet(Evaluation):
    """An evaluation with every formula written out."""

    formulas: list[WorkedFormula]


AnyCalculation = Solution | Worksheet | Evaluation
"""The answer of a calculation that went on as a job."""
