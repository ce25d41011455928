"""Solve a design: find every value of an input between two bounds that gives a requested output.

The curve between the bounds takes a few array calls of the whole design, with each step at one level. Each
crossing is then confirmed at the levels of the design, or at the levels that a tolerance requires.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from app.designs.engine.design_engine import DesignEngine, Table
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.meaning import Meaning
from templates.core.language.roots import Roots, roots_of
from templates.core.language.scan import Outputs, SampledCurve, evenly

EXPLORED = 0.05
"""Relative error to which the curve between the bounds is calculated."""
PROBED = 33  # number of rows from which levels are chosen


@dataclass(frozen=True)
class RootQuestion:
    """Request for the values of `unknown` between two bounds that give `target` the value `value` [SI].

    `tolerance` is the relative error to which solutions are confirmed. None means the tolerance of the
    design.
    """

    unknown: Reference
    between: tuple[float, float]
    target: Reference
    value: float
    tolerance: float | None = None


@dataclass(frozen=True)
class DesignCurve(SampledCurve):
    """An output of a design as a function of one of its values, with each step at one level."""

    engine: DesignEngine
    unknown: Reference
    target: Reference
    levels: Mapping[str, str | None]

    @property
    def level(self) -> str | None:
        """Return the level of the step that has the output."""
        return self.levels.get(self.target.block)

    @property
    def chooses(self) -> bool:
        """Return False, because all levels are fixed."""
        return False

    @property
    def rows(self) -> int:
        """Return the number of samples that one call can calculate at these levels."""
        return self.engine.rows_at_once([self.target], self.levels)

    def at_level(self, level: str) -> DesignCurve:
        """Return the same curve with the step of its output at another level."""
        return replace(self, levels={**self.levels, self.target.block: level})

    def is_at_levels_of(self, other: Self) -> bool:
        """Return whether every step has the same level as in another curve."""
        return self.levels == other.levels

    def level_at(self, x: float) -> str | None:
        """Return the level at one value of the unknown.

        Raises
        ------
        InvalidInputs
            If the design is refused there.
        """
        if refusal := self._table(np.array([x])).refusals.get(0):
            raise InvalidInputs([Fault(refusal.place, refusal.code, refusal.detail)])
        return self.level

    def outputs(self, x: Array) -> Outputs:
        """Return the output for some values of the unknown [SI]."""
        table = self._table(x)
        values, error = table.columns[self.target], table.errors.get(self.target)
        return Outputs(values, self._reasons(table), self.level, error)

    def _table(self, x: Array) -> Table:
        return self.engine({self.unknown: x}, [self.target], levels=self.levels)

    def _reasons(self, table: Table) -> NDArray[np.object_]:
        reasons: NDArray[np.object_] = np.full(table.count, None, dtype=object)
        absent = table.absent.get(self.target)
        reasons[np.isnan(table.columns[self.target])] = absent or "it does not exist here"
        for row, refusal in table.refusals.items():
            reasons[row] = f"{refusal.place}: {refusal.detail}"
        return reasons


@dataclass(frozen=True)
class DesignRoots:
    """All roots, and the curves on which they were found and confirmed."""

    roots: Roots
    scanned: DesignCurve
    requested: DesignCurve
    tolerance: float | None


def roots_of_design(engine: DesignEngine, wanted: RootQuestion) -> DesignRoots:
    """Return every value of the unknown that gives the target.

    Raises
    ------
    InvalidInputs
        If the design is refused at every solution.
    Unreachable
        If no value between the bounds gives the target; the error contains the reachable range.
    """
    cheap, fine = _levels(engine, wanted)
    x, y = (_meaning(engine, reference) for reference in (wanted.unknown, wanted.target))
    scanned = DesignCurve(x, y, wanted.value, engine, wanted.unknown, wanted.target, cheap)
    requested = replace(scanned, levels=fine)
    return DesignRoots(roots_of(requested, scanned, wanted.between), scanned, requested, wanted.tolerance)


def _levels(
    engine: DesignEngine, wanted: RootQuestion
) -> tuple[dict[str, str | None], dict[str, str | None]]:
    """Return the levels for the curve, and the levels for its solutions.

    No level for the curve is finer than the corresponding level for the solutions.
    """
    rows, outputs = {wanted.unknown: evenly(*wanted.between, PROBED)}, [wanted.target]
    cheap = engine.levels_for(rows, outputs, max(EXPLORED, wanted.tolerance or 0.0))
    if wanted.tolerance is not None:
        return cheap, engine.levels_for(rows, outputs, wanted.tolerance)
    middle = {wanted.unknown: np.array([rows[wanted.unknown][PROBED // 2]])}
    fine = engine(middle, outputs).levels
    return {step: _coarser(engine, step, level, fine.get(step)) for step, level in cheap.items()}, fine


def _coarser(engine: DesignEngine, step: str, one: str | None, other: str | None) -> str | None:
    """Return the cheaper of two levels of a step."""
    ladder = list(engine.graph.blocks[step].cls.levels)
    levels = [level for level in (one, other) if level in ladder]
    return min(levels, key=ladder.index) if levels else one


def _meaning(engine: DesignEngine, reference: Reference) -> Meaning:
    """Return the name of a value for messages, and its declared unit."""
    return Meaning(words=str(reference), unit=engine.unit(reference), name=str(reference))
