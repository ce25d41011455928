"""Designs and revisions as the interface shows them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field
from pydantic.json_schema import SkipJsonSchema

from app.calculations.schemas.evaluations import (
    Assumption,
    CalculatedBy,
    Error,
    Level,
    Output,
    UsedInput,
    WorkedFormula,
)
from app.identity.schemas.principals import Author
from app.schemas.answers import Answer, Page, Quantity, Shown, Version, Warning
from app.schemas.approval_steps import ApprovalState
from app.schemas.criteria import Criterion, Verdict
from app.schemas.problems import Problem
from app.schemas.values import Given
from app.solids.schemas.analyses import AnalysisOutput, ModelAnalysis
from app.solids.schemas.models import Measurements
from templates.core.language.record import Record

State = Literal["current", "regenerating", "failed"]
"""`current`: the results belong to the inputs; `regenerating`: a job is at work; `failed`: see `problem`."""


class DesignStep(Answer):
    """A template at work in a design."""

    template: str
    version: int
    level: str | None = None
    tolerance: float | None = None
    inputs: dict[str, Given]
    outputs: list[str] | None = Field(None, description="only these are computed; null for all")
    limits: dict[str, Given] = Field({}, description="of criteria; absent where none are given")


class AnalysisOptions(Answer):
    """Options of an analysis of which a relation uses an output."""

    kind: str | None = Field(None, description="absent where the name says it")
    boundary: str = "free_end"
    level: str | None = None
    tolerance: float | None = None
    load: Given = None


class DesignModel(Answer):
    """A CAD model in a design."""

    id: str
    version: int
    parameters: dict[str, Given]
    analyses: dict[str, AnalysisOptions] = Field({}, description="absent where there are none")


class DesignIteration(Answer):
    """A loop that the design allows."""

    through: str = Field(description="the measure or analysis output of a solid, such as `model.mass`")
    start: Given
    tolerance: float = Field(description="relative")
    limit: int = Field(description="rounds")


class DesignCriterion(Answer):
    """A criterion of the design itself, or changes to a criterion of one of its templates."""

    require: str | None = Field(None, description="absent where that of the template holds")
    words: str | None = None
    source: str | None = None
    waived: str | None = Field(None, description="why it does not count")


class DesignSummary(Answer):
    """A design in a list."""

    id: str
    name: str
    revision: int
    state: State
    created: str
    changed: str
    tags: list[str] = Field([], description="in alphabetical order")
    archived: bool = Field(False, description="whether lists leave it out unless they name `archived`")
    released: int | None = Field(None, description="the newest released revision; absent where there is none")


class DesignList(Page[DesignSummary]):
    """A page of designs, newest first."""


class Design(Answer):
    """A design as of its newest revision: what its user wrote, and how its regeneration stands."""

    id: str
    name: str
    revision: int
    state: State
    parameters: dict[str, Given]
    steps: dict[str, DesignStep]
    models: dict[str, DesignModel]
    iterations: list[DesignIteration]
    criteria: dict[str, DesignCriterion] = Field({}, description="absent where there are none")
    variants: dict[str, dict[str, Given]] = Field(
        {}, description="what each variant overrides, by place; absent where there are none"
    )
    problem: Problem | None = Field(description="why the regeneration failed")
    created: str
    changed: str


class Proposal(Answer):
    """A relation for a model parameter that is not set."""

    target: str
    relation: str
    reason: str


class Proposals(Answer):
    """Proposals for model parameters that are not set."""

    proposals: list[Proposal]


class MappedDesign(Design, Proposals):
    """A design with the proposals that were applied."""


InputOrGiven = Annotated[UsedInput | Given, Field(union_mode="left_to_right")]
"""An input as it was used, or as typed while its step waits."""


class RevisionStep(Answer):
    """A step with its results, or as typed while it waits for a solid or its job."""

    model_config = ConfigDict(extra="allow")  # older programs stored more

    template: CalculatedBy
    inputs: dict[str, InputOrGiven] = {}
    outputs: dict[str, Output] = {}
    level: Level = None
    error: dict[str, Error] = {}
    warnings: list[Warning] = []
    assumed: list[Assumption] = Field([], description="defaults that make a part look safer, and stand")
    relations: dict[str, Given] = Field({}, description="inputs that are relations, as typed")
    state: str | None = Field(None, description="`pending` in a preview, for a step that waits")
    pending: bool = Field(False, description="whether it waits; absent if it does not")
    record: Annotated[Record | None, SkipJsonSchema()] = Field(None, exclude=True)
    """The record from which formulas are written; not served, and None in revisions older than records."""


class RevisionModel(Answer):
    """A model with its parameters resolved."""

    id: str
    version: int
    parameters: dict[str, Shown]
    relations: dict[str, Given]
    build: str | None = Field(description="key of its build; null while parameters are missing")
    artifacts: dict[str, str] = Field(description="SHA-256 of every file, by kind")
    analyses: dict[str, ModelAnalysis]


class Round(Answer):
    """One round of an iteration."""

    round: int
    through: str = Field(description="the measure or analysis output through which it runs")
    assumed: float
    measured: float
    unit: str


class Revision(Answer):
    """A revision: its inputs never change, its results are attached once."""

    design: str
    number: int
    note: str | None
    created: str
    state: State
    problem: Problem | None
    name: str
    parameters: dict[str, Given]
    steps: dict[str, RevisionStep]
    models: dict[str, RevisionModel]
    iterations: list[Round]
    warnings: list[Warning] = Field([], description="about the design's own parameters and its models'")
    criteria: list[Criterion] | None = Field(
        None,
        description="as judged when it was calculated, worst first; absent in revisions of older programs",
    )
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")
    author: Author | None = Field(
        None, description="who saved it; `local` without keys, null in revisions of older programs"
    )
    supersedes: int | None = Field(None, description="the released revision that it replaces, where it does")
    approval: ApprovalState | None = Field(None, description="the last step taken; absent before the first")


class RevisionList(Page[Revision]):
    """A page of revisions, newest first."""


class ModelMeasurements(Measurements):
    """Measurements of the newest good solid of a model."""

    revision: int
    build: str
    analyses: dict[str, ModelAnalysis]


Result = Annotated[Output | AnalysisOutput, Field(union_mode="left_to_right")]
"""An output of a step, or of an analysis."""


class Change(Answer):
    """A value before and after a change; null where there is none."""

    old: Result | None
    new: Result | None


Status = Literal["ok", "unchanged", "missing", "pending", "unit_mismatch"]


class ParameterChange(Answer):
    """A model parameter before and after a change."""

    old: Shown | None
    new: Shown | None
    status: Status
    detail: str | None = Field(None, description="what is wrong with its unit")


class PreviewedStep(RevisionStep):
    """A step with its formulas written out."""

    formulas: list[WorkedFormula]


class RevisionWorksheet(Revision):
    """A revision with every formula of its steps written out."""

    steps: dict[str, PreviewedStep]  # type: ignore[assignment]


class Preview(Answer):
    """The effect of a change; nothing is saved."""

    revision: int = Field(description="with which revision it is compared")
    outputs: dict[str, Change]
    warnings: list[Warning]
    model_parameters: dict[str, ParameterChange]
    steps: dict[str, PreviewedStep] | None = None
    parameters: dict[str, Shown] | None = Field(None, description="values of the design's own parameters")
    criteria: list[Criterion] | None = Field(None, description="worst first; absent where there are none")
    verdict: Verdict | None = Field(None, description="over all criteria; absent where there are none")


class Sensitivity(Answer):
    """Change of a value with a quantity that its user wrote; local to the design."""

    name: str
    slope: Quantity | None = Field(None, description="change of the value by that of the place")
    elasticity: float | None = Field(
        None, description="relative change by relative change; null where either is 0 or a temperature"
    )
    helps: Literal["increase", "decrease"] | None = Field(
        None,
        description="of a criterion: which change of the place enlarges its margin; absent where none does",
    )
    reason: str | None = Field(None, description="why there is no slope, or only that of one side")


class Explanation(Answer):
    """The meaning of a name, and the values on which it depends."""

    name: str
    kind: str
    value: Shown | None = None
    relation: Given = None
    typed: Given = None
    template: CalculatedBy | Version | None = None
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    source: str | None = None
    analysis: AnalysisOptions | None = None
    criterion: Criterion | None = Field(None, description="of a criterion: as it was judged")
    side: Literal["value", "limit"] | None = Field(None, description="of the comparison of a criterion")
    library: str | None = Field(None, description="the table of the row `typed` that gives a limit")
    because: list[Explanation] | None = None
    sensitivities: list[Sensitivity] | None = Field(
        None, description="of the name that was asked for, to quantities as typed; largest elasticity first"
    )
    reason: str | None = Field(None, description="why all or some sensitivities are missing")
