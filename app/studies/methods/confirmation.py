"""Compare the result promised by the coarse level with that of the fine level at the same place."""

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
"""Relative difference between promise and truth that counts as agreement."""
TINY = 1e-9
"""Of the middle size of a column: differences below it are none."""

State = Literal["settled", "unconfirmed", "undecided", "infeasible", "not_settled"]


@dataclass(frozen=True)
class Round:
    """One place that was confirmed.

    Attributes
    ----------
    at
        The varied values [SI], shape (d,).
    promise, confirmed
        Objectives, then the values and the limits of the criteria [SI], shape (k + 2 m,).
    codes
        The verdict on each criterion, of the confirming level, as places in `VERDICTS`.
    worst
        The margin of each criterion at the bad end of its band [SI], shape (m,); itself if that is unknown.
    agrees
        Whether promise and truth agree.
    is_feasible
        Whether the search met every criterion by what it knew.
    reason
        Why the confirming level refuses the place; empty if it does not.
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
        """Return whether the search promised all criteria, but the fine level violates a limit."""
        return self.is_feasible and bool((self.worst < 0).any())

    @property
    def is_met(self) -> bool:
        """Return whether the place has results, and every criterion is met."""
        return bool(np.isfinite(self.confirmed).all()) and all(one >= MET_ERROR_UNKNOWN for one in self.codes)

    @property
    def is_known(self) -> bool:
        """Return whether no criterion is met with an error that is not known."""
        return MET_ERROR_UNKNOWN not in self.codes

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Return the verdict on each criterion, of the confirming level."""
        return tuple(VERDICTS[code] for code in self.codes)


class Run:
    """A search at a coarse level and its confirmations; counts what both cost.

    Raises
    ------
    InvalidInputs
        With code `all_refused`, if no row of the scan has results.
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
        """Return the time of the rows [s], as the answers state it."""
        return self.explore.seconds + self._confirm.seconds

    @property
    def rows(self) -> tuple[int, int]:
        """Return rows asked of the coarse and of the fine level."""
        return self.explore.rows, self._confirm.rows

    def confirmed(self, unit: Array) -> tuple[list[Round], Columns]:
        """Return places of the unit cube, shape (N, d), at the fine level, and its columns.

        Corrects nothing yet.
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
        """Return the place farthest from all confirmed ones, shape (1, d), in the best quarter of the scan.

        Best is what is nearest to feasible by the coarse level alone, without corrections.
        """
        raw = CorrectedAnswer(self.problem, self.explore, self.scales)
        seen = raw.seen(self.scanned.unit, self.scanned.columns)
        rows = np.flatnonzero(seen.complete)
        rows = rows[np.argsort(seen.violation[rows], kind="stable")[: max(1, len(rows) // 4)]]
        unit = self.scanned.unit[rows]
        apart = np.linalg.norm(unit[:, None] - np.array(self.surface.places), axis=2).min(axis=1)
        return unit[[int(apart.argmax())]]

    def learn(self, unit: Array, rounds: Sequence[Round], fine: Columns) -> None:
        """Correct by the places confirmed last; where a guarded one fell short, hold twice that besides."""
        if self.surface.guards:
            short = [
                np.maximum(-one.worst, 0.0) / self.scales for one in rounds if one.agrees and one.fell_short
            ]
            self.surface.reserve = self.surface.reserve + 2 * np.max(short, axis=0, initial=0.0)
        for row in range(len(unit)):
            if np.isfinite(rounds[row].confirmed).all():
                self.surface.learn(unit[row : row + 1], self._coarse.row(row), fine.row(row))


def unmet(rounds: Sequence[Round]) -> State:
    """Return the state of a search whose agreed places are not met."""
    return "infeasible" if any(NOT_MET in one.codes for one in rounds) else "undecided"


def state_of_met(rounds: Sequence[Round]) -> State:
    """Return the state of a search whose agreed places are met."""
    return "settled" if all(one.is_known for one in rounds) else "unconfirmed"
