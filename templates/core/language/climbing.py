"""Choose the level of fidelity: the cheapest whose stated errors are within a tolerance.

One level serves all points of a request: a level that changes from point to point makes steps in a curve, and
false optima. `per_point` takes the cheapest at each point instead.

An error that is not stated is no reason to climb, because nobody knows whether a finer level would be nearer
to anything: such a point stays at the level at which the template starts.
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


@dataclass(frozen=True)
class Rung:
    """A template at one level, for those points for which that level was chosen (all, if None)."""

    template: Template
    where: Mask | None


def climb(
    template: Template, outputs: Iterable[str], tolerance: float, *, per_point: bool = False
) -> Iterator[Rung]:
    """Yield the levels that answer a request with a tolerance; one, unless each point is to have its own.

    It is the cheapest level whose errors are within the tolerance for all outputs, else the finest; and the
    starting level where that states no error for an output. What has no value needs no error.
    """
    names = [name for name in outputs if not isinstance(template.formulas[name], Text)]
    search = _Search(template, names, tolerance, accuracy(type(template)))
    if per_point:
        yield from search.by_point()
    else:
        yield Rung(search.at(search.common()), None)


def reachable(cls: type[Template], ladder: tuple[str, ...]) -> tuple[str, ...]:
    """Return the levels that a tolerance may choose.

    None beyond the default one, if that states no error at all.
    """
    measured = accuracy(cls)
    if cls.default_level not in ladder or (measured and measured.states_any(cls.default_level)):
        return ladder
    return ladder[: ladder.index(cls.default_level) + 1]


def has_value(template: Template, output: str) -> Any:
    """Mask of the points where an output exists, of the shape of the points or a part of it."""
    formula = template.formulas[output]
    there = ~np.isnan(getattr(template, formula.attribute))
    return formula.inside(there) if isinstance(formula, Profile) else there


@dataclass(frozen=True)
class _Search:
    """The choice of levels for one request."""

    template: Template
    names: list[str]
    tolerance: float
    measured: Accuracy | None

    @cached_property
    def start(self) -> str:
        """Return the level that answers when nothing is known of any error."""
        return self.template.starting_level()

    @cached_property
    def ladder(self) -> tuple[str, ...]:
        return self.template.ladder()

    @cached_property
    def _at(self) -> dict[str, Template]:
        return {}

    def at(self, level: str) -> Template:
        """Return the template at a level, all points; kept, with what it has computed."""
        if level not in self._at:
            self._at[level] = at_level(self.template, level)
        return self._at[level]

    def common(self) -> str:
        """Return the one level that serves all points."""
        for level in self.ladder:
            rung = self.at(level)
            if self._met(rung, None).all() or (level == self.start and not self._stated(rung).all()):
                return level
        return self.ladder[-1]

    def by_point(self) -> Iterator[Rung]:
        """Yield the levels, each with the points at which it is the cheapest that serves."""
        left = np.ones(self.template.shape_of_points(), dtype=bool)
        for level in self.ladder:
            rung = self.at(level) if left.all() else at_level(self.template, level, left)
            chosen = left.copy()
            if level != self.ladder[-1]:
                chosen[left] = self._stays(rung, left)
            if chosen.all():
                yield Rung(rung, None)
            elif chosen.any():
                yield Rung(rung if (chosen == left).all() else self.template.at(level, chosen), chosen)
            left = left & ~chosen
            if not left.any():
                return

    def _stays(self, rung: Template, left: Mask) -> Mask:
        """Mask of the points left that a level serves."""
        stays = self._met(rung, left)
        if rung.level == self.start:
            stays = stays | ~self._stated(rung)
        return stays[left] if stays.shape == left.shape else stays

    def _met(self, rung: Template, where: Mask | None) -> Mask:
        """Return at which points all errors are within the tolerance; at none if the level refuses."""
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
        """Mask of where an output has a value at the starting level, of the shape of the points of a rung."""
        if rung.level == self.start:
            return np.zeros((), dtype=bool)
        try:
            there = np.broadcast_to(has_value(self.at(self.start), name), self.template.shape_of_points())
        except InvalidInputs:
            return np.ones((), dtype=bool)
        return there if where is None or where.all() else there[where]

    def _stated(self, rung: Template) -> Mask:
        """Return at which points every output that has a value has an error."""
        stated = np.ones((), dtype=bool)
        if self.measured is None:
            return ~stated
        errors = self.measured.of(rung, self.names)
        for name in self.names:
            try:
                stated = stated & (np.isfinite(errors[name]) | ~np.asarray(has_value(rung, name)))
            except InvalidInputs:
                return np.zeros((), dtype=bool)
        return stated
