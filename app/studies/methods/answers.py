"""The functions that an optimiser calls: objectives and criteria of a design for rows of varied values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from app.studies.methods.space import Space
from templates.core.arrays import Array, Mask
from templates.core.criteria.comparison import verdicts
from templates.core.criteria.criterion import Sign
from templates.core.errors import Fault, InvalidInputs


@dataclass(frozen=True)
class Objective:
    """A result to be minimised or maximised."""

    name: str
    sense: Literal["minimise", "maximise"] = "minimise"


@dataclass(frozen=True)
class Held:
    """A criterion that the optimum must meet: its value `>=` or `<=` its limit."""

    name: str
    sign: Sign


@dataclass(frozen=True)
class Problem:
    """The variables, one or more objectives, and the criteria that must be met."""

    space: Space
    objectives: tuple[Objective, ...]
    held: tuple[Held, ...] = ()

    @property
    def senses(self) -> Array:
        """Return 1 for each objective to minimise, and -1 for each to maximise, shape (k,)."""
        return np.array([1.0 if one.sense == "minimise" else -1.0 for one in self.objectives])

    @property
    def signs(self) -> Array:
        """Return 1 for each criterion with `>=`, and -1 for each with `<=`, shape (m,)."""
        return np.array([1.0 if one.sign == ">=" else -1.0 for one in self.held])


@dataclass(frozen=True)
class Columns:
    """Results of N rows [SI], with NaN in refused rows.

    Attributes
    ----------
    objectives
        Shape (N, k).
    values, limits
        The two sides of each criterion, shape (N, m).
    low, high
        The margin of each criterion at the bad and at the good end of its error band, as far as known,
        shape (N, m); zero or more is safe.
    reasons
        Why a row is refused, by its number.
    seconds
        The cost of the rows [s]; results from storage state their original cost.
    is_known
        Where the error of a criterion that is met is known, shape (N, m); None means everywhere.
    """

    objectives: Array
    values: Array
    limits: Array
    low: Array
    high: Array
    reasons: Mapping[int, str] = field(default_factory=dict)
    seconds: float = 0.0
    is_known: Mask | None = None

    def row(self, number: int) -> Columns:
        """Return one row as columns with a single row."""
        part = slice(number, number + 1)
        arrays = (self.objectives, self.values, self.limits, self.low, self.high)
        objectives, values, limits, low, high = (array[part] for array in arrays)
        reasons = {0: self.reasons[number]} if number in self.reasons else {}
        certain = None if self.is_known is None else self.is_known[part]
        return Columns(objectives, values, limits, low, high, reasons, is_known=certain)

    def with_sides(self, part: Callable[[Array], Array]) -> Columns:
        """Return the columns with `part` of the arrays of shape (N, m); the rest stays."""
        certain = None if self.is_known is None else part(self.is_known.astype(float)) == 1
        return replace(
            self,
            values=part(self.values),
            limits=part(self.limits),
            low=part(self.low),
            high=part(self.high),
            is_known=certain,
        )

    def worst(self, problem: Problem) -> Array:
        """Return the margin of each criterion at the bad end of its band, shape (N, m).

        If a criterion has no band, its margin is returned.
        """
        margins = problem.signs * (self.values - self.limits)
        return np.where(np.isfinite(self.low), self.low, margins)

    def codes(self, problem: Problem) -> tuple[int, ...]:
        """Return the verdict on each criterion in the first row, as indices into `VERDICTS`."""
        margins = problem.signs * (self.values - self.limits)
        certain = np.ones_like(margins, dtype=bool) if self.is_known is None else self.is_known
        codes = verdicts(">=", margins, 0.0, (self.low, self.high), (0.0, 0.0), certain)
        return tuple(np.asarray(codes)[0].tolist())


def exact(problem: Problem, objectives: Array, values: Array, limits: Array) -> Columns:
    """Return columns whose criteria have no error band; `limits` may be one row for all."""
    limits = np.broadcast_to(limits, values.shape)
    margin = problem.signs * (values - limits)
    return Columns(objectives, values, limits, margin, margin)


Answer = Callable[[Array], Columns]
"""A pure function that returns the results at one level for rows [SI], shape (N, d)."""


class CountingAnswer:
    """A function that returns results, counts the requested rows, and adds up their cost [s]."""

    def __init__(self, answer: Answer) -> None:
        self._answer = answer
        self.rows = 0
        self.seconds = 0.0

    def __call__(self, rows: Array) -> Columns:
        """Return the results of rows [SI]."""
        columns = self._answer(rows)
        self.rows += len(rows)
        self.seconds += columns.seconds
        return columns


class AllRefused(InvalidInputs):
    """Raised if no row of a search has all results that the search needs."""


def all_refused(problem: Problem, columns: Columns, count: int) -> AllRefused:
    """Return the error of a search in which no row has results, with the most frequent reasons."""
    reasons = Counter(columns.reasons.values()).most_common(3)
    listed = "; ".join(f"{times} times: {reason}" for reason, times in reasons) or _absent(problem, columns)
    detail = f"none of {count} rows within the bounds can be calculated ({listed}); change the bounds"
    return AllRefused([Fault("vary", "all_refused", detail)])


def _absent(problem: Problem, columns: Columns) -> str:
    """Return a sentence that names the results that are missing in all rows."""
    named = [(one.name, columns.objectives[:, n]) for n, one in enumerate(problem.objectives)]
    named += [(f"criterion {one.name}", columns.values[:, n]) for n, one in enumerate(problem.held)]
    named += [(f"limit of {one.name}", columns.limits[:, n]) for n, one in enumerate(problem.held)]
    absent = [name for name, column in named if not np.isfinite(column).any()]
    return f"no value: {', '.join(absent)}" if absent else "each row lacks another value"
