"""A revision as a worksheet: its steps with written-out formulas, in one system of units."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Mapping
from threading import Lock
from typing import NamedTuple, Self

import numpy as np
from cachetools import LRUCache

from app.calculations.cache import results as cache
from app.calculations.json_values import identity
from app.calculations.schemas.evaluations import UsedInput, WorkedFormula
from app.calculations.worksheet import formulas
from app.designs.engine.calculation import Calculation
from app.designs.schemas.designs import PreviewedStep, Revision, RevisionStep, RevisionWorksheet
from app.plain import JsonObject, Raw
from app.pool.errors import StepDeferred
from app.pool.steps import evaluated_step, fingerprint
from app.presentation.units import System
from templates.core.catalogue.discovery import Catalogue
from templates.core.catalogue.modules import is_outside
from templates.core.errors import TemplateError
from templates.core.language.evaluate import Evaluation
from templates.core.language.record import restored
from templates.core.language.template import Template
from templates.core.paper.verdicts import Check, checks


def worksheet(
    revision: Revision,
    catalogue: Catalogue[Template],
    system: System,
    *,
    only: str | None = None,
    has_formulas: bool = True,
) -> RevisionWorksheet:
    """Return a revision with `formulas`, for the inputs and the levels that its job used.

    With `only` it contains only that step. Unless `has_formulas`, no formulas are written out.

    Raises
    ------
    KeyError
        If the revision has no such step.
    """
    chosen = revision.steps if only is None else {only: revision.steps[only]}
    steps = {
        name: _with_formulas(step, _written_out(step, catalogue, system) if has_formulas else [], system)
        for name, step in chosen.items()
    }
    models = {name: model.in_units(system) for name, model in revision.models.items()}
    fields = {name: getattr(revision, name) for name in revision.model_fields_set}
    if revision.criteria is not None:
        fields["criteria"] = [criterion.in_units(system) for criterion in revision.criteria]
    if revision.rounded:
        fields["rounded"] = [value.in_units(system) for value in revision.rounded]
    return RevisionWorksheet.model_validate({**fields, "steps": steps, "models": models})


def previewed(
    calculation: Calculation, steps: Mapping[str, RevisionStep], system: System
) -> dict[str, PreviewedStep]:
    """Return the steps of a preview with `formulas`; a step that waits for a solid has none."""
    evaluations = calculation.evaluations
    written = {name: _formulas(e.template, system, e.outputs) for name, e in evaluations.items()}
    return {name: _with_formulas(step, written.get(name, []), system) for name, step in steps.items()}


def _with_formulas(step: RevisionStep, rows: list[WorkedFormula], system: System) -> PreviewedStep:
    """Return a step with formulas in a system of units; its inputs stay as typed."""
    shown = step.in_units(system)
    fields = {name: getattr(shown, name) for name in shown.model_fields_set}
    return PreviewedStep.model_validate({**fields, "inputs": step.inputs, "formulas": rows})


def checked(step: RevisionStep, catalogue: Catalogue[Template]) -> list[Check]:
    """Return every bound and rule of a revision's step, compared with its values.

    The list is empty if the values are unknown.
    """
    template = _calculated(step, catalogue, with_arrays=True)
    return [] if template is None else list(checks(template))


def _written_out(step: RevisionStep, catalogue: Catalogue[Template], system: System) -> list[WorkedFormula]:
    """Return the formulas of a revision's step; none if their values are unknown."""
    template = _calculated(step, catalogue)
    return [] if template is None else _formulas(template, system, step.outputs)


def _calculated(
    step: RevisionStep, catalogue: Catalogue[Template], *, with_arrays: bool = False
) -> Template | None:
    """Return the template of a step that has results, restored from its record or recalculated.

    It is recalculated if the revision has no record, if the version has changed since, or if arrays are
    requested, which the record omits. It is None if the step has no results, if the calculation is deferred,
    or if the file of the version was removed or now refuses the inputs.
    """
    if not step.outputs:
        return None
    try:
        cls = catalogue.get(step.template.id, step.template.version)
        if step.record and identity(cls)["digest"] == step.template.digest:
            if not (with_arrays and step.record.has_arrays):
                return restored(cls, step.record, step.level if isinstance(step.level, str) else None)
        return None if _is_edited(cls, step) else _evaluated(cls, step).template
    except (TemplateError, StepDeferred):
        return None


def _is_edited(cls: type[Template], step: RevisionStep) -> bool:
    """Return whether a team has edited the template's file since the step was calculated."""
    return is_outside(cls) and step.template.digest not in (None, identity(cls)["digest"])


def _retyped(used: UsedInput) -> Raw:
    """Return a used input in the form in which a user would type it."""
    if "unit" not in used.model_fields_set:
        return used.value
    return {name: getattr(used, name) for name in used.model_fields_set if name != "source"}


class _Question(NamedTuple):
    """The inputs and options of a revision's step, in the form needed to recalculate it."""

    inputs: dict[str, Raw]
    outputs: tuple[str, ...]
    level: str | None

    @classmethod
    def of(cls, step: RevisionStep) -> Self:
        used = {name: value for name, value in step.inputs.items() if isinstance(value, UsedInput)}
        given = {name: _retyped(value) for name, value in used.items() if value.source == "given"}
        level = step.level if isinstance(step.level, str) else None
        return cls(given, tuple(sorted(step.outputs)), level)  # sorted, as the database stores them

    def key(self, cls: type[Template]) -> Hashable:
        return (_Question, fingerprint(self.inputs), self.outputs, self.level, cls)


def remember(answer: JsonObject, evaluation: Evaluation) -> None:
    """Cache the evaluation of an expensive step, so that its worksheet need not calculate it again."""
    question = _Question.of(RevisionStep.model_validate(answer))
    cache.keep(question.key(type(evaluation.template)), evaluation)


def _formulas(template: Template, system: System, names: Collection[str]) -> list[WorkedFormula]:
    """Return the written-out formulas; they are cached by the template's values."""
    key = _values_of(template)
    if key is None:
        return [WorkedFormula.model_validate(row) for row in formulas(template, system, names)]
    asked = (type(template), template.level, system, tuple(sorted(names)), key)
    with _writing:
        written: list[WorkedFormula] | None = _written.get(asked)
    if written is None:
        written = [WorkedFormula.model_validate(row) for row in formulas(template, system, names)]
        with _writing:
            _written[asked] = written
    return written


_written: LRUCache[Hashable, list[WorkedFormula]] = LRUCache(256)  # formulas of steps, about 40 kB each
_writing = Lock()


def _values_of(template: Template) -> Hashable | None:
    """Return the single values of the template, which determine its formulas; None if it has arrays."""
    values = [vars(template).get(attribute) for attribute in template.declarations]
    if any(isinstance(value, (np.ndarray, tuple)) for value in values):
        return None
    return tuple("none" if value != value else value for value in values)  # NaN does not equal itself


def _evaluated(cls: type[Template], step: RevisionStep) -> Evaluation:
    """Return a step as its job evaluated it; it is cached, because a revision never changes."""
    question = _Question.of(step)
    kept: Evaluation | None = cache.get(question.key(cls))
    if kept is None:
        kept = evaluated_step(cls, *question, None)
        cache.keep(question.key(cls), kept)
    return kept
