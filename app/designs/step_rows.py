"""One step, or one model, over many rows: array calls of its template, and which rows it refuses.

In arrays a template masks the points that it would refuse alone; such rows are refused here with the words
of the mask. Where it refuses a whole array, the rows are halved until those are found that it refuses. A row
that is refused has no value in any output of the step, as in a design of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from app.designs.columns import Column, Indices, scattered
from app.designs.network import Block
from app.designs.row_refusals import Refusal, is_of_all_rows, masked, refusal_of
from templates.core.arrays import Mask
from templates.core.errors import InvalidInputs
from templates.core.language.answer import Answer
from templates.core.language.evaluate import answers_at_level
from templates.core.language.intake import is_single
from templates.core.language.levels import at_level
from templates.core.language.spec import Curve, Profile, Table
from templates.core.language.template import Template
from templates.core.units.quantity import Typed
from templates.core.units.units import Value

NO_VALUE = "there is no value here"

Given = Mapping[str, Column | Typed | str]
"""Inputs of a step by name: those of relations and rows as columns, literals as they were read."""


class LevelMoved(Exception):
    """Some rows start at another level than those before them; one level has to serve all rows."""

    def __init__(self, step: str, before: str, level: str) -> None:
        self.step, self.before, self.level = step, before, level
        super().__init__(f"{step} starts at {before} and at {level}")


@dataclass(frozen=True)
class Part:
    """A template with the answers for some of the rows."""

    rows: Indices
    template: Template
    answers: Mapping[str, Answer]
    errors: Mapping[str, Value | None]


@dataclass
class StepRows:
    """The results of a step for `count` rows.

    Attributes
    ----------
    has_rows
        Whether any input differs from row to row. If not, there is one row, which stands for all.
    level
        At which it was evaluated.
    values
        Columns [SI] of the members that were asked for.
    errors
        Relative errors of outputs; NaN where none is stated.
    refusals
        By row.
    absent
        Outputs that do not exist in some rows that are not refused, and the first reason.
    """

    block: Block
    count: int
    has_rows: bool
    level: str | None = None
    parts: list[Part] = field(default_factory=list)
    values: dict[str, Column] = field(default_factory=dict)
    errors: dict[str, Column] = field(default_factory=dict)
    refusals: dict[int, Refusal] = field(default_factory=dict)
    absent: dict[str, str] = field(default_factory=dict)

    def refused(self) -> Mask:
        """Which rows are refused."""
        refused = np.zeros(self.count, dtype=bool)
        refused[list(self.refusals)] = True
        return refused


def step_rows(
    block: Block,
    given: Given,
    members: Sequence[str],
    count: int,
    level: str | None = None,
    started: str | None = None,
) -> StepRows:
    """Evaluate a step for `count` rows; rows in which an input has no value are left out.

    Without a `level` it is the one at which the first rows start, or at which those before `started`.

    Raises
    ------
    LevelMoved
        If no level is given and rows start at different ones.
    """
    columns = {name: value for name, value in given.items() if isinstance(value, Column)}
    has_rows = any(column.is_row for column in columns.values())
    step = StepRows(block, count if has_rows else 1, has_rows, level or started)
    count = step.count
    has_inputs = np.ones(count, dtype=bool)
    for column in columns.values():
        has_inputs &= column.finite_rows() if column.is_row else bool(np.isfinite(column.value).all())
    evaluator = _Evaluator(step, given, tuple(members), is_level_given=level is not None)
    for rows in _grouped(block, columns, np.flatnonzero(has_inputs)):
        evaluator.evaluate(rows)
    _collect(step, members)
    return step


def _grouped(block: Block, columns: Mapping[str, Column], rows: Indices) -> Iterator[Indices]:
    """Rows that go into one array call: those of equal inputs where an input is one value for all points."""
    shared = [
        np.asarray(column.value)[rows].reshape(len(rows), -1)
        for name, column in columns.items()
        if column.is_row and _is_one_for_all(block, name)
    ]
    if not shared:
        yield from [rows] if rows.size else []
        return
    _, group = np.unique(np.hstack(shared), axis=0, return_inverse=True)
    for number in range(int(group.max(initial=-1)) + 1):
        yield rows[np.ravel(group) == number]


def _is_one_for_all(block: Block, name: str) -> bool:
    declared = block.cls.inputs[name]
    return isinstance(declared, Table) or is_single(declared)


@dataclass(frozen=True)
class _Evaluator:
    """The array calls of one step."""

    step: StepRows
    given: Given
    members: tuple[str, ...]
    is_level_given: bool

    def evaluate(self, rows: Indices) -> None:
        """Answers for some rows; a refusing call is halved down to single rows."""
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
            if self.step.has_rows:
                self.step.refusals |= masked(self.step.block.name, part.template, part.rows)

    def _varied(self) -> list[str]:
        """The inputs that differ from row to row."""
        return [n for n, value in self.given.items() if isinstance(value, Column) and value.is_row]

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

    def _input(self, name: str, rows: Indices) -> Typed | str:
        """An input as its template takes it; of a single row as a single value, so that it speaks of it."""
        value = self.given[name]
        if not isinstance(value, Column):
            return value
        declared, si = self.step.block.cls.inputs[name], value.value
        if value.is_row:
            si = np.asarray(si)[rows]
            if rows.size == 1 or _is_one_for_all(self.step.block, name):
                si = si[0] if value.rank else float(si[0])
            elif isinstance(declared, Curve) and not value.rank:
                si = np.broadcast_to(si[:, None], (len(si), self._places(declared)))
        return Typed(None, declared.meaning.unit, si if np.ndim(si) else float(si), {})

    def _places(self, declared: Curve) -> int:
        """Number of places that the other curves have along the same axis."""
        lengths = [1]
        for name, value in self.given.items():
            other = self.step.block.cls.inputs[name]
            if isinstance(other, Curve) and other.along == declared.along and not isinstance(value, str):
                si = value.value if isinstance(value, Column) else value.si
                rank = value.rank if isinstance(value, Column) else np.ndim(si)
                lengths += [np.shape(si)[-1]] if rank else []
        return max(lengths)


def _collect(step: StepRows, members: Sequence[str]) -> None:
    """Columns of the members and of their errors from all parts."""
    for name in members:
        step.values[name] = _joined(step, [(part.rows, _value(step, part, name)) for part in step.parts])
        if name in step.block.cls.formulas:
            step.errors[name] = _joined(step, [(part.rows, _error(step, part, name)) for part in step.parts])
            _note_absence(step, name)


def _joined(step: StepRows, columns: list[tuple[Indices, Column]]) -> Column:
    """One column of all parts, without the rows that are refused."""
    if not columns:
        return Column(np.nan)
    if len(columns) == 1 and columns[0][0].size == step.count:
        whole = columns[0][1]
    else:
        whole = scattered(step.count, columns)
    return whole.without(step.refused()) if step.refusals else whole


def _value(step: StepRows, part: Part, name: str) -> Column:
    """The values [SI] of an input or output; NaN where there is none."""
    template, answer = part.template, part.answers.get(name)
    if answer is not None and answer.value is None:
        return Column(np.nan)
    declared = template.formulas.get(name) or template.inputs[name]
    si = getattr(template, declared.attribute)
    if answer is not None and answer.reasons is not None:
        si = np.where(np.isnan(answer.value), np.nan, si)
    axes = declared.axes if isinstance(declared, Profile) else int(isinstance(declared, Curve))
    return Column(si, is_row=_has_rows(step, part) and np.ndim(si) > axes)


def _error(step: StepRows, part: Part, name: str) -> Column:
    error = part.errors.get(name)
    error = np.nan if error is None else error
    return Column(error, is_row=_has_rows(step, part) and bool(np.ndim(error)))


def _has_rows(step: StepRows, part: Part) -> bool:
    """Return whether the values of a part may have an axis of rows: a single row is a single value."""
    return step.has_rows and part.template.shape_of_points() == part.rows.shape


def _note_absence(step: StepRows, name: str) -> None:
    """Why an output does not exist in rows that are not refused: the first reason."""
    for part in step.parts:
        answer = part.answers[name]
        if answer.value is None:
            step.absent.setdefault(name, answer.reason or NO_VALUE)
        elif answer.reasons is not None:
            reasons = np.broadcast_to(answer.reasons, part.rows.shape)
            for row, reason in zip(part.rows.tolist(), reasons.tolist(), strict=True):
                if reason is not None and row not in step.refusals:
                    step.absent.setdefault(name, reason)
                    break
