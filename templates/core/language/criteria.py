"""Judge the criteria of a template after its evaluation."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import reduce
from typing import Any

import numpy as np

from templates.core.criteria.bands import Estimate, largest_true
from templates.core.criteria.criterion import Criterion, Limit, MissingValue, is_angle
from templates.core.criteria.evaluation import Absent, Along, Instead, judge
from templates.core.criteria.judgement import Judgement, not_judged, sentence
from templates.core.criteria.limits import GivenLimit
from templates.core.criteria.summary import worst_first
from templates.core.language.admission import absence
from templates.core.language.answer import Answer
from templates.core.language.ledger import Notice
from templates.core.language.levels import Accuracy
from templates.core.language.spec import Curve, Declaration, Formula, Profile
from templates.core.language.template import Template
from templates.core.units.units import Unit, Value

NOT_JUDGED = "check_not_judged"
RIGHT_ANGLE = math.pi / 2  # reference value for the relative errors of angles [rad]


@dataclass
class EvaluatedValues:
    """The evaluated values that criteria use.

    Attributes
    ----------
    template
        The evaluated instance; where levels differ from point to point, the instance of the first level.
    answers
        The outputs that were evaluated.
    errors
        Relative, as `Evaluation.error`; `measured` is the table from which they come.
    is_joined
        Whether the answers come from several instances.
    computed
        The names of outputs that have to be computed here because they were not given.
    """

    template: Template
    answers: Mapping[str, Answer]
    errors: Mapping[str, Any]
    measured: Accuracy | None
    limits: Mapping[str, GivenLimit] = field(default_factory=dict)
    shown_in: Mapping[str, Unit] = field(default_factory=dict)
    level: Any = None
    is_joined: bool = False
    computed: frozenset[str] = field(init=False)
    estimates: dict[str, Estimate | Absent] = field(default_factory=dict, init=False)  # cache

    def __post_init__(self) -> None:
        handed, template = self.template.ledger.handed, self.template
        if handed.isdisjoint(template._results):
            self.computed = template._result_names
        else:
            self.computed = frozenset(n for n, f in template.formulas.items() if f.attribute not in handed)

    def value(self, name: str) -> Value:
        """Return the SI value of an output that exists; NaN where an array has no value."""
        answer, formula = self.answers[name], self.template.formulas[name]
        if self.is_joined:
            return (self.shown_in.get(name) or formula.meaning.scale).to_si(answer.value)
        si: Value = getattr(self.template, formula.attribute)
        if answer.reasons is None:
            return si
        return np.where(np.isnan(answer.value), np.nan, si)


def judged(evaluated: EvaluatedValues) -> list[Judgement]:
    """Return the judgements of the criteria whose outputs were evaluated, worst first."""
    template = evaluated.template
    return worst_first(judged_alone(evaluated, c) for c in template.declared_criteria if is_due(evaluated, c))


def is_due(evaluated: EvaluatedValues, criterion: Criterion) -> bool:
    """Return whether the criterion can be judged without computing further outputs."""
    return evaluated.computed.intersection(criterion.names) <= evaluated.answers.keys()


def missing_of(evaluated: EvaluatedValues, criterion: Criterion) -> MissingValue | None:
    """Return a criterion's rule for a missing value, if another comparison can be judged instead.

    No output is computed beyond those already evaluated.
    """
    for name, missing in criterion.absent.items():
        answer, beside = evaluated.answers.get(name), evaluated.answers.get(missing.beside)
        if missing.instead and answer and beside and is_due(evaluated, missing.instead):
            if _is_missing(answer.value) and not _is_missing(beside.value):
                return missing
    return None


def _is_missing(value: Any) -> bool:
    """Return whether a value is missing at one or more points."""
    return value is None or (np.ndim(value) > 0 and bool(np.isnan(value).any()))


def _instead(evaluated: EvaluatedValues, criterion: Criterion) -> Instead | None:
    missing = missing_of(evaluated, criterion)
    if missing is None or missing.instead is None:
        return None
    estimates, absent = estimates_of(evaluated, missing.instead)
    return Instead(judge(missing.instead, estimates, absent), missing.reason)


def judged_alone(evaluated: EvaluatedValues, criterion: Criterion) -> Judgement:
    """Return the judgement of one criterion whose outputs were evaluated."""
    estimates, absent = estimates_of(evaluated, criterion)
    shown = evaluated.shown_in.get(criterion.subject or "")
    unit_name = shown.text if shown else None
    template = evaluated.template
    along = None if template._curves.isdisjoint(criterion.names) else along_of(template, criterion.names)
    noted = notes(evaluated, criterion)
    instead = _instead(evaluated, criterion) if criterion.absent else None
    return judge(criterion, estimates, absent, along, unit_name, noted=noted, instead=instead)


def notes(evaluated: EvaluatedValues, criterion: Criterion) -> dict[str, str | None]:
    """Return the fields of a judgement that name its level, the truth of its error, and sources of limits."""
    noted = level_and_truth(evaluated, criterion.subject)
    return noted | {"source": _with_those_of_limits(evaluated, criterion)} if evaluated.limits else noted


def level_and_truth(evaluated: EvaluatedValues, output: str | None) -> dict[str, str | None]:
    """Return the level of an evaluation, and the truth against which the error of an output was measured."""
    level, table = evaluated.level if isinstance(evaluated.level, str) else None, evaluated.measured
    return {"level": level, "truth": table.truth(level or "", output) if table and output else None}


def estimates_of(
    evaluated: EvaluatedValues, criterion: Criterion
) -> tuple[dict[str, Estimate], dict[str, Absent]]:
    """Return the values of a criterion's names with their errors, and the reasons for missing values."""
    estimates: dict[str, Estimate] = {}
    absent: dict[str, Absent] = {}
    limits = criterion.limits_by_name
    for name in criterion.limits_last:  # a limit has to fit the other values
        if name in limits:
            one = _limit(evaluated, limits[name], estimates)
        else:
            one = estimate_of(evaluated, name)
        if isinstance(one, Absent):
            missing = criterion.absent.get(name)
            absent[name] = (missing and _stated_reason(evaluated, missing)) or one
        else:
            estimates[name] = one
    return estimates, absent


def _with_those_of_limits(evaluated: EvaluatedValues, criterion: Criterion) -> str | None:
    """Return the source of the criterion, and the sources of limits from a library."""
    given = [evaluated.limits[limit.name] for limit in criterion.limits if limit.name in evaluated.limits]
    sources = [criterion.source, *(limit.source for limit in given)]
    return "; ".join(dict.fromkeys(filter(None, sources))) or None


def estimate_of(evaluated: EvaluatedValues, name: str) -> Estimate | Absent:
    """Return the value of an input or output with its error, or the reason why it is missing."""
    estimate = evaluated.estimates.get(name)
    if estimate is None:
        find = _estimate_of_output if name in evaluated.computed else _estimate_of_input
        estimate = evaluated.estimates[name] = find(evaluated, name)
    return estimate


def _estimate_of_input(evaluated: EvaluatedValues, name: str) -> Estimate | Absent:
    template = evaluated.template
    declared = template.inputs[name]
    si = vars(template).get(declared.attribute)
    if si is None:
        with np.errstate(all="ignore"):
            si = getattr(template, declared.attribute)
    if isinstance(si, float):
        return Estimate(si) if si == si else Absent((name,), f"give {name}")  # NaN means not given
    if not np.ndim(si) and np.isnan(si):
        return Absent((name,), f"give {name}")
    return Estimate(si, axes=1 if isinstance(declared, Curve) and np.ndim(si) else 0)


def _limit(evaluated: EvaluatedValues, limit: Limit, others: Mapping[str, Estimate]) -> Estimate | Absent:
    """Return the user's limit: one for all points, one for each point, or a curve."""
    given = evaluated.limits.get(limit.name)
    if given is None:
        return _default(evaluated, limit) if limit.default else _not_given(limit)
    shape, points = np.shape(given.value), evaluated.template.shape_of_points()
    if not shape or _fits(shape, points):
        return Estimate(given.value)
    curve = next((other for other in others.values() if other.axes), None)
    if curve is not None and _fits(shape, (*points, *np.shape(curve.value)[-curve.axes :])):
        return Estimate(given.value, axes=curve.axes)
    return Absent(
        (), f"{limit.name} has {np.size(given.value)} values, which do not fit those of the calculation"
    )


def _default(evaluated: EvaluatedValues, limit: Limit) -> Estimate | Absent:
    """Return the default of a limit that was not given, if it has one.

    The default is the smallest or largest value of an input that is a list, if the user gave that list.
    """
    if limit.default is not None:
        function, name = limit.default
        with np.errstate(all="ignore"):
            si = getattr(evaluated.template, evaluated.template.inputs[name].attribute)
        if np.ndim(si):
            return Estimate({"min": np.min, "max": np.max}[function](si, axis=-1))
    return _not_given(limit)


def _not_given(limit: Limit) -> Absent:
    return Absent((limit.name,), limit.remedy)


def _stated_reason(evaluated: EvaluatedValues, missing: MissingValue) -> Absent | None:
    """Return the reason that a criterion declares for an output without a value although another has one."""
    beside = evaluated.answers.get(missing.beside)
    return Absent((), missing.reason) if beside and beside.value is not None else None


def _fits(shape: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    """Return whether an array of this shape broadcasts to the wanted shape."""
    try:
        return np.broadcast_shapes(shape, wanted) == wanted
    except ValueError:
        return False


def _estimate_of_output(evaluated: EvaluatedValues, name: str) -> Estimate | Absent:
    template, formula = evaluated.template, evaluated.template.formulas[name]
    answer = evaluated.answers[name]
    if formula.attribute in template.ledger.absent and not np.ndim(answer.value):
        return _absent(template, formula, answer.reason)
    axes = formula.axes if isinstance(formula, Profile) else 0
    error = error_of(evaluated, name)
    scale = None if axes else _scale(evaluated, name)
    if scale is not None and (scale != scale if isinstance(scale, float) else np.isnan(scale).any()):
        error, scale = _where_it_has_a_scale(error, scale)
    return Estimate(evaluated.value(name), error, axes, scale, answer.reasons)


def _where_it_has_a_scale(error: Any, scale: Value) -> tuple[Any, Value | None]:
    """Return the error and its reference value; the error is NaN at points without a reference value."""
    if not np.ndim(scale):
        return float("nan"), None
    return np.where(np.isnan(scale), np.nan, error), scale


def _scale(evaluated: EvaluatedValues, name: str) -> Value | None:
    """Return the reference value of an output's relative error [SI]; None if it is the output itself.

    For several reference outputs, such as the four stiffnesses, the largest counts, enlarged to the largest
    true value that its own error allows. NaN means that the reference quantity is not an output. The error of
    an angle is relative to 90°.
    """
    table = evaluated.measured.content.get("relative_to", {}) if evaluated.measured else {}
    if name not in table:
        return RIGHT_ANGLE if is_angle(evaluated.template.formulas[name].meaning.unit) else None
    others = table[name]
    if not isinstance(others, list):
        return float("nan") if others is None else float(others)
    assert evaluated.measured is not None
    template, errors = evaluated.template, evaluated.measured.of(evaluated.template, [name, *others])
    sizes = {other: np.abs(getattr(template, template.formulas[other].attribute)) for other in others}
    largest = reduce(np.fmax, [largest_true(sizes[other], errors[other]) for other in others])
    return largest * np.maximum(1 - errors[name], 1e-12)  # `band_relative_to` divides by it


def _absent(template: Template, formula: Formula[Any], reason: str | None) -> Absent:
    """Return the reason why an output is missing: the optional inputs to give, or its own reason."""
    missing = sorted(template.ledger.missing & template.ancestors(formula.attribute))
    give = tuple(template.declarations[attribute].name for attribute in missing)
    return Absent(give, reason or absence(template, formula))


def error_of(evaluated: EvaluatedValues, name: str) -> Any:
    """Return the relative error of an output; NaN if it is unknown.

    A line of a design defines its result, so it adds no error of its own. Otherwise the error is unknown if
    the template has no measured errors, or has no levels and no entry for the output.
    """
    sheet = evaluated.template.sheet
    if sheet is not None and sheet.is_exact:
        return 0.0
    error, table = evaluated.errors.get(name), evaluated.measured
    if error is None or table is None or not (evaluated.template.levels or name in table.outputs):
        return float("nan")
    return error


def along_of(template: Template, names: Iterable[str]) -> Along | None:
    """Return the places along the first curve among the given names, if there is one."""
    for name in names:
        curve = template.formulas.get(name)
        if isinstance(curve, Profile) and curve.axes == 1:
            axis = template.inputs.get(curve.along) or template.formulas.get(curve.along)
            if axis is not None:
                return _places(template, axis)
    return None


def _places(template: Template, axis: Declaration) -> Along | None:
    with np.errstate(all="ignore"):
        values = getattr(template, axis.attribute)
    return (
        Along(axis.name, axis.meaning.scale.from_si(values), axis.meaning.unit) if np.ndim(values) else None
    )


def warned(cls: type[Template], judgements: list[Judgement]) -> Iterator[Notice]:
    """Yield a warning for every criterion that declares one and whose value violates its limit.

    The warning is also given if the verdict is undecided because the limit lies within the error: a film of
    1 nm gives a warning even if its error is unknown. A check of a worksheet that cannot be judged gives a
    warning too.
    """
    for judgement in judgements:
        if judgement.warning and judgement.misses:
            yield Notice(judgement.warning, _about(cls, judgement), sentence(judgement))
        elif cls.sheet and judgement.warning and judgement.reason and judgement.verdict == "not_checked":
            yield Notice(NOT_JUDGED, _about(cls, judgement), not_judged(judgement))


def _about(cls: type[Template], judgement: Judgement) -> str:
    """Return the name that a warning concerns: the first name of its criterion."""
    return next(c for c in cls.declared_criteria if c.name == judgement.name).names[0]
