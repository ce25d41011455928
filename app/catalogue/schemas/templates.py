"""Templates and CAD models as the REST interface returns them."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field, JsonValue

from app.schemas.answers import Answer, Page

Schema = dict[str, JsonValue]
"""A JSON Schema. It holds units, symbols and bounds beside each property."""


class SheetMark(Answer):
    """The mark of a template that is a worksheet: who wrote it, and who reviewed it."""

    state: Literal["released", "withdrawn"]
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="false: a typed name, which nobody proved")


class TemplateSummary(Answer):
    """One version in a list."""

    id: str
    version: int
    title: str
    summary: str
    status: Literal["released", "withdrawn"]
    latest: bool
    worksheet: SheetMark | None = Field(None, description="absent for a template from a file")


class TemplateList(Page[TemplateSummary]):
    """Versions of templates or models."""

    notes: list[str] = Field(
        [], description="on names in a search: other definitions, and the factor between"
    )


class TemplateVersions(TemplateList):
    """The versions of one template or model."""

    id: str


class Formula(Answer):
    """One formula, in words and on paper."""

    name: str = Field(description="the output that it gives")
    text: str
    latex: str
    mathml: str
    source: str | None = Field(description="where the formula comes from")
    uses: list[str] = Field(description="the inputs and outputs that it follows from")


class Limit(Answer):
    """Where a value is refused, or carries a warning."""

    text: str
    name: str | None = Field(None, description="the value; absent for a limit of the whole template")
    kind: Literal["refused_unless", "warned_unless"] | None = None
    source: str | None = None


class DeclaredLimit(Answer):
    """A limit of a criterion that its user gives, in `limits` beside `inputs`."""

    name: str
    unit: str
    words: str
    library: str | None = Field(description="the table of the library whose rows have a value for it")
    default: str | None = Field(description="what it is where nobody gives it, such as `min(speed_range)`")


class DeclaredCriterion(Answer):
    """A criterion that every evaluation is held against."""

    name: str
    words: str
    require: str = Field(description="the comparison, such as `film >= 3 um`")
    source: str | None = Field(description="of the limit, or of the rule")
    unverified: str | None = Field(description="why the limit is not sure")
    warning: str | None = Field(description="the code of the warning where the value misses the limit")
    limits: list[DeclaredLimit]


class Description(Answer):
    """The inputs and outputs of a version, with its sources."""

    id: str
    version: int
    title: str
    summary: str
    status: Literal["released", "withdrawn"]
    withdrawn: str | None = Field(description="why it was withdrawn")
    digest: str = Field(description="SHA-256 of the code without the paths of its imports")
    outputs: Schema = Field(description="JSON Schema of the object `outputs`")
    formulas: list[Formula]
    levels: list[str] = Field(description="levels of fidelity, the cheapest first")
    default_level: str | None
    limits: list[Limit]
    criteria: list[DeclaredCriterion]
    references: list[str]
    errata: list[str]
    example: dict[str, JsonValue] = Field(description="inputs that can be sent as they are")
    given_limits: Schema = Field({}, description="JSON Schema of the object `limits`, which criteria take")


class Template(Description):
    """One version of a template."""

    inputs: Schema = Field(description="JSON Schema of the object `inputs`")
    latest: bool
    worksheet: SheetMark | None = Field(None, description="absent for a template from a file")


class Axis(Answer):
    """One axis of the plane over which errors were measured."""

    model_config = ConfigDict(extra="allow")

    attribute: str
    name: str | None = Field(None, description="the input or output along the axis")
    values: list[float] = Field(description="the ends of the cells")


class Accuracy(Answer):
    """Measured cost and error of every level; what else a measurement says depends on the template."""

    model_config = ConfigDict(extra="allow")

    made_by: str | None = Field(None, description="the command that measured it")
    truth: str | None = Field(None, description="with which solution the levels are compared")
    truths: dict[str, str] = Field({}, description="the solutions that the levels name as their `truth`")
    error: str | None = Field(None, description="what the errors are; of a profile: over its largest value")
    cost: str | None = Field(None, description="what the costs are")
    axes: list[Axis] = Field([], description="none where one cell covers the whole plane")
    levels: dict[str, JsonValue] = Field(
        description="cost, and by output `errors` by cell and the name of the `truth`"
    )
