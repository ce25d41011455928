"""Compare the coarse level's prediction with the fine level's result at the same point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.studies.methods.answers import Answer, Columns, CountingAnswer, Problem
from app.studies.methods.correction import CorrectedAnswer, SearchView, stacked
from app.studies.methods.search import Scan, scales, scan
from templates.core.arrays import Array
from templates.core.criteria.comparison import MET_ERROR_UNKNOWN, NOT_MET, VERDICTS, Verdict

WITHIN = 1e-3
"""Largest relative difference between prediction and fine level that counts as agreement."""
TINY = 1e-9
"""Differences below this share of a column's median are ignored."""

FAR = 0.3
"""Smallest distance in the unit cube of a challenger from all confirmed points."""
UNSEEN = 0.3
"""Relative difference between the levels that is possible far from all confirmed points of a young search."""

State = Literal["settled", "unconfirmed", "undecided", "infeasible", "not_settled"]


@dataclass(frozen=True)
class Round:
    """One confirmed point.

    Attributes
    ----------
    at
        The varied values [SI], shape (d,).
    promise, confirmed
        Objectives, then the values and the limits of the criteria [SI], as predicted by the corrected coarse
        level and as calculated by the fine level, shape (k + 2 m,).
    codes
        The fine level's verdict on each criterion, as indices into `VERDICTS`.
    worst
        The margin of each criterion at the bad end of its band [SI], shape (m,); the margin itself if the
        band is unknown.
    agrees
        Whether prediction and fine level agree.
    is_feasible
        Whether every criterion was met according to the prediction.
    reason
        Why the fine level refuses the point; empty if it does not.
    """

    at: Array
    promise: Array
    confirmed: Array
    codes: tuple[int, ...]
    worst: Array
    agrees: bool
    is_feasible: bool
    reason: str = ""

    @property
    def fell_short(self) -> bool:
        """Return whether the prediction met all criteria, but the fine level violates a limit."""
        return self.is_feasible and bool((self.worst < 0).any())

    @property
    def is_met(self) -> bool:
        """Return whether the point has results and meets every criterion."""
        return bool(np.isfinite(self.confirmed).all()) and all(one >= MET_ERROR_UNKNOWN for one in self.codes)

    @property
    def is_known(self) -> bool:
        """Return whether the error of every criterion that is met is known."""
        return MET_ERROR_UNKNOWN not in self.codes

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Return the fine level's verdict on each criterion."""
        return tuple(VERDICTS[code] for code in self.codes)


class Run:
    """A search at a coarse level with its confirmations; it counts the cost of both.

    Raises
    ------
    InvalidInputs
        If no row of the scan has results; the code is `all_refused`.
    """

    def __init__(self, problem: Problem, explore: Answer, confirm: Answer, seed: int, within: float) -> None:
        self.problem, self._within = problem, within
        self.explore, self._confirm = CountingAnswer(explore), CountingAnswer(confirm)
        self.scanned: Scan = scan(problem, self.explore, seed)
        self.scales = scales(self.scanned.columns)
        self.surface = CorrectedAnswer(problem, self.explore, self.scales)
        self._floors = TINY * np.nanmedian(np.abs(stacked(self.scanned.columns)), axis=0)

    @property
    def seconds(self) -> float:
        """Return the total cost of all rows [s], as the results state it."""
        return self.explore.seconds + self._confirm.seconds

    @property
    def rows(self) -> tuple[int, int]:
        """Return the numbers of rows calculated at the coarse and at the fine level."""
        return self.explore.rows, self._confirm.rows

    def confirmed(self, unit: Array) -> tuple[list[Round], Columns]:
        """Calculate points of the unit cube, shape (N, d), at the fine level; return rounds and columns.

        The corrections are not changed.
        """
        at = self.problem.space.at(unit)
        self._coarse, fine = self.explore(at), self._confirm(at)
        seen = self.surface.seen(unit, self._coarse)
        return [self._compared(at, seen, fine, row) for row in range(len(unit))], fine

    def _compared(self, at: Array, seen: SearchView, fine: Columns, row: int) -> Round:
        promise, confirmed = seen.columns[row], stacked(fine)[row]
        near = np.abs(promise - confirmed) <= np.maximum(self._within * np.abs(confirmed), self._floors)
        one = fine.row(row)
        return Round(
            at[row],
            promise,
            confirmed,
            one.codes(self.problem),
            one.worst(self.problem)[0],
            agrees=bool(near.all()),
            is_feasible=bool(seen.violation[row] == 0),
            reason=fine.reasons.get(row, ""),
        )

    def unknown_place(self) -> Array:
        """Return the point farthest from all confirmed points, shape (1, d), in the best quarter of the scan.

        The best quarter consists of the rows nearest to feasibility at the coarse level, without corrections.
        """
        raw = CorrectedAnswer(self.problem, self.explore, self.scales)
        seen = raw.seen(self.scanned.unit, self.scanned.columns)
        rows = np.flatnonzero(seen.complete)
        rows = rows[np.argsort(seen.violation[rows], kind="stable")[: max(1, len(rows) // 4)]]
        unit = self.scanned.unit[rows]
        apart = np.linalg.norm(unit[:, None] - np.array(self.surface.places), axis=2).min(axis=1)
        return self.problem.space.snapped(unit[[int(apart.argmax())]])

    def challenger(self, done: Sequence[Round], *, is_first: bool) -> Array | None:
        """Return the best predicted point that is feasible and far from all confirmed ones, shape (1, d).

        Return None if the levels would have to differ there by more than seems possible to make it the best:
        by `UNSEEN` at the first challenger, later by half of what their ratio differs between known points.
        """
        seen = self.surface.seen(self.scanned.unit, self.scanned.columns)
        unit = self.problem.space.snapped(self.scanned.unit)
        apart = np.linalg.norm(unit[:, None] - np.array(self.surface.places), axis=2).min(axis=1)
        rows = np.flatnonzero(seen.complete & (seen.violation == 0) & (apart >= FAR))
        if not len(rows):
            return None
        chosen = rows[seen.objectives[rows, 0].argmin()]
        promise = float(seen.objectives[chosen, 0])
        apart_by = UNSEEN if is_first else self.surface.ratio_spread / 2
        return unit[[chosen]] if promise - apart_by * abs(promise) < self._best(done) else None

    def promises_more(self, unit: Array, done: Sequence[Round]) -> bool:
        """Return whether a point, shape (d,), is predicted to be better than all confirmed ones."""
        seen, least = self.surface(unit[None]), self._best(done)
        is_better = float(seen.objectives[0, 0]) < least - self._within * abs(least)
        return is_better and bool(seen.violation[0] <= 0)

    def _best(self, done: Sequence[Round]) -> float:
        """Return the least confirmed objective that meets all criteria, with its sense."""
        sense = float(self.problem.senses[0])
        return min(sense * float(one.confirmed[0]) for one in done if one.is_met)

    def learn(self, unit: Array, rounds: Sequence[Round], fine: Columns) -> None:
        """Update the corrections with the latest confirmed points.

        If a guarded point still violated a limit, the reserve is increased by twice the violation.
        """
        if self.surface.guards:
            short = [
                np.maximum(-one.worst, 0.0) / self.scales for one in rounds if one.agrees and one.fell_short
            ]
            self.surface.reserve = self.surface.reserve + 2 * np.max(short, axis=0, initial=0.0)
        for row in range(len(unit)):
            if np.isfinite(rounds[row].confirmed).all():
                self.surface.learn(unit[row : row + 1], self._coarse.row(row), fine.row(row))


def unmet(rounds: Sequence[Round]) -> State:
    """Return the state of a search whose predictions are right, but whose points do not meet all criteria."""
    return "infeasible" if any(NOT_MET in one.codes for one in rounds) else "undecided"


def state_of_met(rounds: Sequence[Round]) -> State:
    """Return the state of a search whose predictions are right, and whose points meet all criteria."""
    return "settled" if all(one.is_known for one in rounds) else "unconfirmed"
