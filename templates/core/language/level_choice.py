"""Choose the level of fidelity: the cheapest level with stated errors within a tolerance.

One level serves all points of a request, because a change of level from point to point would put steps and
false optima into curves. `per_point` chooses the cheapest level for each point instead.

If no level is known to be within the tolerance, the finest level whose stated cost is within the budget is
chosen: a user who gives a tolerance wants the most accurate answer, not the cheapest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from templates.core.arrays import Mask
from templates.core.errors import InvalidInputs
from templates.core.language.levels import Accuracy, accuracy, at_level
from templates.core.language.spec import Profile, Text
from templates.core.language.template import Template

BUDGET = 10.0
"""Largest stated cost [s] of a level that may be chosen without a known error."""


@dataclass(frozen=True)
class Rung:
    """A template at one level, and the points for which that level was chosen (all, if None)."""

    template: Template
    where: Mask | None


def climb(
    template: Template, outputs: Iterable[str], tolerance: float, *, per_point: bool = False
) -> Iterator[Rung]:
    """Yield the levels for a request with a tolerance: one for all points, or several if `per_point`.

    The level is the cheapest whose errors are within the tolerance for all outputs, or else the finest within
    the budget. Outputs without a value are ignored.
    """
    names = [name for name in outputs if not isinstance(template.formulas[name], Text)]
    search = _Search(template, names, tolerance, accuracy(type(template)))
    if per_point:
        yield from search.by_point()
    else:
        yield Rung(search.at(search.common()), None)


def reachable(cls: type[Template], ladder: tuple[str, ...]) -> tuple[str, ...]:
    """Return the levels that a tolerance may choose.

    These are the levels up to the default level, and finer levels that state an error or are within the
    budget.
    """
    if cls.default_level not in ladder:
        return ladder
    start = ladder.index(cls.default_level)
    finer = (level for level in ladder[start + 1 :] if states_any(cls, level) or is_affordable(cls, level, 1))
    return (*ladder[: start + 1], *finer)


def states_any(cls: type[Template], level: str) -> bool:
    """Return whether a level states any error."""
    measured = accuracy(cls)
    return measured is not None and measured.states_any(level)


def is_affordable(cls: type[Template], level: str, points: int) -> bool:
    """Return whether a level accepts this number of points at once, at a stated cost within the budget.

    A level without a stated cost is affordable if it states an error.
    """
    measured = accuracy(cls)
    if measured is None or points > cls.most_points.get(level, points):
        return False
    cost = measured.content.get("levels", {}).get(level, {}).get("cost")
    if not cost:
        return measured.states_any(level)
    single = float(cost["single"])
    return single + (points - 1) * float(cost.get("vectorised", single)) <= BUDGET


def best_first(cls: type[Template], ladder: tuple[str, ...], start: str, points: int) -> Iterator[str]:
    """Yield the affordable levels from the finest to the starting level, which is always included."""
    finer = ladder[ladder.index(start) + 1 :] if start in ladder else ()
    yield from (level for level in reversed(finer) if is_affordable(cls, level, points))
    yield start


def has_value(template: Template, output: str) -> Any:
    """Return the mask of the points where an output exists; it broadcasts to the shape of the points."""
    formula = template.formulas[output]
    there = ~np.isnan(getattr(template, formula.attribute))
    return formula.inside(there) if isinstance(formula, Profile) else there


@dataclass(frozen=True)
class _Search:
    """The search for the levels of one request."""

    template: Template
    names: list[str]
    tolerance: float
    measured: Accuracy | None

    @cached_property
    def start(self) -> str:
        """Return the level used when no error is known."""
        return self.template.starting_level()

    @cached_property
    def ladder(self) -> tuple[str, ...]:
        return self.template.ladder()

    @cached_property
    def _at(self) -> dict[str, Template]:
        return {}

    def at(self, level: str) -> Template:
        """Return the template at a level for all points; it is cached with its results."""
        if level not in self._at:
            self._at[level] = at_level(self.template, level)
        return self._at[level]

    def common(self) -> str:
        """Return the one level that serves all points."""
        for level in self._promising:
            if self._met(self.at(level), None).all():
                return level
        return self.best(int(np.prod(self.template.shape_of_points())))

    def best(self, points: int) -> str:
        """Return the finest level within the budget that accepts the inputs."""
        levels = best_first(type(self.template), self.ladder, self.start, points)
        return next((level for level in levels if self._answers(level)), self.start)

    @property
    def _promising(self) -> Iterator[str]:
        """Yield the levels up to the starting level, and finer levels with stated errors."""
        cls, start = type(self.template), self.start
        last = self.ladder.index(start) if start in self.ladder else 0
        for i, level in enumerate(self.ladder):
            if i <= last or states_any(cls, level):
                yield level

    def _answers(self, level: str) -> bool:
        """Return whether a level can calculate these inputs."""
        try:
            rung = self.at(level)
            for name in self.names:
                has_value(rung, name)
        except InvalidInputs:
            return False
        return True

    def by_point(self) -> Iterator[Rung]:
        """Yield the levels, each with the points at which it is the cheapest sufficient level."""
        left = np.ones(self.template.shape_of_points(), dtype=bool)
        for level in self._promising:
            rung = self.at(level) if left.all() else at_level(self.template, level, left)
            chosen, met = left.copy(), self._met(rung, left)
            chosen[left] = met[left] if met.shape == left.shape else met
            if chosen.any():
                yield Rung(rung if (chosen == left).all() else self.template.at(level, chosen), _part(chosen))
            left = left & ~chosen
            if not left.any():
                return
        yield Rung(self._best_of(left), _part(left))

    def _best_of(self, left: Mask) -> Template:
        """Return the template at the best level for the remaining points."""
        best = self.best(int(left.sum()))
        return self.at(best) if left.all() else at_level(self.template, best, left)

    def _met(self, rung: Template, where: Mask | None) -> Mask:
        """Return a mask of the points with all errors within the tolerance; all False on refusal."""
        met = np.ones((), dtype=bool)
        if self.measured is None:
            return ~met
        try:
            there = {name: np.asarray(has_value(rung, name)) for name in self.names}
        except InvalidInputs:
            return ~met
        errors = self.measured.of(rung, self.names)
        for name in self.names:
            within = np.asarray(errors[name] <= self.tolerance)
            if not (within | there[name]).all():
                within = within | ~(there[name] | self._wanted(rung, name, where))
            met = met & within
        return met

    def _wanted(self, rung: Template, name: str, where: Mask | None) -> Mask:
        """Return a mask of the points where an output has a value at the starting level, in their shape."""
        if rung.level == self.start:
            return np.zeros((), dtype=bool)
        try:
            there = np.broadcast_to(has_value(self.at(self.start), name), self.template.shape_of_points())
        except InvalidInputs:
            return np.ones((), dtype=bool)
        return there if where is None or where.all() else there[where]


def _part(chosen: Mask) -> Mask | None:
    """Return the chosen points; None if all points are chosen."""
    return None if chosen.all() else chosen
