"""Levels of fidelity: how wrong each is and what it costs, as measured; which is the cheapest that will do.

A template names its levels, cheapest first. Beside its file, `<id>_v<version>.accuracy.json` holds what a
script in `benchmarks/` measured: for every level and output the error against the converged solution, on a
grid over two of the template's quantities. The table lies outside the frozen file, so that a version may gain
a better one.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.declare import Text
from templates.core.errors import Fault, InvalidInputs
from templates.core.template import Template

Array = NDArray[np.float64]

SINGLE = "only"  # how the table of a template without levels calls its one


@dataclass(frozen=True)
class Accuracy:
    """Measured errors, relative (of an angle: to 90°), in the cells of a grid over two attributes."""

    axes: tuple[str, str]  # attributes of the template
    grids: tuple[Array, Array]  # ascending edges of the cells
    errors: dict[str, dict[str, Array]]  # by level and output: the largest found in each cell, NaN unmeasured
    told: dict[str, Any]  # the whole file, as it is served

    def error(self, template: Template, output: str) -> Any:
        """What `evaluate` reports: none of a text, 0 where the level does not matter, else the estimate."""
        formula = template.formulas[output]
        if isinstance(formula, Text):
            return np.full(_shape(template), np.nan)[()]
        if template.levels and "level" not in template.ancestors(formula.attribute):
            return np.zeros(_shape(template))[()]
        return self.estimate(template, output)

    def estimate(self, template: Template, output: str) -> Any:
        """The largest relative error to expect of an output at the template's level; NaN where not measured.

        A scalar, or an array of the shape of the axes' values.
        """
        table = self.errors.get(template.level or SINGLE, {}).get(output)
        if table is None:
            return np.full(_shape(template), np.nan)[()]
        first, second = (np.asarray(getattr(template, axis), dtype=float) for axis in self.axes)
        first, second = np.broadcast_arrays(first, second)
        rows, inside_rows = _cells(self.grids[0], first)
        columns, inside_columns = _cells(self.grids[1], second)
        return np.where(inside_rows & inside_columns, table[rows, columns], np.nan)[()]


def _cells(grid: Array, values: Array) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """The cell of the grid in which each value lies, and whether it lies in any."""
    cells = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, grid.size - 2)
    return cells, (values >= grid[0]) & (values <= grid[-1])


def accuracy_file(cls: type[Template]) -> Path:
    """Where the measured errors of a version stand."""
    return Path(inspect.getfile(cls)).with_suffix(".accuracy.json")


_known: dict[Any, Accuracy | None] = {}


def accuracy(cls: type[Template]) -> Accuracy | None:
    """The measured errors of a version, if they were measured."""
    if cls not in _known:
        path = accuracy_file(cls)
        _known[cls] = _loaded(path) if path.exists() else None
    return _known[cls]


def _loaded(path: Path) -> Accuracy:
    told = json.loads(path.read_text(encoding="utf-8"))
    (one, first), (two, second) = ((axis["attribute"], np.array(axis["values"])) for axis in told["axes"])
    errors = {
        level: {output: np.array(table, dtype=float) for output, table in measured["errors"].items()}
        for level, measured in told["levels"].items()
    }
    return Accuracy((one, two), (first, second), errors, told)


@dataclass(frozen=True)
class Rung:
    """A template at one level, for those points for which that level was chosen (all, if None)."""

    template: Template
    where: NDArray[np.bool_] | None


def climb(template: Template, outputs: Iterable[str], tolerance: float) -> Iterator[Rung]:
    """The cheapest level whose error estimates meet the tolerance for all outputs, point by point.

    What no level meets is calculated at the finest.
    """
    measured = accuracy(type(template))
    names = [name for name in outputs if not isinstance(template.formulas[name], Text)]
    ladder, left = template.ladder(), np.ones(_shape(template), dtype=bool)
    for level in ladder:
        rung = at_level(template, level, None if left.all() else left)
        met = level == ladder[-1] or (measured is not None and _meets(measured, rung, names, tolerance))
        chosen = np.zeros_like(left)
        chosen[left] = met
        if chosen.all():
            yield Rung(rung, None)
            return
        if chosen.any():
            yield Rung(rung if np.all(met) else template.at(level, chosen), chosen)
        left = left & ~chosen
        if not left.any():
            return


def at_level(template: Template, level: str, where: NDArray[np.bool_] | None = None) -> Template:
    """The template at a level, if that takes as many points at once.

    Raises
    ------
    InvalidInputs
        If there are too many.
    """
    count = int(np.prod(_shape(template))) if where is None else int(where.sum())
    most = template.most_points.get(level, count)
    if count > most:
        told = f"level {level} takes at most {most} points at once, not {count}; ask for fewer, or for less"
        raise InvalidInputs([Fault("level", "too_many_points", told)])
    return template.at(level, where)


def _meets(measured: Accuracy, rung: Template, names: list[str], tolerance: float) -> Any:
    """Where the errors of all outputs are within the tolerance; nowhere if the level refuses."""
    try:
        return np.logical_and.reduce([measured.error(rung, name) <= tolerance for name in names])
    except InvalidInputs:
        return False


def _shape(template: Template) -> tuple[int, ...]:
    """The shape of the points that the inputs make."""
    given = (vars(template)[name] for name in template.ledger.handed)
    arrays = (value for value in given if isinstance(value, np.ndarray))
    return np.broadcast_shapes(*(array.shape for array in arrays))
