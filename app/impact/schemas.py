"""The effect of a template version on designs that use another version."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity, Version
from app.schemas.criteria import Word

Effect = Literal["moved", "refused", "needs_solids"]
"""`needs_solids`: nothing that is known moves, but some values wait for a solid that is not built."""


class StepUse(Answer):
    """A step that uses another version of the template."""

    step: str
    version: int = Field(description="that it uses now")


class CriterionChange(Answer):
    """A criterion that is judged otherwise; null where a version has no such criterion.

    One that only a new version has is mentioned where it is not met or undecided.
    """

    name: str
    variant: str | None = Field(None, description="absent for the design itself")
    old: Word | None
    new: Word | None


class MarginLost(Answer):
    """The margin of the criterion that loses most."""

    name: str
    variant: str | None = Field(None, description="absent for the design itself")
    old: Quantity
    new: Quantity
    lost: Quantity = Field(description="old margin less new margin")
    relative: float | None = Field(
        description="lost over old margin, above 1 where nothing is left; null if there was none before"
    )


class OutputChange(Answer):
    """The output that changes most; of a curve the place that does. Null where there is no value."""

    name: str = Field(description="as in relations: `film.minimum_film_thickness`")
    variant: str | None = Field(None, description="absent for the design itself")
    old: Quantity | None
    new: Quantity | None
    change: float | None = Field(
        description="(new − old) / |old|, of a curve over its largest value; null for temperatures, for an "
        "old value of 0, and where a side has no value"
    )


class ModelParameterChange(Answer):
    """A parameter of a CAD model that would change: the solid is built again."""

    name: str = Field(description="such as `shell.inner_diameter`")
    variant: str | None = Field(None, description="absent for the design itself")
    old: Quantity | None
    new: Quantity | None


class UpgradeRefused(Answer):
    """Why a design cannot take the version as it is, in the words of the refused save."""

    name: str
    variant: str | None = Field(None, description="absent for the design itself")
    code: str
    detail: str


class DesignImpact(Answer):
    """One design with the version in place of the ones that it uses."""

    design: str
    name: str
    revision: int = Field(description="the newest, which was calculated")
    effect: Effect
    steps: list[StepUse]
    verdicts: list[CriterionChange] = Field([], description="that change; met → not met first")
    margin: MarginLost | None = None
    output: OutputChange | None = None
    outputs_moved: int = Field(0, description="how many outputs change, of the design and its variants")
    gone: list[str] = Field([], description="outputs shown now that the version does not have")
    parameters: list[ModelParameterChange] = Field([], description="of CAD models, that would change")
    refusals: list[UpgradeRefused] = Field([], description="a save of the upgrade would be refused")
    give: list[str] = Field([], description="inputs that the version needs and the design does not set")
    remove: list[str] = Field([], description="inputs and limits that the version does not have")
    needs_solids: list[str] = Field([], description="what is not known before a solid is built")


class Impact(Answer):
    """The designs that a version moves, worst first.

    First those with a criterion that is no longer met, then those that refuse the version, then those with a
    criterion that is no longer decided, then the others by margin lost and by change of an output.
    """

    template: Version
    concerned: int = Field(description="designs that use another version of the template")
    moved: int
    refused: int
    needs_solids: int = Field(description="designs of which nothing known moves, and something is not known")
    unchanged: int
    archived: int = Field(description="archived designs that use another version; they are left out")
    variants: int = Field(description="variants that were calculated beside the designs")
    designs: list[DesignImpact] = Field(description="the worst, as many as asked for; unchanged ones never")
