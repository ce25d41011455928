"""Levels of fidelity: how wrong each is and what it costs, as measured; which is the cheapest that will do.

A template names its levels, cheapest first. Beside its file, `<id>_v<version>.accuracy.json` holds what a
script in `benchmarks/` measured: for every level and output the error against the converged solution, on a
grid over two of the template's quantities. The table lies outside the frozen file, so that a version may gain
a better one.
"""

from __future__ import annotations

import inspect
import json
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.spec import Text
from templates.core.language.template import Template

SINGLE = "only"  # how the table of a template without levels calls its one


@dataclass(frozen=True)
class Accuracy:
    """Measured errors, relative (of an angle: to 90°), in the cells of a grid over two attributes."""

    axes: tuple[str, str]  # attributes of the template
    grids: tuple[Array, Array]  # ascending edges of the cells
    errors: dict[
        str, dict[str, Array]
    ]  # by level and output: the largest measured in each cell, NaN unmeasured
    content: dict[str, Any]  # the whole file, as it is served

    def of(self, template: Template, outputs: Iterable[str]) -> dict[str, Any]:
        """What `evaluate` reports: none of a text, 0 where the level does not matter, else the estimate.

        An estimate is the largest relative error to expect at the template's level, NaN where it was not
        measured. Scalars, or arrays of the shape of the points.
        """
        names, tables = list(outputs), self.errors.get(template.level or SINGLE, {})
        exact = {name for name in names if _same_at_all_levels(template, name)} if template.levels else set()
        available = tables if template.is_measured() else {}
        measured = [name for name in names if name in available and name not in exact]
        cell = self._cell(template) if measured else None
        estimates = {name: _looked_up(tables[name], cell) for name in measured}
        none = np.zeros(template.shape_of_points())[()]
        unknown = none + np.nan
        return {n: estimates[n] if n in estimates else none if n in exact else unknown for n in names}

    def _cell(self, template: Template) -> tuple[Any, Any, Any]:
        """Row and column of the cell in which each point lies, and whether it lies in any."""
        first, second = (getattr(template, axis) for axis in self.axes)
        if isinstance(first, float) and isinstance(second, float):  # NumPy would take ten times as long
            row, in_rows = _place(self._edges[0], first)
            column, in_columns = _place(self._edges[1], second)
            return row, column, in_rows and in_columns
        first, second = np.broadcast_arrays(np.asarray(first, float), np.asarray(second, float))
        rows, inside_rows = _places(self.grids[0], first)
        columns, inside_columns = _places(self.grids[1], second)
        return rows, columns, inside_rows & inside_columns

    @cached_property
    def _edges(self) -> tuple[list[float], list[float]]:
        return self.grids[0].tolist(), self.grids[1].tolist()


def _same_at_all_levels(template: Template, output: str) -> bool:
    """Whether an output, which is no text, has no other value at another level."""
    formula = template.formulas[output]
    if isinstance(formula, Text):
        return False
    return "level" not in template.ancestors(formula.attribute)


def _looked_up(table: Array, cell: Any) -> Any:
    rows, columns, inside = cell
    if isinstance(inside, bool):
        return table[rows, columns] if inside else np.float64(np.nan)
    return np.where(inside, table[rows, columns], np.nan)[()]


def _place(edges: list[float], value: float) -> tuple[int, bool]:
    """As `_places`, of one value."""
    place = min(max(bisect_right(edges, value) - 1, 0), len(edges) - 2)
    return place, bool(edges[0] <= value <= edges[-1])


def _places(grid: Array, values: Array) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """The cell of the grid in which each value lies, and whether it lies in any."""
    cells = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, grid.size - 2)
    return cells, (values >= grid[0]) & (values <= grid[-1])


def accuracy_file(cls: type[Template]) -> Path:
    """Where the measured errors of a version stand."""
    return Path(inspect.getfile(cls)).with_suffix(".accuracy.json")


_cache: dict[Any, Accuracy | None] = {}


def accuracy(cls: type[Template]) -> Accuracy | None:
    """The measured errors of a version, if they were measured."""
    if cls not in _cache:
        path = accuracy_file(cls)
        _cache[cls] = _loaded(path) if path.exists() else None
    return _cache[cls]


def _loaded(path: Path) -> Accuracy:
    content = json.loads(path.read_text(encoding="utf-8"))
    (one, first), (two, second) = ((axis["attribute"], np.array(axis["values"])) for axis in content["axes"])
    errors = {
        level: {output: np.array(table, dtype=float) for output, table in measured["errors"].items()}
        for level, measured in content["levels"].items()
    }
    return Accuracy((one, two), (first, second), errors, content)


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
    ladder, left = template.ladder(), np.ones(template.shape_of_points(), dtype=bool)
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
    count = int(np.prod(template.shape_of_points())) if where is None else int(where.sum())
    most = template.most_points.get(level, count)
    if count > most:
        message = (
            f"level {level} takes at most {most} points at once, not {count}; ask for fewer, or for less"
        )
        raise InvalidInputs([Fault("level", "too_many_points", message)])
    return template.at(level, where)


def _meets(measured: Accuracy, rung: Template, names: list[str], tolerance: float) -> Any:
    """Where the errors of all outputs are within the tolerance; nowhere if the level refuses."""
    try:
        for name in names:
            getattr(rung, rung.formulas[name].attribute)
        return np.logical_and.reduce([e <= tolerance for e in measured.of(rung, names).values()])
    except InvalidInputs:
        return False
