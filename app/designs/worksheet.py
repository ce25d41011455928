"""A revision as a worksheet shows it: the steps with their formulas written out, in one system of units."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import NamedTuple, Self

from app.calculations.begun import fingerprint
from app.calculations.cache import results as kept
from app.calculations.cost import EXPENSIVE
from app.calculations.errors import StepDeferred
from app.calculations.steps import evaluated_step
from app.calculations.worksheet import formulas
from app.designs.calculate import Calculation
from app.plain import JsonObject, Raw
from app.presentation.units import System
from app.schemas.designs import PreviewedStep, Revision, RevisionStep, RevisionWorksheet
from app.schemas.evaluations import UsedInput, WorkedFormula
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
from templates.core.language.evaluate import Evaluation
from templates.core.language.template import Template
from templates.core.paper.verdicts import Check, checks


def worksheet(revision: Revision, catalogue: Catalogue[Template], system: System) -> RevisionWorksheet:
    """A revision with `formulas`, from the inputs and at the level that its job used."""
    steps = {
        name: _with_formulas(step, _worked(step, catalogue, system).formulas, system)
        for name, step in revision.steps.items()
    }
    models = {name: model.in_units(system) for name, model in revision.models.items()}
    fields = {name: getattr(revision, name) for name in revision.model_fields_set}
    if revision.criteria is not None:
        fields["criteria"] = [criterion.in_units(system) for criterion in revision.criteria]
    return RevisionWorksheet.model_validate({**fields, "steps": steps, "models": models})


def previewed(
    calculation: Calculation, steps: Mapping[str, RevisionStep], system: System
) -> dict[str, PreviewedStep]:
    """The steps of a preview with `formulas`; a step that waits for a solid has none yet."""
    evaluations = calculation.evaluations
    written = {name: _formulas(evaluation, system) for name, evaluation in evaluations.items()}
    return {name: _with_formulas(step, written.get(name, []), system) for name, step in steps.items()}


def _with_formulas(step: RevisionStep, rows: list[WorkedFormula], system: System) -> PreviewedStep:
    """A step in a system of units, its inputs as typed."""
    shown = step.in_units(system)
    fields = {name: getattr(shown, name) for name in shown.model_fields_set}
    return PreviewedStep.model_validate({**fields, "inputs": step.inputs, "formulas": rows})


def checked(step: RevisionStep, catalogue: Catalogue[Template]) -> list[Check]:
    """Every bound and rule of a revision's step, held against its values."""
    return _worked(step, catalogue, "si").checks


class _Worked(NamedTuple):
    """What follows from a step that is calculated again."""

    formulas: list[WorkedFormula]
    checks: list[Check]


def _worked(step: RevisionStep, catalogue: Catalogue[Template], system: System) -> _Worked:
    """Formulas and checks of a step that has results, calculated as its job did; none if it is deferred."""
    if not step.outputs:
        return _Worked([], [])
    try:
        return _written_out(catalogue.get(step.template.id, step.template.version), step, system)
    except TemplateError:  # the file of this version was taken away, or changed: its results stay
        return _Worked([], [])
    except StepDeferred:
        return _Worked([], [])


def _retyped(used: UsedInput) -> Raw:
    """An input as it was used, as one that can be given again."""
    if "unit" not in used.model_fields_set:
        return used.value
    return {name: getattr(used, name) for name in used.model_fields_set if name != "source"}


class _Question(NamedTuple):
    """What a revision's step was asked, as it can be asked again."""

    inputs: dict[str, Raw]
    outputs: tuple[str, ...]
    level: str | None

    @classmethod
    def of(cls, step: RevisionStep) -> Self:
        used = {name: value for name, value in step.inputs.items() if isinstance(value, UsedInput)}
        given = {name: _retyped(value) for name, value in used.items() if value.source == "given"}
        level = step.level if isinstance(step.level, str) else None
        return cls(given, tuple(sorted(step.outputs)), level)  # as the database has them

    def key(self, *more: type[Template] | System) -> Hashable:
        return (_Question, fingerprint(self.inputs), self.outputs, self.level, *more)


def remember(answer: JsonObject, evaluation: Evaluation) -> None:
    """Keep the evaluation of an expensive step, so that its worksheet does not calculate it again."""
    if evaluation.seconds > EXPENSIVE:
        question = _Question.of(RevisionStep.model_validate(answer))
        kept.keep(question.key(type(evaluation.template)), evaluation)


def _formulas(evaluation: Evaluation, system: System) -> list[WorkedFormula]:
    rows = formulas(evaluation.template, system, evaluation.outputs)
    return [WorkedFormula.model_validate(row) for row in rows]


def _written_out(cls: type[Template], step: RevisionStep, system: System) -> _Worked:
    """Formulas and checks, kept because a revision never changes."""
    question = _Question.of(step)
    key = question.key(cls, system)
    written: _Worked | None = kept.get(key)
    if written is None:
        evaluation = kept.get(question.key(cls)) or evaluated_step(cls, *question, None)
        written = _Worked(_formulas(evaluation, system), list(checks(evaluation.template)))
        kept.keep(key, written)
    return written
