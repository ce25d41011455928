"""The criteria of a design for many rows: a verdict for each row, equal to that of a design of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from app.designs.columns import Column
from app.designs.network import LIMITS
from app.designs.row_estimates import RowEstimate, estimate_rows
from app.designs.row_pass import RowPass
from app.designs.row_shifting import NONE, RowShifting
from app.designs.subjects import Subject
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import FaultyText
from templates.core.judging.bands import Shift
from templates.core.judging.comparison import NOT_CHECKED, NOT_MET, compare, side_of
from templates.core.judging.criterion import Criterion, Limit
from templates.core.judging.worst import worst_of_rows
from templates.core.units.relation import Relation
from templates.core.units.units import Value

RowCodes = NDArray[np.int8]
"""The verdict of each row as a place in `templates.core.judging.comparison.WORST_FIRST`."""

COLUMNS = ("value", "limit", "low", "high", "utilisation", "margin")


@dataclass(frozen=True)
class JudgedColumn:
    """The sides of a criterion [SI] in each row, at its worst place; NaN where there is none.

    Attributes
    ----------
    low, high
        The band of the value; infinite where it is open, NaN where the error is not known.
    utilisation
        Limit over value, or value over limit; NaN unless both are positive, and of temperatures.
    margin
        Positive is safe.
    is_stated
        Whether the errors of all models behind it are stated.
    """

    value: Array
    limit: Array
    low: Array
    high: Array
    utilisation: Array
    margin: Array
    is_stated: bool

    def taken(
        self, whole: JudgedColumn | None, rows: NDArray[np.intp], here: NDArray[np.bool_], count: int
    ) -> JudgedColumn:
        """A column of `count` rows: those that are `here` at their places, the rest that of `whole`."""
        part = {name: getattr(self, name)[here] for name in COLUMNS}
        columns = _columns(whole, count)
        for name in COLUMNS:
            columns[name][rows] = part[name]
        return JudgedColumn(**columns, is_stated=self.is_stated and (whole is None or whole.is_stated))

    def within(self, whole: JudgedColumn | None, chunk: slice, count: int) -> JudgedColumn:
        """A column of so many rows, of which these are a chunk; the rest is that of `whole`."""
        columns = _columns(whole, count)
        for name in COLUMNS:
            columns[name][chunk] = getattr(self, name)
        return JudgedColumn(**columns, is_stated=self.is_stated and (whole is None or whole.is_stated))


def _columns(whole: JudgedColumn | None, count: int) -> dict[str, Array]:
    if whole is None:
        return {name: np.full(count, np.nan) for name in COLUMNS}
    return {name: getattr(whole, name) for name in COLUMNS}


@dataclass(frozen=True)
class RowJudging:
    """The verdicts of one chunk of rows."""

    rows: RowPass

    def judged(self, subject: Subject) -> tuple[RowCodes, JudgedColumn]:
        """The verdicts of one criterion, and the numbers behind them."""
        criterion = subject.criterion
        is_of_model = subject.block is not None and subject.block.is_model
        estimates = {} if is_of_model else self._estimates(subject)
        missing = np.zeros(self.rows.count, dtype=bool)
        for estimate in estimates.values():
            missing |= estimate.missing(self.rows.count)
        if not estimates.keys() >= set(criterion.names) or missing.all():
            unjudged, column = self._not_checked(criterion, estimates)
            return self._filled(subject, unjudged), column
        try:
            codes, sides, is_stated = self._compared(subject, estimates)
        except FaultyText:  # curves of different lengths
            return self._not_checked(criterion, estimates)
        verdicts: RowCodes = np.where(missing, NOT_CHECKED, codes).astype(np.int8)
        return self._filled(subject, verdicts), _column(criterion, sides, is_stated)

    def _filled(self, subject: Subject, codes: RowCodes) -> RowCodes:
        """With the verdicts of what is judged where a value is missing that another one stands beside."""
        for missing, instead in subject.instead:
            if not instead.is_due(self.rows.question.graph) or subject.block is None:
                continue
            beside = estimate_rows(
                self.rows, Reference(subject.block.name, None, missing.beside), inside=True
            )
            others, _ = self.judged(instead)
            is_filled = (codes == NOT_CHECKED) & (others != NOT_MET) & ~beside.missing(self.rows.count)
            codes = np.where(is_filled, others, codes).astype(np.int8)
        return codes

    @cached_property
    def _shifting(self) -> RowShifting:
        return RowShifting(self.rows)

    def _estimates(self, subject: Subject) -> dict[str, RowEstimate]:
        """The values that a criterion names, as far as there are any."""
        estimates = {
            n: estimate_rows(self.rows, r, inside=subject.block is not None and r.analysis != LIMITS)
            for n, r in subject.references.items()
        }
        for limit in subject.criterion.limits:
            if limit.name not in estimates and (given := self._limit(subject, limit, estimates)) is not None:
                estimates[limit.name] = given
        return estimates

    def _limit(self, subject: Subject, limit: Limit, others: Mapping[str, RowEstimate]) -> RowEstimate | None:
        """A limit of the user: one for all rows, or a curve beside a curve."""
        assert subject.block is not None
        given = subject.block.limits.get(limit.name)
        if given is not None:
            rank = np.ndim(given.value)
            curve = next((other for other in others.values() if other.axes), None)
            if rank and (curve is None or np.shape(given.value) != curve.value.places):
                return None
            return RowEstimate(Column(given.value), axes=rank)
        step = self.rows.steps.get(subject.block.name)
        if limit.default is None or step is None:
            return None
        function, name = limit.default
        cell = subject.block.cells.get(name)
        column = self.rows.cells.get(cell) if cell else None
        if column is None or not column.rank:
            return None
        end = {"min": np.min, "max": np.max}[function](column.value, axis=-1)
        return RowEstimate(Column(end, column.is_row))

    def _compared(
        self, subject: Subject, estimates: Mapping[str, RowEstimate]
    ) -> tuple[Array, list[Array], bool]:
        """Verdicts and both sides with the errors that reach them from upstream."""
        shifting, count = self._shifting, self.rows.count
        origins = NONE
        for reference in subject.references.values():
            origins |= shifting.beneath(reference)
        moved, is_whole = shifting.shifts(subject.references, origins)
        unknown = shifting.unknown(origins)
        if unknown.any():
            estimates = {
                name: _tainted(one, unknown) if name in subject.references else one
                for name, one in estimates.items()
            }
        rank = max(estimate.rank for estimate in estimates.values())
        fitted = {name: estimate.padded(rank) for name, estimate in estimates.items()}
        constant = {n: fitted[n].value for n in fitted if n not in subject.references}
        shifts: list[Shift] = [
            (
                {**constant, **_padded(low, estimates, rank)},
                {**constant, **_padded(high, estimates, rank)},
            )
            for low, high in moved
        ]
        compared = compare(subject.criterion, fitted, shifts)
        has_rows = any(one.value.is_row or one.error.is_row for one in estimates.values())
        if not has_rows and np.ndim(compared.codes):
            compared = replace(compared, codes=np.asarray(compared.codes)[None])
        codes, sides = worst_of_rows(subject.criterion, compared, count)
        is_stated = is_whole and shifting.is_stated(origins)
        return codes, sides, is_stated and all(one.is_stated for one in estimates.values())

    def _not_checked(
        self, criterion: Criterion, estimates: Mapping[str, RowEstimate]
    ) -> tuple[RowCodes, JudgedColumn]:
        """No verdict in any row; a side that has a single value is reported."""
        count = self.rows.count
        nothing = np.full(count, np.nan)
        value, limit = (self._side(side, estimates) for side in (criterion.value, criterion.limit))
        is_stated = all(estimate.is_stated for estimate in estimates.values())
        column = JudgedColumn(value, limit, nothing, nothing, nothing, nothing, is_stated)
        return np.full(count, NOT_CHECKED, dtype=np.int8), column

    def _side(self, side: Relation, estimates: Mapping[str, RowEstimate]) -> Array:
        """The value of a side, where it is one for each row."""
        count = self.rows.count
        if side.names <= estimates.keys() and not any(estimates[n].value.rank for n in side.names):
            value = side_of(side, {name: estimates[name].padded(0) for name in side.names})
            return np.broadcast_to(np.asarray(value, dtype=float), (count,))
        return np.full(count, np.nan)


def _tainted(estimate: RowEstimate, unknown: NDArray[np.bool_]) -> RowEstimate:
    """An estimate whose error is not known in the rows in which one upstream is not."""
    error = np.where(unknown, np.nan, estimate.error.spread(unknown.size))
    return replace(estimate, error=Column(error, is_row=True))


def _padded(
    values: Mapping[str, Column], estimates: Mapping[str, RowEstimate], rank: int
) -> dict[str, Value]:
    return {name: column.padded(rank + estimates[name].axes) for name, column in values.items()}


def _column(criterion: Criterion, sides: list[Array], is_stated: bool) -> JudgedColumn:
    """The numbers of each row, as a report of a single design has them."""
    value, limit, low, high, *_ = sides
    is_least = criterion.sign == ">="
    with np.errstate(all="ignore"):
        share = limit / value if is_least else value / limit
    is_share = (value > 0) & (limit > 0) & np.isfinite(share) & (not criterion.is_temperature)
    margin = value - limit if is_least else limit - value
    return JudgedColumn(value, limit, low, high, np.where(is_share, share, np.nan), margin, is_stated)
