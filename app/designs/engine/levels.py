"""Choose one level for all rows of a step: the cheapest whose stated error is small enough in most rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from app.designs.engine.calculation import Calculation
from app.designs.engine.columns import Column
from app.designs.engine.row_design import Levels, RowDesign, Rows, Targets
from app.designs.engine.steps import Part, StepRows
from app.designs.network import Block
from app.reference import Reference
from templates.core.arrays import Array, Mask
from templates.core.language.level_choice import best_first
from templates.core.language.levels import Accuracy, accuracy

S = TypeVar("S", bound=np.generic)

Passes = Callable[[str | None], Iterable[Calculation]]
"""A function that calculates the rows in chunks, with the step at a level."""


@dataclass(frozen=True)
class LevelChoice:
    """Chooses the levels of all steps for some rows.

    Attributes
    ----------
    rows
        A column for every varied place.
    wanted
        The values that will be calculated.
    """

    design: RowDesign
    rows: Rows
    count: int
    wanted: Targets

    def of_tolerances(self, levels: Levels) -> dict[str, str | None]:
        """Return the given levels, and chosen levels for steps with a tolerance but no own level."""
        chosen = dict(levels)
        for block in self.design.steps(self.wanted):
            if block.tolerance is not None and not (levels.get(block.name) or block.level):
                chosen[block.name] = self._level(block, chosen, block.tolerance, 1.0)
        return chosen

    def within(self, tolerance: float, share: float, starts: Levels) -> dict[str, str | None]:
        """Return the level of each step, chosen after the levels of the steps on which it depends.

        `starts` holds the starting levels of steps whose rows would otherwise start at different levels.
        """
        chosen = dict(starts)
        for block in self.design.steps(self.wanted):
            chosen[block.name] = block.level or self._level(block, chosen, tolerance, share)
        return chosen

    def _level(self, block: Block, levels: Levels, tolerance: float, share: float) -> str | None:
        cls = block.cls
        if not cls.levels:
            return None
        outputs = self.design.needs(self.wanted).outputs(block)
        inside = Targets.of(Reference(block.name, None, output) for output in outputs)

        def passes(level: str | None) -> Iterator[Calculation]:
            pinned = {**levels, block.name: level or levels.get(block.name)}
            return (rows for _, rows in self.design.passes(self.rows, self.count, inside, pinned))

        search = LevelSearch(block, outputs, passes, tolerance, share)
        is_a_choice = any("level" in cls.ancestors(cls.formulas[name].attribute) for name in outputs)
        return search.level() if is_a_choice else search.start


@dataclass(frozen=True)
class LevelSearch:
    """Chooses one level for a step.

    Attributes
    ----------
    outputs
        The outputs whose errors must be within the tolerance.
    share
        The share of rows in which they must be.
    """

    block: Block
    outputs: Sequence[str]
    passes: Passes
    tolerance: float
    share: float

    def level(self) -> str:
        """Return the cheapest sufficient level, or the finest that the budget allows (`level_choice`)."""
        measured = accuracy(self.block.cls)
        for level in self.ladder:
            if measured is None:
                break
            if self._may_serve(measured, level) and self._met(measured, level) >= self.share:
                return level
        count = sum(step.count for step in self._started)
        return next(best_first(self.block.cls, self.ladder, self.start, count))

    def _may_serve(self, measured: Accuracy, level: str) -> bool:
        """Return whether to calculate a level: a finer one only if it states small enough errors."""
        finer = level != self.start and self.ladder.index(level) > self._place
        return not finer or float(np.mean(self._expected(measured, level))) >= self.share

    @cached_property
    def _place(self) -> int:
        """Return the position of the starting level on the ladder; -1 if it is not on it."""
        return self.ladder.index(self.start) if self.start in self.ladder else -1

    @cached_property
    def _started(self) -> list[StepRows]:
        return self._calculated(None)

    @property
    def _parts(self) -> Iterator[tuple[StepRows, Part]]:
        return ((step, part) for step in self._started for part in step.parts)

    @cached_property
    def start(self) -> str:
        """Return the level at which the step starts."""
        return next((step.level for step in self._started if step.level), self.block.cls.default_level)

    @cached_property
    def ladder(self) -> tuple[str, ...]:
        """Return the levels that can calculate these rows, cheapest first."""
        return next((part.template.ladder() for _, part in self._parts), (self.block.cls.default_level,))

    @cached_property
    def _exists(self) -> dict[str, Mask]:
        """Return, for each output, a mask of the rows in which it has a value at the starting level."""
        return {name: _joined(_has_value(step, name) for step in self._started) for name in self.outputs}

    def _met(self, measured: Accuracy, level: str) -> float:
        """Return the share of rows in which all errors of a level are small enough."""
        if level in self.block.cls.most_points:
            return float(np.mean(self._expected(measured, level)))
        steps = self._started if level == self.start else self._calculated(level)
        return self._share(steps, self.tolerance)

    def _share(self, steps: Sequence[StepRows], tolerance: float) -> float:
        """Return the share of rows in which every output has a small enough error.

        An output without a value also counts if it has no value at the starting level either.
        """
        met = np.ones(sum(step.count for step in steps), dtype=bool)
        for name in self.outputs:
            there = _joined(_has_value(step, name) for step in steps)
            errors = _joined(step.error(name).spread(step.count) for step in steps)
            met &= np.where(there, errors <= tolerance, ~self._exists[name])
        return float(np.mean(met))

    def _calculated(self, level: str | None) -> list[StepRows]:
        """Return the step calculated in each chunk of rows, without chunks where it is pending or refused."""
        nothing = StepRows(self.block, 1, has_rows=False)
        return [rows.step(self.block.name) or nothing for rows in self.passes(level)]

    def _expected(self, measured: Accuracy, level: str) -> Mask:
        """Return a mask of the rows for which the stated errors of a level are small enough."""
        met = np.ones(sum(step.count for step in self._started), dtype=bool)
        for name in self.outputs:
            errors = _joined(_expected(measured, step, level, name) for step in self._started)
            met &= (errors <= self.tolerance) | ~self._exists[name]
        return met


def _joined(chunks: Iterable[NDArray[S]]) -> NDArray[S]:
    return np.concatenate(list(chunks))


def _has_value(step: StepRows, output: str) -> Mask:
    """Return a mask of the rows in which an output has a value."""
    return Column(step.column(output).spread(step.count), is_row=True).finite_rows()


def _expected(measured: Accuracy, step: StepRows, level: str, output: str) -> Array:
    """Return the errors that a level states for the rows of a step; infinite where it states none."""
    errors = np.full(step.count, np.inf)
    for part in step.parts:
        errors[part.rows] = measured.expected(part.template, level, [output])[output]
    return errors
