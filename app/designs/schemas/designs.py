"""Response models of designs and revisions."""

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
from app.designs.schemas.worksheets import DesignLine, DesignWorksheet
from app.identity.schemas.principals import Author
from app.schemas.answers import Answer, Page, Quantity, Shown, Version, Warning
from app.schemas.approval_steps import ApprovalState
from app.schemas.criteria import Criterion, Verdict
from app.schemas.problems import Problem
from app.schemas.values import Given
from app.solids.schemas.analyses import AnalysisOutput, ModelAnalysis
from app.solids.schemas.models import Measurements, StatedTolerance
from templates.core.language.record import Record

State = Literal["current", "regenerating", "failed"]
"""`current`: the results match the inputs; `regenerating`: a job is running; `failed`: see `problem`."""


class DesignStep(Answer):
    """A template used in a design."""

    template: str
    version: int
    level: str | None = None
    tolerance: float | None = None
    inputs: dict[str, Given]
    outputs: list[str] | None = Field(None, description="outputs to compute; null for all")
    limits: dict[str, Given] = Field({}, description="limits of criteria; absent if none are set")


class AnalysisOptions(Answer):
    """Options of an analysis whose outputs relations may use."""

    kind: str | None = Field(None, description="kind of analysis; absent if the name is the kind")
    boundary: str = "free_end"
    level: str | None = None
    tolerance: float | None = None
    load: Given = None


class DesignModel(Answer):
    """A CAD model in a design."""

    id: str
    version: int
    parameters: dict[str, Given]
    analyses: dict[str, AnalysisOptions] = Field({}, description="absent if there are none")


class DesignIteration(Answer):
    """An iteration loop that the design allows."""

    through: str = Field(description="the measurement or analysis output of a solid, such as `model.mass`")
    start: Given
    tolerance: float = Field(description="relative tolerance")
    limit: int = Field(description="largest number of rounds")


class DesignCriterion(Answer):
    """A criterion of the design itself, or changes to a criterion of one of its templates."""

    require: str | None = Field(None, description="absent if the template's comparison applies")
    words: str | None = None
    source: str | None = None
    waived: str | None = Field(None, description="why the criterion is waived")


class DesignTable(Answer):
    """The columns of the table of results that a design chooses."""

    columns: list[str] = Field([], description="values of the design, in order")
    changes: bool = Field(False, description="whether each row also shows its change from the first row")


class DesignAssumption(Answer):
    """A proposed value that a parameter still has."""

    value: Given
    source: str = Field(description="where the proposal comes from")


class DesignSummary(Answer):
    """A design in a list."""

    id: str
    name: str
    revision: int
    state: State
    created: str
    changed: str
    tags: list[str] = Field([], description="in alphabetical order")
    archived: bool = Field(False, description="if true, lists omit it unless they filter by `archived`")
    released: int | None = Field(None, description="the newest released revision; absent if there is none")
    deleted: str | None = Field(None, description="time of deletion; absent if it is not deleted")


class DesignList(Page[DesignSummary]):
    """A page of designs, newest first."""


class DesignResults(Answer):
    """The results of a revision: single outputs of its steps, and its criteria as judged.

    Lists, curves and inputs are in `/designs/{id}/revisions/{number}`.
    """

    outputs: dict[str, Output] = Field(description="by the names in relations: `film.power_loss`")
    criteria: list[Criterion] = Field([], description="worst first; absent if there are none")
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent without criteria")


class Design(Answer):
    """A design at its newest revision: what its user wrote, and the state of its regeneration."""

    id: str
    name: str
    revision: int
    state: State
    parameters: dict[str, Given]
    steps: dict[str, DesignStep]
    models: dict[str, DesignModel]
    iterations: list[DesignIteration]
    criteria: dict[str, DesignCriterion] = Field({}, description="absent if there are none")
    variants: dict[str, dict[str, Given]] = Field(
        {}, description="values that each variant overrides, by name; absent if there are none"
    )
    table: DesignTable | None = Field(
        None, description="the table of results; absent if its columns are the main results of the templates"
    )
    assumed: dict[str, DesignAssumption] = Field(
        {}, description="parameters whose values were proposed and not changed; absent if there are none"
    )
    worksheet: str = Field("", description="lines that use values of the design; absent if there are none")
    results: DesignResults | None = Field(
        None, description="absent while the design is calculated, if it failed, and with `return=minimal`"
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
    """A design after its proposals were applied."""


InputOrGiven = Annotated[UsedInput | Given, Field(union_mode="left_to_right")]
"""An input as used in the calculation, or as typed while its step waits."""


class RevisionStep(Answer):
    """A step with its results; while it waits for a solid or its job, the step as typed."""

    model_config = ConfigDict(extra="allow")  # older programs stored more members

    template: CalculatedBy
    inputs: dict[str, InputOrGiven] = {}
    outputs: dict[str, Output] = {}
    level: Level = None
    error: dict[str, Error] = {}
    warnings: list[Warning] = []
    assumed: list[Assumption] = Field([], description="defaults in use that make a part look safer")
    relations: dict[str, Given] = Field({}, description="relations of the inputs, as typed")
    state: str | None = Field(
        None, description="`pending` in a preview, for a step that is not calculated yet"
    )
    pending: bool = Field(False, description="true if the step is not calculated yet, else absent")
    record: Annotated[Record | None, SkipJsonSchema()] = Field(None, exclude=True)
    """The record from which formulas are written; not part of the response, and None in older revisions."""


class RevisionModel(Answer):
    """A model with resolved parameters."""

    id: str
    version: int
    parameters: dict[str, Shown]
    relations: dict[str, Given]
    build: str | None = Field(description="key of its build; null while parameters are missing")
    artifacts: dict[str, str] = Field(description="SHA-256 of every file, by kind")
    analyses: dict[str, ModelAnalysis]
    tolerances: dict[str, StatedTolerance] = Field(
        {},
        description="where its files state tolerances, by parameter; absent before it is built, or if there "
        "are none",
    )


class RoundedValue(Answer):
    """A value that a relation calculates and its rule rounds, or one that only names such a value."""

    name: str
    rule: str = Field(examples=["rounded up to 0.5 mm"])
    calculated: Shown = Field(description="before rounding; an array for a list")
    chosen: Shown = Field(description="the value in use: in solids, steps and criteria")


class Round(Answer):
    """One round of an iteration."""

    round: int
    through: str = Field(description="the measurement or analysis output that is iterated")
    assumed: float
    measured: float
    unit: str


class Revision(Answer):
    """A revision: its inputs never change, and its results are added once."""

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
    assumed: dict[str, DesignAssumption] = Field(
        {}, description="parameters whose values were proposed and not changed; absent if there are none"
    )
    rounded: list[RoundedValue] = Field([], description="rounded values; absent if there are none")
    worksheet: DesignWorksheet | None = Field(
        None, description="the lines of the design's worksheet; absent if it has none"
    )
    warnings: list[Warning] = Field(
        [], description="warnings about parameters of the design and of its models"
    )
    criteria: list[Criterion] | None = Field(
        None,
        description="criteria as judged at calculation, worst first; absent in revisions of older programs",
    )
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent without criteria")
    author: Author | None = Field(
        None,
        description="who saved it; `local` if no access keys are used, null in revisions of older programs",
    )
    supersedes: int | None = Field(None, description="the released revision that this one replaces")
    approval: ApprovalState | None = Field(
        None, description="the latest step of the approval; absent before the first"
    )


class RevisionList(Page[Revision]):
    """A page of revisions, newest first."""


class ModelMeasurements(Measurements):
    """Measurements of the newest valid solid of a model."""

    revision: int
    build: str
    analyses: dict[str, ModelAnalysis]


Result = Annotated[Output | AnalysisOutput, Field(union_mode="left_to_right")]
"""An output of a step, or of an analysis."""


class Change(Answer):
    """A value before and after a change; null if it does not exist."""

    old: Result | None
    new: Result | None


Status = Literal["ok", "unchanged", "missing", "pending", "unit_mismatch"]


class ParameterChange(Answer):
    """A model parameter before and after a change."""

    old: Shown | None
    new: Shown | None
    status: Status
    detail: str | None = Field(None, description="why its unit does not fit")


class PreviewedStep(RevisionStep):
    """A step with its formulas written out."""

    formulas: list[WorkedFormula]


class RevisionWorksheet(Revision):
    """A revision with every formula of its steps written out."""

    steps: dict[str, PreviewedStep]  # type: ignore[assignment]


class Preview(Answer):
    """The effect of a change; nothing is saved."""

    revision: int = Field(description="the revision with which the change is compared")
    outputs: dict[str, Change]
    warnings: list[Warning]
    model_parameters: dict[str, ParameterChange]
    steps: dict[str, PreviewedStep] | None = None
    parameters: dict[str, Shown] | None = Field(None, description="values of the design's parameters")
    rounded: list[RoundedValue] = Field([], description="rounded values; absent if there are none")
    worksheet: list[DesignLine] = Field([], description="lines of the worksheet; absent if there are none")
    criteria: list[Criterion] | None = Field(None, description="worst first; absent if there are none")
    verdict: Verdict | None = Field(None, description="verdict over all criteria; absent without criteria")


class Sensitivity(Answer):
    """The change of a value with a quantity that the user typed, valid near the design point."""

    name: str
    slope: Quantity | None = Field(None, description="change of the value per change of the quantity")
    elasticity: float | None = Field(
        None, description="relative change per relative change; null if either is 0 or a temperature"
    )
    helps: Literal["increase", "decrease"] | None = Field(
        None,
        description="for a criterion: the change of the quantity that increases the margin; absent if none "
        "does",
    )
    reason: str | None = Field(None, description="why the slope is missing or one-sided")


class Explanation(Answer):
    """The meaning of a name, and the values on which it depends."""

    name: str
    kind: str
    value: Shown | None = None
    relation: Given = None
    rounded: RoundedValue | None = Field(None, description="absent unless a rule rounds the value")
    typed: Given = None
    template: CalculatedBy | Version | None = None
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    source: str | None = None
    error: Error = Field(None, description="for an output of a step with levels, as in its results")
    analysis: AnalysisOptions | None = None
    criterion: Criterion | None = Field(None, description="for a criterion, its judgement")
    criteria: list[Criterion] | None = Field(
        None,
        description="for a parameter, the criteria that depend on it or on a value behind it, worst first",
    )
    side: Literal["value", "limit"] | None = Field(None, description="side of a criterion's comparison")
    library: str | None = Field(
        None, description="for a limit from a library, the table with the row `typed`"
    )
    because: list[Explanation] | None = None
    sensitivities: list[Sensitivity] | None = Field(
        None, description="sensitivities of the explained name to typed quantities; largest elasticity first"
    )
    reason: str | None = Field(None, description="why all or some sensitivities are missing")
