"""Templates and CAD models as the REST interface returns them."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field, JsonValue

from app.schemas.answers import Answer, Page

Schema = dict[str, JsonValue]
"""A JSON Schema; each property also has its unit, symbol and bounds."""


class SheetMark(Answer):
    """The state, author and reviewer of a template that is a worksheet."""

    state: Literal["released", "withdrawn"]
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="false if the reviewer's name was only typed, not verified")


class TemplateSummary(Answer):
    """One version as a list item."""

    id: str
    version: int
    title: str
    summary: str
    status: Literal["released", "withdrawn"]
    latest: bool
    worksheet: SheetMark | None = Field(
        None, description="author and reviewer; absent unless it is a worksheet"
    )


class TemplateList(Page[TemplateSummary]):
    """Versions of templates or models."""

    notes: list[str] = Field(
        [],
        description="notes on searched names that are defined differently here, with the conversion factor",
    )


class TemplateVersions(TemplateList):
    """The versions of one template or model."""

    id: str


class Formula(Answer):
    """One formula as text, LaTeX and MathML."""

    name: str = Field(description="the output that the formula computes")
    text: str
    latex: str
    mathml: str
    source: str | None = Field(description="where the formula comes from")
    uses: list[str] = Field(description="the inputs and outputs that the formula uses")


class Limit(Answer):
    """A limit of validity: a value outside it is refused or causes a warning."""

    text: str
    name: str | None = Field(None, description="the limited value; absent for a limit of the whole template")
    kind: Literal["refused_unless", "warned_unless"] | None = None
    source: str | None = None


class DeclaredLimit(Answer):
    """A limit of a criterion that the user may set in `limits`, next to `inputs`."""

    name: str
    unit: str
    words: str
    library: str | None = Field(description="the library table whose rows have a value for this limit")
    default: str | None = Field(
        description="default if the request gives no value, such as `min(speed_range)`"
    )


class DeclaredCriterion(Answer):
    """A criterion that every evaluation is checked against."""

    name: str
    words: str
    require: str = Field(description="the comparison, such as `film >= 3 um`")
    source: str | None = Field(description="source of the limit or of the rule")
    unverified: str | None = Field(description="why the limit is uncertain")
    warning: str | None = Field(description="code of the warning given when the criterion is not met")
    limits: list[DeclaredLimit]


class Description(Answer):
    """The inputs, outputs and sources of a version."""

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
    example: dict[str, JsonValue] = Field(description="example inputs that can be sent unchanged")
    given_limits: Schema = Field(
        {}, description="JSON Schema of the object `limits`, the user's limits for criteria"
    )


class Template(Description):
    """One version of a template."""

    inputs: Schema = Field(description="JSON Schema of the object `inputs`")
    latest: bool
    worksheet: SheetMark | None = Field(
        None, description="author and reviewer; absent unless it is a worksheet"
    )


class Axis(Answer):
    """One axis of the plane over which errors were measured."""

    model_config = ConfigDict(extra="allow")

    attribute: str
    name: str | None = Field(None, description="the input or output along the axis")
    values: list[float] = Field(description="boundaries of the cells along the axis")


class Accuracy(Answer):
    """Measured cost and error of every level; the template determines any further fields."""

    model_config = ConfigDict(extra="allow")

    made_by: str | None = Field(None, description="the command that measured it")
    truth: str | None = Field(None, description="the solution with which the levels are compared")
    truths: dict[str, str] = Field({}, description="the reference solutions that levels name in `truth`")
    error: str | None = Field(
        None, description="definition of the errors; for a profile, relative to its largest value"
    )
    cost: str | None = Field(None, description="definition of the costs")
    axes: list[Axis] = Field([], description="axes of the plane; empty if one cell covers all of it")
    levels: dict[str, JsonValue] = Field(
        description="for each level, its cost and for each output the `errors` by cell and the `truth` used"
    )
