"""Evaluate one step or model over many rows by array calls, and report the rows that it refuses.

In an array call, a template masks the points that it would refuse as single points. This module refuses those
rows, with the message of the mask. If a template refuses a whole array, the rows are bisected until the
faulty ones are found. A refused row has no value in any output of the step.

A step whose inputs are equal in all rows is evaluated once, and its latest evaluations are cached: a change
of a design recomputes only the steps that depend on it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from app.calculations.cache import Cache, results
from app.designs.engine.columns import Column, Indices, RowEstimate, scattered
from app.designs.engine.refusals import Refusal, is_of_all_rows, masked, refusal_of
from app.designs.network import Block
from app.plain import Raw
from app.pool.cost import shape
from app.pool.steps import evaluated_step, fingerprint
from templates.core.arrays import Mask
from templates.core.criteria.bands import Estimate
from templates.core.criteria.evaluation import Absent
from templates.core.errors import FaultyText, InvalidInputs
from templates.core.language.answer import Answer
from templates.core.language.criteria import EvaluatedValues, estimate_of
from templates.core.language.evaluate import Evaluation, answers_at_level
from templates.core.language.intake import is_single
from templates.core.language.levels import at_level
from templates.core.language.spec import Curve, Profile, Table
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity
from templates.core.units.units import Value

NO_VALUE = "there is no value here"

Given = Mapping[str, Column | Raw]
"""Inputs of a step by name: columns if they differ from row to row, else the values as read."""


class LevelMoved(Exception):
    """Raised if some rows start at another level than the rows before them; all rows must share one level."""

    def __init__(self, step: str, before: str, level: str) -> None:
        self.step, self.before, self.level = step, before, level
        super().__init__(f"{step} starts at {before} and at {level}")


@dataclass(frozen=True)
class Part:
    """An evaluated template with the answers for some of the rows."""

    rows: Indices
    template: Template
    answers: Mapping[str, Answer]
    errors: Mapping[str, Value | None]

    @cached_property
    def is_array(self) -> bool:
        """Return whether the template of the part has one point for each of its rows."""
        return self.template.shape_of_points() == self.rows.shape


@dataclass
class StepRows:
    """The results of a step for `count` rows.

    Attributes
    ----------
    has_rows
        Whether any input differs from row to row. If not, there is a single result for all rows.
    level
        The level at which the step was evaluated.
    refusals
        The refused rows.
    evaluation
        The evaluation of a step that is equal in all rows.
    """

    block: Block
    count: int
    has_rows: bool
    level: str | None = None
    parts: list[Part] = field(default_factory=list)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    evaluation: Evaluation | None = None
    _columns: dict[str, Column] = field(default_factory=dict)

    @classmethod
    def of(cls, block: Block, evaluation: Evaluation) -> StepRows:
        """Return the results of a step without varied inputs."""
        part = Part(_ONE_ROW, evaluation.template, evaluation.outputs, evaluation.error)
        level = evaluation.level if isinstance(evaluation.level, str) else None
        return cls(block, 1, has_rows=False, level=level, parts=[part], evaluation=evaluation)

    def refused(self) -> Mask:
        """Return a mask of the refused rows."""
        refused = np.zeros(self.count, dtype=bool)
        refused[list(self.refusals)] = True
        return refused

    def column(self, name: str) -> Column:
        """Return the values [SI] of an input or output; NaN where missing.

        Raises
        ------
        InvalidInputs
            If it is a curve whose length differs between rows.
        """
        if name not in self._columns:
            values = [(part.rows, self._value(part, name)) for part in self.parts]
            try:
                self._columns[name] = self._joined(values)
            except FaultyText as error:
                raise InvalidInputs([error.fault(f"{self.block.name}.{name}")]) from None
        return self._columns[name]

    def error(self, output: str) -> Column:
        """Return the relative errors of an output; NaN where unknown."""
        return self._joined([(part.rows, self._error(part, output)) for part in self.parts])

    def absence(self, output: str) -> str | None:
        """Return the first reason for a missing value in a row that is not refused; otherwise None."""
        for part in self.parts:
            answer = part.answers[output]
            if answer.value is None:
                return answer.reason or NO_VALUE
            if answer.reasons is not None:
                reasons = answer.reasons.ravel().tolist()
                if (
                    len(reasons) != part.rows.size
                ):  # the reasons apply to all rows, or to the items of a list in one row
                    reasons = [next(filter(None, reasons), None)] * part.rows.size
                for row, reason in zip(part.rows.tolist(), reasons, strict=True):
                    if reason is not None and row not in self.refusals:
                        return str(reason)
        return None

    def _joined(self, columns: list[tuple[Indices, Column]]) -> Column:
        """Return the column that combines all parts, with NaN in refused rows."""
        if not columns:
            return Column(np.nan)
        if len(columns) == 1 and columns[0][0].size == self.count:
            whole = columns[0][1]
        else:
            whole = scattered(self.count, columns)
        return whole.without(self.refused()) if self.refusals else whole

    def _value(self, part: Part, name: str) -> Column:
        template, answer = part.template, part.answers.get(name)
        if answer is not None and answer.value is None:
            return Column(np.nan)
        declared = template.formulas.get(name) or template.inputs[name]
        with np.errstate(all="ignore"):
            si = getattr(template, declared.attribute)
        if answer is not None and answer.reasons is not None:
            si = np.where(np.isnan(answer.value), np.nan, si)
        axes = declared.axes if isinstance(declared, Profile) else int(isinstance(declared, Curve))
        return Column(si, is_row=self.has_row_axis(part) and np.ndim(si) > axes)

    def _error(self, part: Part, output: str) -> Column:
        error = part.errors.get(output)
        error = np.nan if error is None else error
        return Column(error, is_row=self.has_row_axis(part) and bool(np.ndim(error)))

    def has_row_axis(self, part: Part) -> bool:
        """Return whether the values of a part may have a row axis; a single row has none."""
        return self.has_rows and part.is_array


_ONE_ROW = np.arange(1)


def step_rows(
    block: Block,
    given: Given,
    members: Sequence[str],
    count: int,
    level: str | None = None,
    started: str | None = None,
) -> StepRows:
    """Evaluate a step for `count` rows; rows with a missing input are left out.

    If no `level` is given, the step uses the starting level of the first rows, or the level `started` of
    earlier rows.

    Raises
    ------
    LevelMoved
        If no level is given and rows start at different ones.
    """
    columns = {name: value for name, value in given.items() if isinstance(value, Column)}
    step = StepRows(block, count, has_rows=True, level=level or started)
    has_inputs = np.ones(count, dtype=bool)
    for column in columns.values():
        has_inputs &= column.finite_rows()
    evaluator = _Evaluator(step, given, tuple(members), is_level_given=level is not None)
    for rows in _grouped(block, columns, np.flatnonzero(has_inputs)):
        evaluator.evaluate(rows)
    return step


def _grouped(block: Block, columns: Mapping[str, Column], rows: Indices) -> Iterator[Indices]:
    """Yield groups of rows, one for each array call; rows in a group agree in inputs that must be equal."""
    if not rows.size:
        return
    shared = [
        np.asarray(column.value)[rows].reshape(len(rows), -1)
        for name, column in columns.items()
        if _is_one_for_all(block, name)
    ]
    if not shared:
        yield rows
        return
    _, group = np.unique(np.hstack(shared), axis=0, return_inverse=True)
    for number in range(int(group.max(initial=-1)) + 1):
        yield rows[np.ravel(group) == number]


def _is_one_for_all(block: Block, name: str) -> bool:
    declared = block.cls.inputs[name]
    return isinstance(declared, Table) or is_single(declared)


@dataclass(frozen=True)
class _Evaluator:
    """Evaluates one step by array calls."""

    step: StepRows
    given: Given
    members: tuple[str, ...]
    is_level_given: bool

    def evaluate(self, rows: Indices) -> None:
        """Evaluate some rows; if a call is refused, evaluate each half of them, down to single rows."""
        try:
            part = self._part(rows)
        except InvalidInputs as error:
            if rows.size > 1 and not is_of_all_rows(self.step.block.cls, error.faults, self._varied()):
                for half in np.array_split(rows, 2):
                    self.evaluate(half)
            else:
                refusal = refusal_of([fault.within(self.step.block.name) for fault in error.faults])
                self.step.refusals |= dict.fromkeys(rows.tolist(), refusal)
        else:
            self.step.parts.append(part)
            self.step.refusals |= masked(self.step.block.name, part.template, part.rows)

    def _varied(self) -> list[str]:
        """Return the names of the inputs that differ from row to row."""
        return [name for name, value in self.given.items() if isinstance(value, Column)]

    def _part(self, rows: Indices) -> Part:
        cls = self.step.block.cls
        template = cls.from_quantities({name: self._input(name, rows) for name in self.given})
        if cls.levels:
            template = at_level(template, self._level(template))
        outputs = [name for name in self.members if name in cls.formulas]
        answers, errors = answers_at_level(template, outputs)
        for name in self.members:
            if name not in cls.formulas:
                getattr(template, cls.inputs[name].attribute)
        return Part(rows, template, answers, errors)

    def _level(self, template: Template) -> str:
        step = self.step
        if step.level is None:
            step.level = template.starting_level()
        elif not self.is_level_given and step.level != (started := template.starting_level()):
            raise LevelMoved(step.block.name, step.level, started)
        return step.level

    def _input(self, name: str, rows: Indices) -> Raw:
        """Return an input in the form that its template needs.

        For a single row it is a single value, so that messages refer to it.
        """
        value = self.given[name]
        if not isinstance(value, Column):
            return value
        declared = self.step.block.cls.inputs[name]
        si: Value = np.asarray(value.value)[rows]
        if rows.size == 1 or _is_one_for_all(self.step.block, name):
            si = np.asarray(value.value)[rows[0]]
        elif isinstance(declared, Curve) and not value.rank:
            si = np.broadcast_to(np.asarray(si)[:, None], (rows.size, self._places(declared)))
        return TypedQuantity(None, declared.meaning.unit, si if np.ndim(si) else float(si), {})

    def _places(self, declared: Curve) -> int:
        """Return the number of points of other curves along the same axis."""
        lengths = [1]
        for name, value in self.given.items():
            other = self.step.block.cls.inputs[name]
            if isinstance(other, Curve) and other.along == declared.along:
                places = value.places if isinstance(value, Column) else shape(value)
                lengths += places[-1:]
        return max(lengths)


Evaluations = Sequence[tuple[Part, EvaluatedValues]]
"""The parts of a step, each with its evaluated values for criteria."""


def estimate_rows(step: StepRows, evaluations: Evaluations, member: str) -> RowEstimate | Absent:
    """Return the value of an input or output of a step with its error.

    If no row has a value, return the reason.
    """
    estimates = [(part, estimate_of(evaluated, member)) for part, evaluated in evaluations]
    present = [(part, one) for part, one in estimates if isinstance(one, Estimate)]
    if not present:
        return next((one for _, one in estimates if isinstance(one, Absent)), Absent())
    if not step.has_rows:
        return RowEstimate(present[0][1])
    axes = max(one.axes for _, one in present)
    value = _column(step, present, lambda one: one.value, axes)
    error = _column(step, present, lambda one: one.error, 0)
    if all(one.scale is None for _, one in present):
        return RowEstimate(Estimate(value.value, error.value, axes), value.is_row, error.is_row)
    scale = _column(step, present, lambda one: np.nan if one.scale is None else one.scale, 0)
    whole = Estimate(value.value, error.value, axes, scale.value)
    return RowEstimate(whole, value.is_row, error.is_row, scale.is_row)


def _column(
    step: StepRows, parts: Sequence[tuple[Part, Estimate]], of: Callable[[Estimate], Value], axes: int
) -> Column:
    """Return the column that combines all parts; NaN in refused rows."""
    columns: list[tuple[Indices, Column]] = []
    for part, estimate in parts:
        value = of(estimate)
        columns.append((part.rows, Column(value, is_row=step.has_row_axis(part) and np.ndim(value) > axes)))
    if len(columns) == 1 and columns[0][0].size == step.count:
        whole = columns[0][1]
    else:
        whole = scattered(step.count, columns)
    return whole.without(step.refused()) if step.refusals else whole


class _StepState(NamedTuple):
    evaluation: Evaluation
    values: int  # number of values that the template had computed; it grows when further values are requested


class Memory:
    """A cache of the latest evaluations of steps, so that a change recomputes only what depends on it."""

    def __init__(self, cache: Cache = results) -> None:
        self._cache = cache

    def evaluation(self, block: Block, raw: Mapping[str, Raw], wanted: tuple[str, ...] | None) -> Evaluation:
        """Return the evaluation of a step, from the cache or computed.

        Raises
        ------
        InvalidInputs
            If the template refuses the inputs.
        StepDeferred
            If the caller does not wait for an expensive step.
        """
        key = (block.cls, block.level, block.tolerance, wanted, fingerprint(raw))
        kept: _StepState | None = self._cache.get(key)
        if kept is None:
            return self._keep(key, evaluated_step(block.cls, raw, wanted, block.level, block.tolerance))
        if kept.values != _count(kept.evaluation):
            self._keep(key, kept.evaluation)
        return kept.evaluation

    def _keep(self, key: Hashable, evaluation: Evaluation) -> Evaluation:
        self._cache.keep(key, _StepState(evaluation, _count(evaluation)))
        return evaluation


def _count(evaluation: Evaluation) -> int:
    return len(vars(evaluation.template))


memory = Memory()
