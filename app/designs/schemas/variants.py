"""Response models of variants: overrides, verdicts, models, and the governing variant."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.calculations.schemas.evaluations import Output, UsedInput
from app.designs.schemas.designs import RoundedValue
from app.designs.schemas.result_table import ResultTable
from app.schemas.answers import Answer, Shown
from app.schemas.criteria import Criterion, Verdict, Word
from app.schemas.problems import Problem
from app.schemas.values import Given
from app.solids.schemas.models import Measurements, StatedTolerance

VariantState = Literal["current", "regenerating", "failed"]
"""`failed`: its solid could not be built or measured, see `problem`; other variants are not affected."""

ModelState = Literal["current", "regenerating", "failed", "incomplete"]
"""`incomplete`: some of its parameters are not set."""


class VariantModel(Answer):
    """A model of a variant; variants with equal parameters share one build."""

    build: str | None = Field(description="key of its build; null while a parameter is missing or unknown")
    state: ModelState
    parameters: dict[str, Shown] = Field({}, description="every parameter, defaults included")
    artifacts: dict[str, str] = Field({}, description="SHA-256 of every file, by kind")
    measurements: Measurements | None = Field(None, description="absent until the model is built")
    tolerances: dict[str, StatedTolerance] = Field(
        {},
        description="where its files state tolerances, by parameter; absent before it is built, or if there "
        "are none",
    )
    problem: Problem | None = Field(None, description="why the model could not be built; else absent")


class VariantResult(Answer):
    """One variant: the values that it overrides, and its results."""

    name: str
    state: VariantState
    values: dict[str, Shown] = Field(
        description="overridden values as quantities, with relations resolved; others are as in the design"
    )
    criteria: list[Criterion] = Field(
        [], description="criteria of the variant, worst first; absent if there are none"
    )
    verdict: Verdict | None = Field(None, description="verdict over all criteria of the variant")
    models: dict[str, VariantModel] = Field({}, description="by name")
    outputs: dict[str, Output] = Field({}, description="requested outputs, by their names in relations")
    rounded: list[RoundedValue] = Field([], description="rounded values; absent if there are none")
    problem: Problem | None = Field(None, description="why the variant failed; else absent")


class VariantDetail(Answer):
    """One variant, calculated on request: all outputs of its steps, curves included."""

    design: str
    revision: int
    name: str = Field(description="`base`: the design itself")
    values: dict[str, Shown] = Field(
        description="overridden values as quantities, with relations resolved; others are as in the design"
    )
    inputs: dict[str, UsedInput] = Field(
        {}, description="inputs of its steps as used, by their names in relations"
    )
    outputs: dict[str, Output] = Field(description="requested outputs, else all, by their names in relations")
    rounded: list[RoundedValue] = Field([], description="rounded values; absent if there are none")
    criteria: list[Criterion] = Field(
        [], description="criteria of the variant, worst first; absent if there are none"
    )
    verdict: Verdict | None = Field(None, description="verdict over all criteria of the variant")


class VariantColumn(Answer):
    """A column of the table: a parameter or input that at least one variant overrides."""

    place: str = Field(description="`clearance`, `film.bearing_width`, `shell.wall`")
    words: str = Field(description="the heading")
    unit: str | None = Field(None, description="unit of the column; absent for a choice")
    nominal: Shown | None = Field(None, description="the design's value; absent if it has none")


class GoverningVariant(Answer):
    """The worst variant for one criterion, or for all."""

    variant: str = Field(description="`base`: the design itself")
    criterion: str
    verdict: Word
    utilisation: float | None = None


class VariantsOut(Answer):
    """All variants of a revision, in the natural order of their names."""

    design: str
    name: str = Field(description="name of the design")
    revision: int
    state: Literal["current", "regenerating", "failed"] = Field(description="state of the revision")
    variants: dict[str, dict[str, Given]] = Field(description="the table as typed; `PUT` takes the same")
    columns: list[VariantColumn]
    rows: list[VariantResult]
    table: ResultTable = Field(
        ResultTable(columns=[], rows=[]), description="the results in one table, with the design itself first"
    )
    base: VariantResult | None = Field(None, description="the design itself, without any override")
    governing: GoverningVariant | None = Field(
        None, description="the worst variant of all; absent without criteria"
    )
    by_criterion: dict[str, GoverningVariant] = Field({}, description="the worst variant of each criterion")
    problem: Problem | None = Field(None, description="why the regeneration of the revision failed")
