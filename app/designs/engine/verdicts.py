"""The criteria of a calculated design: those of its templates and its own, with propagated errors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from operator import or_

import numpy as np
from numpy.typing import NDArray

from app.designs.engine.calculation import Calculation
from app.designs.engine.columns import Column, RowEstimate
from app.designs.engine.relations import limit_operations, limit_values
from app.designs.engine.shifts import Shifts, Upstream
from app.designs.engine.steps import Evaluations, estimate_rows
from app.designs.network import LIMITS, Block, Demand, Subject, subjects
from app.pool.cost import spanned
from app.reference import Reference
from templates.core.arrays import Array, Truth
from templates.core.criteria.bands import Estimate, Shift
from templates.core.criteria.comparison import NOT_CHECKED, NOT_MET, compare, side_of
from templates.core.criteria.criterion import Criterion, Limit
from templates.core.criteria.evaluation import Absent, Along, Instead, in_words, judge, unknown_error
from templates.core.criteria.judgement import Judgement
from templates.core.criteria.limits import GivenLimit
from templates.core.criteria.summary import worst_first
from templates.core.criteria.worst import worst_of_rows
from templates.core.errors import FaultyText
from templates.core.language.criteria import (
    EvaluatedValues,
    along_of,
    estimates_of,
    is_due,
    level_and_truth,
    missing_of,
    notes,
)
from templates.core.language.levels import accuracy
from templates.core.units.relation import Relation

RowCodes = NDArray[np.int8]
"""The verdict of each row, as an index into `templates.core.criteria.comparison.VERDICTS`."""

COLUMNS = ("value", "limit", "low", "high", "utilisation", "margin")


def judged(calculation: Calculation) -> list[Judgement]:
    """Return the judgement of every criterion, worst first.

    A criterion with a pending value is not checked.
    """
    return worst_first(Verdicts(calculation).all())


@dataclass(frozen=True)
class JudgedColumn:
    """The two sides of a criterion [SI] in each row, at its worst point; NaN where there is none.

    Attributes
    ----------
    low, high
        The error band of the value as far as known; infinite at an unknown end.
    utilisation
        Limit over value, or value over limit; NaN for temperatures, and if either is not positive.
    margin
        The difference between value and limit; positive is safe.
    is_known
        Whether all errors that affect the criterion are known, in all rows.
    """

    value: Array
    limit: Array
    low: Array
    high: Array
    utilisation: Array
    margin: Array
    is_known: bool

    def within(self, whole: JudgedColumn | None, chunk: slice, count: int) -> JudgedColumn:
        """Return a column of `count` rows that includes this chunk; its other rows come from `whole`."""
        columns = _columns(whole, count)
        for name in COLUMNS:
            columns[name][chunk] = getattr(self, name)
        return JudgedColumn(**columns, is_known=self.is_known and (whole is None or whole.is_known))


def _columns(whole: JudgedColumn | None, count: int) -> dict[str, Array]:
    if whole is None:
        return {name: np.full(count, np.nan) for name in COLUMNS}
    return {name: getattr(whole, name) for name in COLUMNS}


@dataclass(frozen=True)
class _Sides:
    """The values that a criterion names, with the errors propagated to them.

    Attributes
    ----------
    shifts
        All values, for each uncertain upstream output at either end of its band.
    unknown
        Upstream outputs whose error is unknown or not propagated.
    is_known
        Where the errors of all upstream outputs are known, in the shape of the values.
    """

    estimates: Mapping[str, Estimate]
    shifts: list[Shift]
    unknown: frozenset[Reference]
    is_known: Truth


@dataclass(frozen=True)
class Verdicts:
    """The verdicts of a calculated design."""

    calculation: Calculation
    _steps: dict[str, Evaluations] = field(default_factory=dict)
    _estimates: dict[Reference, RowEstimate | Absent] = field(default_factory=dict)

    def all(self) -> Iterator[Judgement]:
        """Yield the judgement of every criterion, in no particular order."""
        return self.some(self._subjects)

    def some(self, names: Iterable[str]) -> Iterator[Judgement]:
        """Yield the judgements of the named criteria."""
        for name in names:
            subject = self._subjects[name]
            if subject.block is not None:
                yield from self._of_template(subject.block, subject)
            elif subject.demand is not None:
                yield self._of_design(subject, subject.demand)

    def names(self) -> list[str]:
        """Return the names of all criteria."""
        return list(self._subjects)

    def subject(self, name: str) -> Subject:
        """Return a criterion by name, with the block or the design that declares it."""
        return self._subjects[name]

    def references(self, name: str) -> Mapping[str, Reference]:
        """Return the values that a criterion names, without limits that the user typed."""
        return self._subjects[name].references

    def uncertain(self, name: str) -> frozenset[Reference]:
        """Return the step outputs whose errors widen the band of a criterion, whether known or not."""
        subject = self._subjects[name]
        judged = [subject, *(one for _, one in subject.instead)]
        references = (reference for one in judged for reference in one.references.values())
        origins = (self._shifts.behind(reference) for reference in references)
        return reduce(or_, (one.uncertain | one.unknown | one.stopped for one in origins), frozenset())

    def rows(self, subject: Subject) -> tuple[RowCodes, JudgedColumn]:
        """Return the verdict of a criterion in each row, and the numbers behind it."""
        criterion = subject.criterion
        estimates = self._of_rows(subject)
        missing = np.zeros(self.calculation.count, dtype=bool)
        for estimate in estimates.values():
            missing |= estimate.missing(self.calculation.count)
        if not estimates.keys() >= set(criterion.names) or missing.all():
            unjudged, column = self._not_checked(criterion, estimates)
            return self._filled(subject, unjudged), column
        try:
            codes, column = self._compared(subject, estimates)
        except FaultyText:  # curves of different lengths
            return self._not_checked(criterion, estimates)
        verdicts: RowCodes = np.where(missing, NOT_CHECKED, codes).astype(np.int8)
        return self._filled(subject, verdicts), column

    @cached_property
    def _subjects(self) -> dict[str, Subject]:
        return subjects(self.calculation.graph)

    @cached_property
    def _shifts(self) -> Shifts:
        return Shifts(self.calculation, self._estimate)

    def _of_template(self, block: Block, subject: Subject) -> Iterator[Judgement]:
        """Yield the judgement of a template's criterion, unless the step omits a required output."""
        criterion, evaluated = subject.criterion, self._evaluated(block.name)
        if evaluated is None:
            absent = dict.fromkeys(criterion.names, Absent((), f"{block.name} waits for its calculation"))
            yield _named(judge(criterion, {}, absent), block, subject.demand)
            return
        if not is_due(evaluated, criterion):
            return
        instead = self._instead(block, evaluated, criterion) if criterion.absent else None
        judgement = self._of_step(subject, evaluated, notes(evaluated, criterion), instead)
        yield _named(judgement, block, subject.demand)

    def _instead(self, block: Block, evaluated: EvaluatedValues, criterion: Criterion) -> Instead | None:
        """Return the judgement of the alternative comparison if a value is missing; otherwise None."""
        missing = missing_of(evaluated, criterion)
        if missing is None or missing.instead is None:
            return None
        subject = Subject(missing.instead, block, None)
        return Instead(self._of_step(subject, evaluated, {}, None), missing.reason)

    def _of_step(
        self,
        subject: Subject,
        evaluated: EvaluatedValues,
        more: Mapping[str, str | None],
        instead: Instead | None,
    ) -> Judgement:
        criterion, block = subject.criterion, subject.block
        assert block is not None
        estimates, absent = estimates_of(evaluated, criterion)
        absent |= self._waiting_limits(block, criterion) if block.related else {}
        if absent:
            return judge(criterion, estimates, absent, noted=more, instead=instead)
        rows = {name: RowEstimate(one) for name, one in estimates.items()}
        along = along_of(evaluated.template, criterion.names)
        return self._judged(subject, rows, along, more, instead)

    def _waiting_limits(self, block: Block, criterion: Criterion) -> dict[str, Absent]:
        """Return the limits whose relations have no value yet; each is absent for that reason.

        A library row does not replace such a limit.
        """
        related = (block.related[name] for name in criterion.limits_by_name if name in block.related)
        waiting = [cell for cell in related if cell.name not in self.calculation.values]
        return {
            cell.reference.output or "": Absent((), f"{cell.name} has no value yet: {cell.raw}")
            for cell in waiting
        }

    def _of_design(self, subject: Subject, demand: Demand) -> Judgement:
        """Return the judgement of a criterion that the design declares itself."""
        values = {name: self._estimate(reference) for name, reference in demand.uses.items()}
        estimates = {name: one for name, one in values.items() if isinstance(one, RowEstimate)}
        absent = {name: one for name, one in values.items() if isinstance(one, Absent)}
        criterion, along = subject.criterion, self._along(demand)
        more = {"source": criterion.source, "waived": demand.written.waived, **self._stated_by(demand)}
        if absent:
            return judge(criterion, _plain(estimates), absent, along, noted=more)
        return self._judged(subject, estimates, along, more, None)

    def _stated_by(self, demand: Demand) -> dict[str, str | None]:
        """Return the level and the truth of a step's output that a criterion judges directly."""
        subject = demand.criterion.subject if demand.criterion else None
        reference = demand.uses[subject] if subject else None
        evaluated = self._evaluated(reference.block) if reference and reference.output else None
        return level_and_truth(evaluated, reference.output) if reference and evaluated else {}

    def _along(self, demand: Demand) -> Along | None:
        """Return the axis of the first curve that a criterion uses; None if it uses none."""
        for reference in demand.uses.values():
            evaluated = self._evaluated(reference.block) if reference.output else None
            along = along_of(evaluated.template, [reference.member]) if evaluated else None
            if along is not None:
                return along
        return None

    def _judged(
        self,
        subject: Subject,
        estimates: Mapping[str, RowEstimate],
        along: Along | None,
        more: Mapping[str, str | None],
        instead: Instead | None,
    ) -> Judgement:
        """Return the judgement of a criterion whose values all exist."""
        criterion = subject.criterion
        try:
            sides = self._sides(subject, estimates)
        except FaultyText as error:
            absent = dict.fromkeys(criterion.names, Absent((), str(error)))
            return judge(criterion, _plain(estimates), absent, noted=more)
        result = judge(
            criterion,
            sides.estimates,
            {},
            along,
            shifts=sides.shifts,
            noted=more,
            instead=instead,
            is_known=sides.is_known,
        )
        return _explained(result, sides)

    def _sides(self, subject: Subject, estimates: Mapping[str, RowEstimate]) -> _Sides:
        """Return the values that a criterion names, with their upstream errors.

        Raises
        ------
        FaultyText
            If the comparison needs too many operations.
        """
        criterion = subject.criterion
        references = {name: one for name, one in subject.references.items() if name in estimates}
        upstream = self._shifts.upstream(references.values())
        limit_operations(self.calculation.operations + _operations(criterion, estimates, upstream))
        moved, upstream = self._shifts.shifts(references, upstream)
        rank = max((one.rank for one in estimates.values()), default=0)
        fitted = {name: one.padded(rank) for name, one in estimates.items()}
        constant = {name: one.value for name, one in fitted.items() if name not in references}
        shifts: list[Shift] = [
            ({**constant, **_padded(low, estimates, rank)}, {**constant, **_padded(high, estimates, rank)})
            for low, high in moved
        ]
        unknown = upstream.unknown | upstream.stopped
        return _Sides(fitted, shifts, unknown, self._is_known(estimates, upstream, rank))

    def _is_known(self, estimates: Mapping[str, RowEstimate], upstream: Upstream, rank: int) -> Truth:
        """Return a mask of the rows in which the errors of all upstream outputs are known."""
        if not (upstream.unknown or upstream.stopped):
            return True
        certain = ~self._shifts.unknown(upstream)
        if not any(one.has_rows for one in estimates.values()):
            return bool(certain.all())
        axes = max(one.one.axes for one in estimates.values())
        return certain.reshape(-1, *(1,) * (rank + axes))

    def _estimate(self, reference: Reference) -> RowEstimate | Absent:
        """Return the value of a name with the error of its own step, or the reason why it is missing."""
        if reference not in self._estimates:
            self._estimates[reference] = self._estimated(reference)
        return self._estimates[reference]

    def _estimated(self, reference: Reference) -> RowEstimate | Absent:
        calculation = self.calculation
        is_own = reference.output is not None and not reference.analysis
        is_written = calculation.graph.cell(reference) is not None or reference in calculation.given
        if is_own and not is_written and self._parts(reference.block):
            return self._inside(reference)
        try:
            return RowEstimate.exact(calculation.used(reference))
        except FaultyText as error:
            return Absent((), str(error))
        except (KeyError, AttributeError):
            return Absent((), f"{reference} waits for a solid or for its calculation")

    def _inside(self, reference: Reference) -> RowEstimate | Absent:
        """Return an input or output of a step as its evaluation used it."""
        step, parts = self.calculation.step(reference.block), self._parts(reference.block)
        if step is None or not parts:
            return Absent((), f"{reference.block} waits for its calculation")
        evaluated = parts[0][1]
        if reference.member in evaluated.template.inputs or reference.member in evaluated.answers:
            return estimate_rows(step, parts, reference.member)
        return Absent((), f"{reference} is not computed; name it in the outputs of the step")

    def _evaluated(self, step: str) -> EvaluatedValues | None:
        """Return the evaluated values of a step for its criteria; None for a model or a pending step."""
        parts = self._parts(step)
        return parts[0][1] if parts else None

    def _parts(self, name: str) -> Evaluations:
        """Return each part of a step with its evaluated values; none for a model or a pending step."""
        if name not in self._steps:
            step = self.calculation.step(name)
            self._steps[name] = []
            if step is not None and not step.block.is_model:
                limits, measured = self._limits(step.block), accuracy(step.block.cls)
                self._steps[name] = [
                    (
                        part,
                        EvaluatedValues(
                            part.template, part.answers, part.errors, measured, limits, level=step.level
                        ),
                    )
                    for part in step.parts
                ]
        return self._steps[name]

    def _limits(self, block: Block) -> Mapping[str, GivenLimit]:
        """Return the limits of a step.

        A limit set by a relation is included once it has a value, with the relation as its source.
        """
        if not block.related:
            return block.limits
        values = self.calculation.values
        related = {n: cell for n, cell in block.related.items() if cell.name in values}
        given = {n: GivenLimit(values[cell.name].value, f"{n} {cell.raw}") for n, cell in related.items()}
        return {**block.limits, **given}

    def _of_rows(self, subject: Subject) -> dict[str, RowEstimate]:
        """Return those values named by a criterion that exist in the rows."""
        block = subject.block
        if block is not None and block.is_model:
            return {}
        values = {
            name: self._inside(reference)
            if block is not None and reference.analysis != LIMITS
            else self._estimate(reference)
            for name, reference in subject.references.items()
        }
        estimates = {name: one for name, one in values.items() if isinstance(one, RowEstimate)}
        for limit in subject.criterion.limits:
            if limit.name not in estimates and (given := self._limit(subject, limit, estimates)) is not None:
                estimates[limit.name] = given
        return estimates

    def _limit(self, subject: Subject, limit: Limit, others: Mapping[str, RowEstimate]) -> RowEstimate | None:
        """Return a limit that the user or a default sets: one value for all rows, or a curve."""
        assert subject.block is not None
        given = subject.block.limits.get(limit.name)
        if given is not None:
            rank = np.ndim(given.value)
            curve = next((other for other in others.values() if other.one.axes), None)
            if rank and (curve is None or np.shape(given.value) != curve.value.places):
                return None
            return RowEstimate.exact(Column(given.value), axes=rank)
        if limit.default is None:
            return None
        function, name = limit.default
        cell = subject.block.cells.get(name)
        column = self.calculation.values.get(cell.name) if cell else None
        if column is None or not column.rank:
            return None
        end = {"min": np.min, "max": np.max}[function](column.value, axis=-1)
        return RowEstimate.exact(Column(end, column.is_row))

    def _compared(self, subject: Subject, estimates: Mapping[str, RowEstimate]) -> tuple[Array, JudgedColumn]:
        """Return the verdict of each row, and the numbers behind it."""
        sides = self._sides(subject, estimates)
        compared = compare(subject.criterion, sides.estimates, sides.shifts, is_known=sides.is_known)
        if not any(one.has_rows for one in estimates.values()) and np.ndim(compared.codes):
            compared = replace(compared, codes=np.asarray(compared.codes)[None])
        codes, numbers = worst_of_rows(subject.criterion, compared, self.calculation.count)
        return codes, _column(subject.criterion, numbers)

    def _filled(self, subject: Subject, codes: RowCodes) -> RowCodes:
        """Return the verdicts; a row with a missing value gets that of the alternative comparison."""
        for missing, instead in subject.instead:
            if not instead.is_due(self.calculation.graph) or subject.block is None:
                continue
            beside = self._inside(Reference(subject.block.name, None, missing.beside))
            others, _ = self.rows(instead)
            is_filled = (codes == NOT_CHECKED) & (others != NOT_MET)
            if isinstance(beside, RowEstimate):
                is_filled &= ~beside.missing(self.calculation.count)
                codes = np.where(is_filled, others, codes).astype(np.int8)
        return codes

    def _not_checked(
        self, criterion: Criterion, estimates: Mapping[str, RowEstimate]
    ) -> tuple[RowCodes, JudgedColumn]:
        """Return the verdict "not checked" for every row, with the sides that are single values."""
        count = self.calculation.count
        nothing = np.full(count, np.nan)
        value, limit = (self._side(side, estimates) for side in (criterion.value, criterion.limit))
        is_known = not any(estimate.unknown(count).any() for estimate in estimates.values())
        column = JudgedColumn(value, limit, nothing, nothing, nothing, nothing, is_known)
        return np.full(count, NOT_CHECKED, dtype=np.int8), column

    def _side(self, side: Relation, estimates: Mapping[str, RowEstimate]) -> Array:
        """Return the value of one side of a criterion in each row; NaN for curves or missing values."""
        count = self.calculation.count
        if side.names <= estimates.keys() and not any(estimates[n].value.rank for n in side.names):
            value = side_of(side, {name: estimates[name].padded(0) for name in side.names})
            return np.broadcast_to(np.asarray(value, dtype=float), (count,))
        return np.full(count, np.nan)


def _plain(estimates: Mapping[str, RowEstimate]) -> dict[str, Estimate]:
    return {name: one.one for name, one in estimates.items()}


def _padded(
    values: Mapping[str, Column], estimates: Mapping[str, RowEstimate], rank: int
) -> dict[str, Array | float]:
    return {name: column.padded(rank + estimates[name].one.axes) for name, column in values.items()}


def _column(criterion: Criterion, sides: list[Array]) -> JudgedColumn:
    """Return both sides of a criterion, the utilisation and the margin in each row."""
    value, limit, low, high, *_, certain = sides
    is_least = criterion.sign == ">="
    with np.errstate(all="ignore"):
        share = limit / value if is_least else value / limit
    is_share = (value > 0) & (limit > 0) & np.isfinite(share) & (not criterion.is_temperature)
    margin = value - limit if is_least else limit - value
    share = np.where(is_share, share, np.nan)
    return JudgedColumn(value, limit, low, high, share, margin, bool(certain.all()))


def _explained(result: Judgement, sides: _Sides) -> Judgement:
    """Return a judgement whose reason names the upstream outputs with unknown errors."""
    if sides.unknown and not result.error_known and result.margin is not None:
        return replace(result, reason=unknown_error(map(in_words, map(str, sides.unknown)), result.verdict))
    return result


def _operations(criterion: Criterion, estimates: Mapping[str, RowEstimate], upstream: Upstream) -> int:
    """Return the number of operations on single values for judging a criterion in one row, with shifts."""
    points = spanned(estimate.value.places for estimate in estimates.values())
    limit_values(points)
    times = 1 + 2 * (len(estimates) + len(upstream.uncertain))
    return points * times * (criterion.value.parts + criterion.limit.parts)


def _named(judgement: Judgement, block: Block, demand: Demand | None) -> Judgement:
    """Return a judgement under the name that the criterion has in the design, with the design's changes."""
    written = demand.written if demand else None
    return replace(
        judgement,
        name=f"{block.name}.{judgement.name}",
        give=tuple(map(f"{block.name}.".__add__, judgement.give)),
        words=(written and written.words) or judgement.words,
        source=(written and written.source) or judgement.source,
        waived=written.waived if written else None,
    )
