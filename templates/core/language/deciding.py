"""Which rows meet a criterion, at the least cost: finer levels are asked only where it is undecided.

A pure function over arrays, for studies and benchmarks: no database and no design. All rows begin at one
level. Those that stay undecided climb, within the truth that the finest level has, past levels whose stated
error is not smaller, until they are decided, no such level is left, or the budget is spent.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.core.errors import Fault, InvalidInputs, unknown_name
from templates.core.judging.comparison import NOT_CHECKED, UNDECIDED
from templates.core.judging.criterion import Criterion
from templates.core.judging.judging import judge
from templates.core.judging.limits import GivenLimit
from templates.core.language.criteria import Evaluated, estimates_of
from templates.core.language.evaluate import evaluate_at_level
from templates.core.language.levels import accuracy
from templates.core.language.request import read_request
from templates.core.language.template import Template

Stop = Literal["decided", "no_finer_level", "budget"]
Codes = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Trial:
    """One level that was asked: of how many rows, how many it decided, and the time that it took [s]."""

    level: str
    rows: int
    decided: int
    seconds: float


@dataclass(frozen=True)
class Decided:
    """The verdict of every row.

    Attributes
    ----------
    codes
        Verdicts as places in `judging.comparison.WORST_FIRST`.
    levels
        At which level each row was judged.
    trials
        What was spent, in order.
    skipped
        Levels that were left out, and why.
    """

    codes: Codes
    levels: NDArray[np.object_]
    trials: tuple[Trial, ...]
    skipped: Mapping[str, str]
    stopped: Stop

    @property
    def seconds(self) -> float:
        """The time that all levels took."""
        return sum(trial.seconds for trial in self.trials)


def decide_rows(
    cls: type[Template],
    raw: Mapping[str, Any],
    criterion: str,
    *,
    limits: Mapping[str, Any] | None = None,
    level: str | None = None,
    budget: float = float("inf"),
) -> Decided:
    """The verdicts of a template's criterion for arrays of inputs.

    Parameters
    ----------
    cls
        The template.
    raw
        Inputs as a user types them; arrays make the rows.
    criterion
        The name of one of its criteria.
    limits
        Those that the criterion takes from its user, each for all rows or one for each.
    level
        With which to begin; the cheapest, if None.
    budget
        After which no further level begins [s].

    Raises
    ------
    InvalidInputs
        With everything that is wrong with inputs, limits or names.
    """
    declared = {one.name: one for one in cls.declared_criteria}
    if criterion not in declared:
        raise InvalidInputs([unknown_name(criterion, declared, "criterion")])
    request = read_request(cls, raw, [], None, level, limits)
    if len(request.template.shape_of_points()) > 1:
        detail = "rows are one axis; give every input a single value or a list of one length"
        raise InvalidInputs([Fault("inputs", "shape", detail)])
    with np.errstate(all="ignore"):
        return _Rows(request.template, declared[criterion], request.limits).decided(level, budget)


@dataclass
class _Rows:
    """The rows of one request, and what is known of each so far."""

    template: Template
    criterion: Criterion
    limits: Mapping[str, GivenLimit]
    skipped: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        shape = self.template.shape_of_points() or (1,)
        self.codes: Codes = np.full(shape, NOT_CHECKED, dtype=np.int8)
        self.levels = np.full(shape, None, dtype=object)
        self.errors = np.full(shape, np.inf)
        self.valueless = np.ones(shape, dtype=bool)  # where no level so far gave the outputs a value
        self.expected: dict[str, Array] = {}  # what each level states for the rows, where they lie now
        self.measured = accuracy(type(self.template))

    def decided(self, level: str | None, budget: float) -> Decided:
        """Climb until nothing is left to decide."""
        ladder = self.template.ladder() or ("",)
        ladder = ladder[ladder.index(level) :] if level in ladder else ladder
        trials: list[Trial] = []
        left = np.ones(self.codes.shape, dtype=bool)
        stopped: Stop = "no_finer_level"
        start = time.perf_counter()
        for rung in ladder:
            due = left & self._is_worth(rung, ladder[-1])
            if not due.any():
                continue
            if trials and time.perf_counter() - start >= budget:
                stopped = "budget"
                break
            trials.append(self._asked(rung, due))
            left = (self.codes == UNDECIDED) | ((self.codes == NOT_CHECKED) & self.valueless)
            if not left.any():
                break
        stopped = "decided" if not (self.codes == UNDECIDED).any() else stopped
        return Decided(self.codes, self.levels, tuple(trials), dict(self.skipped), stopped)

    def _is_worth(self, level: str, finest: str) -> Mask:
        """The rows for which a level has the truth of the finest one, and a smaller error than so far."""
        everywhere = np.ones(self.codes.shape, dtype=bool)
        if not level or self.measured is None:
            return everywhere
        outputs = self._outputs()
        for output in outputs:
            if self.measured.truth(level, output) != self.measured.truth(finest, output):
                self.skipped[level] = f"its error of {output} was measured against another truth"
                return ~everywhere
        if level not in self.expected:
            return everywhere  # nothing was asked yet
        smaller: Mask = (self.expected[level] < self.errors) | self.valueless
        if not smaller.any():
            self.skipped[level] = "its stated error is nowhere smaller"
        return smaller

    def _outputs(self) -> list[str]:
        """The outputs of the criterion that a level has a say in."""
        formulas = self.template.formulas
        named = [name for name in self.criterion.names if name in formulas]
        return [n for n in named if "level" in self.template.ancestors(formulas[n].attribute)]

    def _asked(self, level: str, due: Mask) -> Trial:
        """Judge the rows that are due at a level, as many at once as it takes."""
        start = time.perf_counter()
        rows = np.flatnonzero(due)
        most = self.template.most_points.get(level, rows.size)
        for first in range(0, rows.size, most):
            self._judge(level, rows[first : first + most])
        decided = (self.codes[rows] != UNDECIDED) & (self.codes[rows] != NOT_CHECKED)
        return Trial(level, int(rows.size), int(decided.sum()), time.perf_counter() - start)

    def _judge(self, level: str, rows: NDArray[np.intp]) -> None:
        where = np.zeros(self.codes.shape, dtype=bool)
        where[rows] = True
        is_single = not self.template.shape_of_points()
        template = self.template.at(level, None if is_single else where) if level else self.template
        try:
            codes, errors = self._judged(template, rows)
        except InvalidInputs:  # a level that refuses its rows decides nothing about them
            return
        better = (codes != NOT_CHECKED) & ((errors <= self.errors[rows]) | (codes != UNDECIDED))
        self.codes[rows[better]] = codes[better]
        self.levels[rows[better]] = level or None
        self.errors[rows] = np.fmin(errors, self.errors[rows])
        self._expect(template, rows)

    def _expect(self, template: Template, rows: NDArray[np.intp]) -> None:
        """What other levels state for rows where these lie now; nothing is calculated for it."""
        outputs = self._outputs()
        for level in self.template.ladder() if self.measured else ():
            stated = self.measured.expected(template, level, outputs) if self.measured else {}
            errors = self.expected.setdefault(level, np.full(self.codes.shape, np.inf))
            errors[rows] = _largest(stated, outputs, rows)

    def _judged(self, template: Template, rows: NDArray[np.intp]) -> tuple[Codes, Any]:
        """Verdicts of some rows at the template's level, and the largest error of its outputs."""
        names = [name for name in self.criterion.names if name in template.formulas]
        answers, errors, _ = evaluate_at_level(template, names)
        limits = {name: _picked(given, rows, self.codes.size) for name, given in self.limits.items()}
        evaluated = Evaluated(template, answers, errors, self.measured, limits, level=template.level)
        estimates, absent = estimates_of(evaluated, self.criterion)
        codes = np.broadcast_to(judge(self.criterion, estimates, absent).rows, rows.shape)
        values = [estimates[n].value if n in estimates else np.nan for n in self._outputs()]
        self.valueless[rows] = np.isnan(np.sum(np.broadcast_arrays(*values, np.zeros(rows.shape)), axis=0))
        return codes.astype(np.int8), _largest(errors, self._outputs(), rows)


def _largest(errors: Mapping[str, Any], outputs: list[str], rows: NDArray[np.intp]) -> Array:
    """The largest error of some outputs at each row; infinite where it is not stated."""
    stated = [np.nan_to_num(np.asarray(errors[name], dtype=float), nan=np.inf) for name in outputs]
    return np.max(np.broadcast_arrays(*stated, np.zeros(rows.shape)), axis=0)


def _picked(given: GivenLimit, rows: NDArray[np.intp], count: int) -> GivenLimit:
    """The limits of some rows, where each row has its own."""
    if np.shape(given.value) != (count,) or count == 1:
        return given
    return GivenLimit(np.asarray(given.value)[rows], given.source)
