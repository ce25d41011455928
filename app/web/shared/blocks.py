"""Prepare the steps and models of a design or revision for its page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from app.calculations.schemas.evaluations import Output
from app.catalogue.schemas.declarations import properties, required
from app.catalogue.schemas.library import LibraryTable
from app.catalogue.schemas.templates import Template
from app.designs.schemas.designs import (
    Design,
    ParameterChange,
    PreviewedStep,
    Revision,
    RevisionModel,
    RevisionWorksheet,
    RoundedValue,
)
from app.reports.pictures import Picture, pictures
from app.schemas.answers import Shown
from app.solids.schemas.models import CadModel as Model
from app.web.shared import sheet
from app.web.shared.limits import limit_fields, with_rows
from app.web.shared.sheet import Field

MOST_AT_ONCE = 16  # largest number of results shown at first


@dataclass(frozen=True)
class StepBlock:
    """A step with its results and pictures; on the page of a design also with its fields."""

    name: str
    template: Template
    result: PreviewedStep
    outputs: list[str]
    pictures: list[Picture]
    fields: list[Field] = field(default_factory=list)
    options: list[Field] = field(default_factory=list)
    limits: list[Field] = field(default_factory=list)
    keys: list[str] = field(default_factory=list)  # outputs in the summary line

    @property
    def main(self) -> list[str]:
        """Return the results shown first: all if they are few, otherwise those that no formula uses."""
        if len(self.outputs) <= MOST_AT_ONCE:
            return self.outputs
        used = {name for formula in self.template.formulas for name in formula.uses}
        return [
            name for name in self.outputs if name in self.keys or (name not in used and self._has_value(name))
        ]

    def _has_value(self, name: str) -> bool:
        return self.result.pending or self.result.outputs[name].value is not None

    @property
    def intermediate(self) -> list[str]:
        """Return the results that are folded at first."""
        main = set(self.main)
        return [name for name in self.outputs if name not in main]

    @property
    def has_faults(self) -> bool:
        """Return whether one of its fields contains a refused value."""
        return any(one.error for one in (*self.fields, *self.options, *self.limits))


@dataclass(frozen=True)
class ModelBlock:
    """A model; on the page of a design also with its fields and the previous values of its parameters."""

    name: str
    model: Model
    values: Mapping[str, Shown]
    fields: list[Field] = field(default_factory=list)
    old: Mapping[str, Shown] = field(default_factory=dict)
    status: Mapping[str, str | None] = field(default_factory=dict)

    @property
    def targets(self) -> set[str]:
        """Return the names that the model's parameters have in the design."""
        return {f"{self.name}.{tail}" for tail in properties(self.model.parameters)}


@dataclass(frozen=True)
class Refusal:
    """The texts of a refused form, and its faults by name; all empty if no form was refused.

    `typed` are fields of the worksheet; `part` is the form for one parameter, analysis or iteration.
    """

    typed: Mapping[str, str] = field(default_factory=dict)
    faults: Mapping[str, str] = field(default_factory=dict)
    part: Mapping[str, str] = field(default_factory=dict)


def steps_of(
    revision: RevisionWorksheet,
    templates: Mapping[str, Template],
    computed: Mapping[str, Sequence[str] | None] | None = None,
) -> list[StepBlock]:
    """Return every step with its results and pictures.

    If only some outputs are computed, `computed` names them.
    """
    return [
        _step(name, template, revision.steps[name], (computed or {}).get(name))
        for name, template in templates.items()
    ]


def _step(name: str, template: Template, step: PreviewedStep, computed: Sequence[str] | None) -> StepBlock:
    declared = list(properties(template.outputs))
    result = _with_places(step, computed or declared) if step.pending else step
    outputs = [output for output in declared if output in result.outputs]
    return StepBlock(name, template, result, outputs, pictures(template, step))


def _with_places(step: PreviewedStep, names: Iterable[str]) -> PreviewedStep:
    """Return a step without results yet, with empty places that the page's script will fill in."""
    waiting = Output(value=None, reason="is not calculated yet")
    names = list(names)
    return step.model_copy(update={"outputs": dict.fromkeys(names, waiting), "error": dict.fromkeys(names)})


def with_result(block: StepBlock, written: PreviewedStep | None) -> StepBlock:
    """Return a step with its results, and with its formulas if they are `written` out."""
    return block if written is None or written.pending else replace(block, result=written)


def with_fields(
    block: StepBlock,
    design: Design,
    refusal: Refusal,
    tables: Sequence[LibraryTable],
    rounded: Mapping[str, RoundedValue],
) -> StepBlock:
    """Return a step of a design with the fields of its form; `tables` are the tables of the library."""
    step, template, result = design.steps[block.name], block.template, block.result
    used = {} if result.pending or not result.outputs else result.inputs
    typed, faults = refusal.typed, refusal.faults
    chosen = {"level": step.level, "tolerance": step.tolerance}
    return replace(
        block,
        fields=with_rows(
            sheet.of_block(template.inputs, block.name, step.inputs, used, typed, faults, rounded), tables
        ),
        options=sheet.of_options(template, block.name, chosen, typed, faults),
        limits=limit_fields(template, block.name, step.limits, typed, faults, tables),
    )


def models_of(revision: Revision, models: Mapping[str, Model]) -> list[ModelBlock]:
    """Return every model with the values of its parameters."""
    return [ModelBlock(name, model, revision.models[name].parameters) for name, model in models.items()]


def with_changes(
    block: ModelBlock,
    design: Design,
    refusal: Refusal,
    before: Revision | None,
    previewed: Mapping[str, ParameterChange],
    rounded: Mapping[str, RoundedValue],
) -> ModelBlock:
    """Return a model of a design with the fields of its form, and its changes since the previous revision."""
    name, values, schema = block.name, block.values, block.model.parameters
    cells = design.models[name].parameters
    status = {tail: _status(previewed.get(f"{name}.{tail}")) for tail in values}
    return replace(
        block,
        fields=sheet.of_block(schema, name, cells, values, refusal.typed, refusal.faults, rounded),
        old=_changed(before.models.get(name) if before else None, values),
        status=status or dict.fromkeys(required(schema), "missing"),
    )


def _status(change: ParameterChange | None) -> str | None:
    return change.status if change else None


def _changed(before: RevisionModel | None, values: Mapping[str, Shown]) -> dict[str, Shown]:
    """Return the previous values of a model's parameters that have changed."""
    old = before.parameters if before else {}
    return {name: value for name, value in old.items() if value != values.get(name)}


def painted(steps: Iterable[StepBlock], models: Sequence[ModelBlock]) -> dict[str, object] | None:
    """Return the film pressure to show in colour on a plain bearing.

    It is the pressure of the step whose bearing diameter drives the bore.
    """
    bores = {block.name: block.model.film_bore for block in models if block.model.film_bore}
    texts = {field.name: field.text for block in models for field in block.fields}
    for step in steps:
        pressure = next((picture for picture in step.pictures if picture.kind == "pressure"), None)
        for model, bore in bores.items():
            if pressure and f"{step.name}.bearing_diameter" in texts.get(f"{model}.{bore}", ""):
                return {**pressure.for_script(step.name), "model": model}
    return None
