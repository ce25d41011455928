"""The response schema for the effect of a template version on designs that use another version."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity, Version
from app.schemas.criteria import Word

Effect = Literal["moved", "refused", "needs_solids"]
"""`needs_solids`: no known value changes, but some values need a solid that is not built yet."""


class StepUse(Answer):
    """A step that uses another version of the template."""

    step: str
    version: int = Field(description="the version that the step uses now")


class CriterionChange(Answer):
    """A criterion whose verdict changes; null where a version has no such criterion.

    A criterion that only the new version has is listed if it is not met or undecided.
    """

    name: str
    variant: str | None = Field(None, description="name of the variant; absent for the design itself")
    old: Word | None
    new: Word | None


class MarginLost(Answer):
    """The criterion whose margin decreases most."""

    name: str
    variant: str | None = Field(None, description="name of the variant; absent for the design itself")
    old: Quantity
    new: Quantity
    lost: Quantity = Field(description="old margin minus new margin")
    relative: float | None = Field(
        description="lost / old margin, above 1 if no margin is left; null if there was none before"
    )


class OutputChange(Answer):
    """The output that changes most; for a curve, its value where it changes most. Null means no value."""

    name: str = Field(description="name as in relations: `film.minimum_film_thickness`")
    variant: str | None = Field(None, description="name of the variant; absent for the design itself")
    old: Quantity | None
    new: Quantity | None
    change: float | None = Field(
        description="(new − old) / |old|, for a curve relative to its largest value; null for temperatures, "
        "for an old value of 0, and if either value is missing"
    )


class ModelParameterChange(Answer):
    """A parameter of a CAD model that would change, so that the solid would be rebuilt."""

    name: str = Field(description="name such as `shell.inner_diameter`")
    variant: str | None = Field(None, description="name of the variant; absent for the design itself")
    old: Quantity | None
    new: Quantity | None


class UpgradeRefused(Answer):
    """A reason for which the service would refuse the upgrade of a design, as the save would state it."""

    name: str
    variant: str | None = Field(None, description="name of the variant; absent for the design itself")
    code: str
    detail: str


class DesignImpact(Answer):
    """One design, calculated with the new version in place of the versions that it uses."""

    design: str
    name: str
    revision: int = Field(description="the newest revision, which was calculated")
    effect: Effect
    steps: list[StepUse]
    verdicts: list[CriterionChange] = Field([], description="verdicts that change; met → not met first")
    margin: MarginLost | None = None
    output: OutputChange | None = None
    outputs_moved: int = Field(0, description="number of outputs of the design and its variants that change")
    gone: list[str] = Field([], description="present outputs that the new version does not have")
    parameters: list[ModelParameterChange] = Field(
        [], description="parameters of CAD models that would change"
    )
    refusals: list[UpgradeRefused] = Field(
        [], description="reasons for which the service would refuse the upgrade"
    )
    give: list[str] = Field([], description="inputs that the version requires and the design does not set")
    remove: list[str] = Field([], description="inputs and limits that the version does not have")
    needs_solids: list[str] = Field([], description="values that are unknown until a solid is built")


class Impact(Answer):
    """The designs that a version would change, worst first.

    First come designs with a criterion that is no longer met, then those that refuse the version, then those
    with a criterion that is no longer decided, then the others by margin lost and by change of an output.
    """

    template: Version
    concerned: int = Field(description="designs that use another version of the template")
    moved: int
    refused: int
    needs_solids: int = Field(
        description="designs of which no known value changes, but some values are unknown"
    )
    unchanged: int
    archived: int = Field(
        description="number of archived designs that use another version; they are not calculated"
    )
    variants: int = Field(description="number of variants calculated in addition to the designs")
    designs: list[DesignImpact] = Field(
        description="the most affected designs, up to `limit`; never unchanged ones"
    )
