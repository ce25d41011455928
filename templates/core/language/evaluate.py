"""Evaluate a template: turn a user's inputs into named answers, and compute only the requested outputs."""

from __future__ import annotations

import re
import time
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.criteria.judgement import Judgement
from templates.core.criteria.limits import GivenLimit
from templates.core.language import tolerances
from templates.core.language.admission import absence
from templates.core.language.answer import Answer, UsedInput
from templates.core.language.calculation import Calculation
from templates.core.language.criteria import EvaluatedValues, judged, warned
from templates.core.language.intake import remarks
from templates.core.language.ledger import Notice
from templates.core.language.level_choice import Rung, climb
from templates.core.language.levels import accuracy, at_level
from templates.core.language.request import read_request
from templates.core.language.spec import Choice, Derived, Formula, Given, Input, Profile, Text
from templates.core.language.template import Template
from templates.core.language.unmet import unmet
from templates.core.units.quantity import TypedQuantity, Unit

_AMOUNT = re.compile(r"-?[0-9][0-9.e+-]* ?[A-Za-z]*")


@dataclass(frozen=True)
class Assumption:
    """An assumption behind an answer that errs on the unsafe side.

    It comes from the model (`assumptions`), from a default that declares `assumed=`, or from a limit that the
    template itself provides. `name` is the input or criterion, empty for the model. An assumption is no fault
    of the answer, so it is not a warning.
    """

    name: str
    detail: str


@dataclass(frozen=True)
class Evaluation:
    """The result of `evaluate`; `template` is the evaluated instance with every SI value that it computed.

    `level` and `error` (relative; None or NaN where it was not measured) are single values, or arrays of the
    shape of the outputs. `criteria` are the judged criteria of the template that use only these outputs,
    worst first.
    """

    template: Template
    inputs: dict[str, UsedInput]
    outputs: dict[str, Answer]
    level: Any
    error: dict[str, Any]
    warnings: list[Notice]
    seconds: float
    criteria: list[Judgement] = field(default_factory=list)

    def count(self) -> int:
        """Return the total number of values of all outputs."""
        return sum(
            answer.value.size if isinstance(answer.value, np.ndarray) else 1
            for answer in self.outputs.values()
        )


def evaluate(
    cls: type[Template],
    raw: Mapping[str, Any],
    *,
    outputs: Iterable[str] | None = None,
    units: Mapping[str, str] | None = None,
    level: str | None = None,
    tolerance: float | None = None,
    limits: Mapping[str, Any] | None = None,
    per_point: bool = False,
    judge: bool = True,
) -> Evaluation:
    """Evaluate the named outputs (all, if None) for inputs as a user types them.

    `units` gives other units for outputs. Arrays of inputs give arrays of outputs. With a `tolerance` one
    level serves all points, unless `per_point` requests the cheapest level at each point. `limits` are the
    limits that the template's criteria expect from the user; criteria are judged only if `judge` is true.

    Raises
    ------
    InvalidInputs
        If anything in the request is wrong, with all faults at once, or if a result is outside its domain.
    """
    start = time.perf_counter()
    request = read_request(cls, raw, outputs, units, level, limits)
    template, names, shown_in = request.template, request.names, request.shown_in
    with np.errstate(all="ignore"):
        rungs = _rungs(template, names, level, tolerance, per_point)
        parts = [_part(rung.template, names, shown_in) for rung in rungs]
        whole = parts[0] if rungs[0].where is None else _joined(rungs, parts)
        echoes = echoes_of(template)
        criteria = _judged(rungs, whole, shown_in, request.limits) if judge and cls.declared_criteria else []
    notices = [*_standing(cls, template.ledger.typed), *_noticed(rungs)]
    if tolerance is not None:
        values = {name: answer.value for name, answer in whole.answers.items()}
        notices += unmet(cls, values, whole.error, whole.level, tolerance)
    notices += warned(cls, criteria)
    seconds = time.perf_counter() - start
    return Evaluation(
        rungs[0].template, echoes, whole.answers, whole.level, whole.error, notices, seconds, criteria
    )


def _judged(
    rungs: list[Rung], whole: _Part, shown_in: Mapping[str, Unit], limits: Mapping[str, GivenLimit]
) -> list[Judgement]:
    """Return the judgements of the criteria whose outputs were evaluated."""
    template, is_joined = rungs[0].template, rungs[0].where is not None
    measured = accuracy(type(template))
    return judged(
        EvaluatedValues(
            template, whole.answers, whole.error, measured, limits, shown_in, whole.level, is_joined=is_joined
        )
    )


@dataclass(frozen=True, slots=True)
class _Part:
    """The answers at one level, or the joined answers of all levels."""

    answers: dict[str, Answer]
    level: Any
    error: dict[str, Any]


def _rungs(
    template: Template, names: list[str], level: str | None, tolerance: float | None, per_point: bool
) -> list[Rung]:
    if not template.levels:
        return [Rung(template, None)]
    if level is None and tolerance is not None:
        return list(climb(template, names, tolerance, per_point=per_point))
    return [Rung(at_level(template, level or template.starting_level()), None)]


def _part(template: Template, names: list[str], shown_in: Mapping[str, Unit]) -> _Part:
    measured = accuracy(type(template))
    answers = _answers(template, names, shown_in)
    error = measured.of(template, names) if measured else dict.fromkeys(names)
    return _Part(answers, template.level or None, error)


def _joined(rungs: list[Rung], parts: list[_Part]) -> _Part:
    """Return the answers of several levels, each computed at its own points, as arrays over all points."""
    answers = {
        name: _joined_answer(rungs, rungs[0].template.formulas[name], [part.answers[name] for part in parts])
        for name in parts[0].answers
    }
    error = {name: _scattered(rungs, [part.error[name] for part in parts], float) for name in parts[0].error}
    return _Part(answers, _scattered(rungs, [part.level for part in parts], object), error)


def _joined_answer(rungs: list[Rung], formula: Formula[Any], answers: list[Answer]) -> Answer:
    unit = answers[0].unit
    places = np.shape(answers[0].value)[-formula.axes :] if isinstance(formula, Profile) else ()
    values = _scattered(rungs, [answer.value for answer in answers], float if unit else object, places)
    if all(answer.reasons is None for answer in answers):
        return Answer(values, unit)
    return Answer(values, unit, reasons=_scattered(rungs, [answer.reasons for answer in answers], object))


def _scattered(
    rungs: list[Rung], values: list[Any], kind: type, places: tuple[int, ...] = ()
) -> NDArray[Any]:
    assert rungs[0].where is not None
    whole: NDArray[Any] = np.empty(rungs[0].where.shape + places, dtype=kind)
    for rung, value in zip(rungs, values, strict=True):
        whole[rung.where] = value
    return whole


def _answers(template: Template, names: list[str], shown_in: Mapping[str, Unit]) -> dict[str, Answer]:
    """Return outputs in their units; an output that is neither an array nor text is a single value."""
    answers, absent = {}, template.ledger.absent
    for name in names:
        formula = template.formulas[name]
        si = getattr(template, formula.attribute)
        if isinstance(formula, Text):
            answers[name] = _words(template, formula, si)
            continue
        scale = shown_in.get(name) or formula.meaning.scale
        if formula.attribute in absent:
            answers[name] = Answer(None, scale.text, reason=absent[formula.attribute])
        elif isinstance(si, np.ndarray):
            finite = np.where(np.isinf(scale.from_si(si)), np.nan, si)
            value, reasons = _with_reasons(template, formula, finite)
            answers[name] = Answer(scale.from_si(value), scale.text, reasons=reasons)
        elif (shown := float(scale.from_si(si))) in (np.inf, -np.inf):
            answers[name] = Answer(None, scale.text, reason=f"too large for a number of {scale.text}")
        else:
            answers[name] = Answer(shown, scale.text)
    return answers


def _words(template: Template, formula: Text[Any], value: Any) -> Answer:
    """Return an answer that is text.

    An empty text means that there is no answer; points that are masked upstream have none either.
    """
    why = absence(template, formula) or "there is nothing to tell here"
    if isinstance(value, str):
        return Answer(value or None, None, reason=None if value else why)
    beneath = template.depends_on(formula.attribute)
    masks = [m for m in template.ledger.masks if not (m.explains or beneath.isdisjoint(m.names))]
    shape = reduce(np.broadcast_shapes, (mask.where.shape for mask in masks), value.shape)
    texts = np.broadcast_to(value, shape).astype(object)
    reasons = np.full(shape, None, dtype=object)
    reasons[texts == ""] = why
    for mask in reversed(masks):
        reasons[np.broadcast_to(mask.where, shape)] = mask.reason
    texts[reasons != None] = None  # noqa: E711
    return Answer(texts, None, reasons=reasons if reasons.any() else None)


def _with_reasons(
    template: Template, formula: Formula[Any], si: Array
) -> tuple[Array, NDArray[np.object_] | None]:
    """Return the values with NaN where an upstream mask applies, and the reason for each NaN.

    A profile has a single reason. If several reasons apply, an invalid upstream value takes precedence over
    one that is merely absent.
    """
    beneath = template.depends_on(formula.attribute)
    profile = formula if isinstance(formula, Profile) else None
    masks = [mask for mask in template.ledger.masks if not beneath.isdisjoint(mask.names)]
    masks.sort(key=lambda mask: mask.explains)
    if not masks and not np.isnan(si).any():
        return si, None
    points = si.shape[: -profile.axes] if profile else si.shape
    shape = reduce(np.broadcast_shapes, (mask.where.shape for mask in masks), points)
    covering = (mask.where for mask in masks if not mask.explains)
    covered = reduce(np.logical_or, covering, np.zeros(shape, dtype=bool))
    value = np.where(profile.spread(covered) if profile else covered, np.nan, si)
    holes = ~profile.inside(~np.isnan(value)) if profile else np.isnan(value)
    reasons = np.full(shape, None, dtype=object)
    reasons[holes] = "the formula has no finite value here"
    for mask in reversed(masks):
        reasons[np.broadcast_to(mask.where, shape) & holes] = mask.reason
    return value, reasons


def is_reported(template: Template, declared: Input) -> bool:
    """Return whether an answer lists an input as used.

    This is true if the input is given, or has a default that is not also an output.
    """
    if declared.name in template.ledger.typed:
        return True
    if isinstance(declared, Derived):
        return not (declared.shown or np.all(np.isnan(getattr(template, declared.attribute))))
    return not (isinstance(declared, Given) and declared.optional)


def echoes_of(template: Template) -> dict[str, UsedInput]:
    """Return the inputs as the calculation used them: given ones, and defaults that an answer lists."""
    echoes, given = {}, template.ledger.typed
    for name, declared in template.inputs.items():
        typed = given.get(name)
        if isinstance(typed, TypedQuantity):
            echoes[name] = UsedInput(typed.value, typed.unit, "given", typed.extra)
        elif typed is None and isinstance(declared, Given) and declared.default and not declared.optional:
            echoes[name] = default_of(declared)
        elif typed is not None or is_reported(template, declared):
            echoes[name] = _echo(template, declared, typed)
    return echoes


def _echo(template: Template, declared: Input, typed: str | None) -> UsedInput:
    """Return the value that was used for an input that is a choice, or whose default is a formula."""
    value = getattr(template, declared.attribute)
    source = "default" if typed is None else "given"
    return (
        UsedInput(value, None, source, {})
        if isinstance(declared, Choice)
        else _shown(declared, value, source)
    )


@lru_cache(maxsize=4096)  # bounded, because worksheets keep adding inputs
def default_of(declared: Given) -> UsedInput:
    """Return the constant default of an input."""
    assert declared.default is not None
    return _shown(declared, declared.default.si, "default")


def _shown(declared: Given | Derived[Any], si: Any, source: str) -> UsedInput:
    shown = declared.meaning.scale.from_si(si)
    plain = _with_nulls(shown) if isinstance(shown, np.ndarray) else float(shown)
    return UsedInput(plain, declared.meaning.unit, source, {})


def _with_nulls(shown: Array) -> list[Any]:
    """Return an array as a list, with None where a default depends on an invalid input."""
    plain = shown.astype(object)
    plain[np.isnan(shown)] = None
    return plain.tolist()


def _standing(cls: type[Template], given: Mapping[str, Any]) -> list[Notice]:
    """Return the warnings that apply to every calculation with these inputs.

    They are about the version and about tolerances.
    """
    noted = tolerances.unused(given)
    if cls.withdrawn:
        detail = f"{cls.id} version {cls.version} is withdrawn: {cls.withdrawn}"
        return [Notice("withdrawn", cls.id, detail), *noted]
    return list(noted)


def answers_at_level(template: Template, outputs: Iterable[str]) -> tuple[dict[str, Answer], dict[str, Any]]:
    """Return a template's answers in declared units and their errors at its level, without warnings.

    Raises
    ------
    InvalidInputs
        If a result is outside its domain.
    """
    with np.errstate(all="ignore"):
        part = _part(template, list(outputs), {})
    return part.answers, part.error


def answers_only(template: Template, outputs: Iterable[str]) -> dict[str, Answer]:
    """Return a template's answers in declared units, without their errors and warnings.

    Raises
    ------
    InvalidInputs
        If a result is outside its domain.
    """
    with np.errstate(all="ignore"):
        return _answers(template, list(outputs), {})


def evaluate_at_level(
    template: Template, outputs: Iterable[str]
) -> tuple[dict[str, Answer], dict[str, Any], list[Notice]]:
    """Return a template's answers in declared units, their errors, and all warnings so far, at its level.

    Values that the template has computed before are not computed again.

    Raises
    ------
    InvalidInputs
        If a result is outside its domain.
    """
    answers, errors = answers_at_level(template, outputs)
    return answers, errors, notices_of(template)


def notices_of(template: Template) -> list[Notice]:
    """Return all warnings so far of a template at its level, except those of criteria."""
    return [*_standing(type(template), template.ledger.typed), *_noticed([Rung(template, None)])]


def criterion_warnings(
    template: Template, answers: Mapping[str, Answer], errors: Mapping[str, Any]
) -> list[Notice]:
    """Return the warnings of the criteria whose outputs are among these answers."""
    if not template.declared_criteria:
        return []
    measured, level = accuracy(type(template)), template.level or None
    with np.errstate(all="ignore"):
        judgements = judged(EvaluatedValues(template, answers, errors, measured, level=level))
    return list(warned(type(template), judgements))


def _noticed(rungs: list[Rung]) -> list[Notice]:
    """Return the warnings of all levels, without repetition."""
    noticed = (notice for rung in rungs for notice in rung.template.ledger.warnings)
    return list(dict.fromkeys([*noticed, *(notice for rung in rungs for notice in remarks(rung.template))]))


def assumed(
    template: Calculation, outputs: Collection[str], criteria: Sequence[Judgement] = ()
) -> list[Assumption]:
    """Return the assumptions behind the outputs and the judged criteria of a template."""
    cls, typed = type(template), template.ledger.typed
    given = cls._derived.intersection(typed)
    stated = _stated(cls, frozenset(outputs), given)  # type: ignore[arg-type]  # a class has a hash
    return [*(one for one in stated if one.name not in typed), *_limits(cls, criteria)]


@lru_cache(maxsize=1024)
def _stated(cls: type[Calculation], outputs: frozenset[str], given: frozenset[str]) -> tuple[Assumption, ...]:
    """Return the assumptions of the model, and of the inputs on which the outputs depend.

    `given` are the derived inputs that the user gave.
    """
    own = tuple(Assumption("", detail) for detail in cls.assumptions)
    declared = {name: one.meaning.assumed for name, one in cls.inputs.items()}
    if not any(declared.values()):
        return own
    reached = set(_beneath(cls, outputs, given))
    return own + tuple(
        Assumption(name, detail)
        for name, detail in declared.items()
        if detail and (cls.inputs[name].attribute in reached or getattr(cls.inputs[name], "optional", False))
    )


def _beneath(cls: type[Calculation], outputs: Iterable[str], given: Collection[str]) -> Iterator[str]:
    """Yield the attributes on which the outputs depend; a given input depends on no other attribute."""
    waiting = [cls.formulas[name].attribute for name in outputs]
    seen = set(waiting)
    while waiting:
        yield (attribute := waiting.pop())
        node = cls.declarations.get(attribute) or cls.intermediates.get(attribute)
        if isinstance(node, Derived) and node.name in given:
            continue
        uses = {*getattr(node, "uses", ()), *getattr(node, "uses_as_given", ())} - seen
        seen |= uses
        waiting += uses


def _limits(cls: type[Calculation], criteria: Sequence[Judgement]) -> list[Assumption]:
    """Return the limits that a template provides where the user has given none."""
    open_values = {one.sides[0] for one in criteria if one.verdict == "not_checked"}
    if not open_values:
        return []
    checked = [one for one in criteria if one.verdict != "not_checked"]
    open_values.difference_update([one.sides[0] for one in checked if not one.has_fixed_limit])
    provided = _provided(cls)  # type: ignore[arg-type]  # a class has a hash
    found = (provided.get((one.name, one.require)) for one in checked if one.sides[0] in open_values)
    return [one for one in found if one]


@lru_cache(maxsize=1024)
def _provided(cls: type[Calculation]) -> dict[tuple[str, str], Assumption]:
    """Return the fixed limits of a template's criteria, by name and requirement."""
    return {
        (one.name, one.require): Assumption(
            one.name, f"the limit of {one.value.text.replace('_', ' ')} is {one.limit.text}, a default"
        )
        for one in cls.declared_criteria
        if _AMOUNT.fullmatch(one.limit.text)
    }
