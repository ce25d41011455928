"""Levels of fidelity: their measured errors and costs, and which levels have a smaller error.

A template lists its levels, cheapest first. Next to its file, `<id>_v<version>.accuracy.json` contains the
measurements of a script in `benchmarks/`: for every level and output the error against a converged solution,
on a grid over two of the template's quantities. The table is not part of the frozen file, so a released
version may get a better table.

Each level and output names its *truth*: the solution, with its conventions, against which the error was
measured. If two levels follow different conventions, their errors cannot be compared (`next_levels`). Every
error is relative to the truth, and the error of a profile to its largest absolute value:
`templates.core.criteria.bands.CONVENTION`, which the file repeats.

A level may compute the error of each answer itself (`Template.own_error`); the table then states the expected
error under `own`.

Errors may be measured separately for several cases of inputs, such as ways to feed a bearing. The table then
lists them under `cases`, and `Template.measured_case` returns the case of the inputs. If an error varies much
within a cell, `powers` gives exponents of template attributes by case, level and output: the error of the
cell is multiplied by these powers, within the range of each attribute that `within` gives by case. These
attributes depend only on the inputs and are the same at all levels.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.origin import file_of
from templates.core.language.spec import Text
from templates.core.language.template import Template

SINGLE = "only"  # name of the only level in the table of a template without levels


@dataclass(frozen=True)
class Condition:
    """Inputs that add a further error to that of the table, such as the inputs of a heat balance."""

    inputs: tuple[str, ...]
    measured: Mapping[str, Mapping[str, float | None]]  # by level and output: the additional error

    def holds(self, template: Template) -> bool:
        """Return whether any of the inputs of the condition is given."""
        return not template.ledger.typed.keys().isdisjoint(self.inputs)

    def added(self, template: Template, output: str) -> float:
        """Return the error that the condition adds to an output.

        It is 0 if the output does not depend on these inputs, and NaN if the error was not measured.
        """
        beneath = template.dependencies(template.formulas[output].attribute)
        if beneath.isdisjoint(template.inputs[name].attribute for name in self.inputs):
            return 0.0
        error = self.measured.get(template.level or SINGLE, {}).get(output)
        return np.nan if error is None or not template.is_measured() else error


@dataclass(frozen=True)
class Accuracy:
    """Measured errors, relative (of an angle: to 90°), in the cells of a grid over two attributes."""

    axes: tuple[str, str]  # attributes of the template
    grids: tuple[Array, Array]  # ascending edges of the cells
    errors: dict[
        str, dict[str, Array]
    ]  # by level and output: the largest measured in each cell, NaN unmeasured
    content: dict[str, Any]  # the whole file, as the API returns it

    @cached_property
    def cases(self) -> dict[str, dict[str, dict[str, Array]]]:
        """Return the errors of the separate cases of inputs, by case, level and output, in the same cells."""
        return {case: _tables(levels) for case, levels in self.content.get("cases", {}).items()}

    def own(self, level: str) -> Mapping[str, float]:
        """Return the expected error, by output, of a level that computes the error of each answer itself."""
        of_level: Mapping[str, Mapping[str, float]] = self.content.get("levels", {}).get(level, {})
        return of_level.get("own", {})

    def states_any(self, level: str) -> bool:
        """Return whether any error is stated at a level, in any case."""
        if self.own(level):
            return True
        measured = (self.errors, *self.cases.values())
        return any(
            np.isfinite(table).any() for levels in measured for table in levels.get(level, {}).values()
        )

    @cached_property
    def outputs(self) -> frozenset[str]:
        """Return the outputs with measured errors at any level."""
        return frozenset(output for table in self.errors.values() for output in table)

    def of(self, template: Template, outputs: Iterable[str]) -> dict[str, Any]:
        """Return the errors that `evaluate` reports, by output.

        An error is the largest relative error to expect at the template's level; for a profile it is relative
        to its largest absolute value. It is 0 if the output is the same at all levels, and NaN if none is
        stated. Errors are scalars, or arrays of the shape of the points. The names must not include texts.
        """
        errors = self.expected(template, template.level, outputs)
        own = self.own(template.level)
        if own and template.states_own_errors():
            for name in own.keys() & errors.keys():
                errors[name] = template.own_error(name) + self._added(template, name)
        return errors

    def expected(self, template: Template, level: str, outputs: Iterable[str]) -> dict[str, Any]:
        """Return the errors stated for a level, in the cell that the template has at its own level."""
        names, levels = list(outputs), self.errors
        if self.cases:
            levels = self.cases.get(template.measured_case(), levels)
        tables = levels.get(level or SINGLE, {})
        there = template if level == template.level else template.at(level)
        exact = {name for name in names if _same_at_all_levels(template, name)} if template.levels else set()
        own = self.own(level or SINGLE)
        own = own if own and there.states_own_errors() else {}
        available = tables if there.is_measured() else {}
        measured = [name for name in names if name in available and name not in exact and name not in own]
        cell = self._cell(template) if measured else None
        estimates = {name: _looked_up(tables[name], cell) for name in measured}
        if measured and "powers" in self.content:
            estimates = {name: e * self._power(template, level, name) for name, e in estimates.items()}
        errors: dict[str, Any] = estimates
        if len(estimates) < len(names):
            none = np.zeros(template.shape_of_points())[()]
            estimates |= {name: none + own[name] for name in names if name in own and name not in exact}
            unknown = none + np.nan
            errors = {n: estimates[n] if n in estimates else none if n in exact else unknown for n in names}
        if not any(one.holds(there) for one in self._conditions):
            return errors
        return {name: error + self._added(there, name) for name, error in errors.items()}

    def _power(self, template: Template, level: str, output: str) -> Any:
        """Return the factor on an error from powers of attributes; NaN outside an attribute's range."""
        case = template.measured_case()
        exponents = self.content["powers"].get(case, {}).get(level, {}).get(output, {})
        within = self.content.get("within", {}).get(case, {})
        factors = (_within(getattr(template, name), within.get(name)) ** e for name, e in exponents.items())
        return prod(factors)

    def _added(self, template: Template, output: str) -> float:
        """Return the sum of the errors that the active conditions add to an output."""
        return sum(one.added(template, output) for one in self._conditions if one.holds(template))

    def seconds(self, template: Template, level: str) -> float | None:
        """Return the expected processor time of all points at a level [s]; None if the table states none.

        `expected_seconds` of the table gives the time of one point by level and case: a single number, or one
        for each cell of `grids` over the axes.
        """
        by_level = self.content.get("expected_seconds", {}).get(level, {})
        stated = by_level.get("cases", {}).get(template.measured_case() if self.cases else "")
        if stated is None:
            return None
        table = np.array(stated, dtype=float)
        if table.ndim:
            values = np.broadcast_arrays(*(np.asarray(getattr(template, axis), float) for axis in self.axes))
            grids = (np.array(grid) for grid in by_level["grids"])
            (rows, is_row), (columns, is_column) = map(_places, grids, values)
            table = np.where(is_row & is_column, table[rows, columns], np.nan)
        each = np.broadcast_to(table, template.shape_of_points())
        return float(each.sum()) if np.isfinite(each).all() else None

    def truth(self, level: str, output: str) -> str | None:
        """Return the name of the solution against which an output was measured; None if none is stated."""
        truths: Mapping[str, str] = self.content.get("levels", {}).get(level or SINGLE, {}).get("truth", {})
        return truths.get(output)

    @cached_property
    def _conditions(self) -> tuple[Condition, ...]:
        return tuple(
            Condition(tuple(one["inputs"]), one["added"]) for one in self.content.get("conditions", ())
        )

    def _cell(self, template: Template) -> tuple[Any, Any, Any]:
        """Return the row and column of the cell of each point, and whether the point lies within the grid."""
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
    """Return whether an output that is not text has the same value at every level."""
    formula = template.formulas[output]
    if isinstance(formula, Text):
        return False
    return "level" not in template.ancestors(formula.attribute)


def _within(value: Any, limits: tuple[float, float] | None) -> Any:
    """Return a value, or NaN if it is outside the limits."""
    if limits is None:
        return value
    return np.where((value >= limits[0]) & (value <= limits[1]), value, np.nan)[()]


def _looked_up(table: Array, cell: Any) -> Any:
    rows, columns, inside = cell
    if isinstance(inside, bool):
        return table[rows, columns] if inside else np.float64(np.nan)
    return np.where(inside, table[rows, columns], np.nan)[()]


def _place(edges: list[float], value: float) -> tuple[int, bool]:
    """Return the result of `_places` for a single value."""
    place = min(max(bisect_right(edges, value) - 1, 0), len(edges) - 2)
    return place, bool(edges[0] <= value <= edges[-1])


def _places(grid: Array, values: Array) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the index of the grid cell of each value, and whether the value lies within the grid."""
    cells = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, grid.size - 2)
    return cells, (values >= grid[0]) & (values <= grid[-1])


def accuracy_file(cls: type[Template]) -> Path | None:
    """Return the file of the measured errors of a version.

    A worksheet has none, because its errors are not measured.
    """
    path = file_of(cls)
    return path and path.with_suffix(".accuracy.json")


_cache: dict[Any, Accuracy | None] = {}


def accuracy(cls: type[Template]) -> Accuracy | None:
    """Return the measured errors of a version, if they were measured."""
    if cls.sheet:
        return None
    if cls not in _cache:
        path = accuracy_file(cls)
        _cache[cls] = _loaded(path) if path and path.exists() else None
    return _cache[cls]


def _loaded(path: Path) -> Accuracy:
    content = json.loads(path.read_text(encoding="utf-8"))
    (one, first), (two, second) = ((axis["attribute"], np.array(axis["values"])) for axis in content["axes"])
    errors = _tables({level: measured["errors"] for level, measured in content["levels"].items()})
    return Accuracy((one, two), (first, second), errors, content)


def _tables(levels: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Array]]:
    """Return errors by level and output as arrays over the cells, NaN for null."""
    return {
        level: {output: np.array(table, dtype=float) for output, table in outputs.items()}
        for level, outputs in levels.items()
    }


@dataclass(frozen=True)
class NextLevel:
    """A level with a smaller error, and that error at each point [-]."""

    level: str
    error: Any


def next_levels(template: Template, output: str) -> tuple[NextLevel, ...]:
    """Return the levels with a smaller stated error of an output for these inputs, cheapest first.

    The error must be smaller at one or more points, or be stated at a point where the template's level states
    none. Both errors must be measured against the same truth. The errors are looked up with the template's
    values at its own level; nothing is calculated at another level.
    """
    measured = accuracy(type(template))
    truth = measured.truth(template.level, output) if measured else None
    if measured is None or truth is None:
        return ()
    here = measured.of(template, [output])[output]
    others = (level for level in template.ladder() if measured.truth(level, output) == truth)
    errors = {level: measured.expected(template, level, [output])[output] for level in others}
    limit = np.where(np.isnan(here), np.inf, here)  # an unknown error is larger than any
    return tuple(NextLevel(level, error) for level, error in errors.items() if np.any(error < limit))


def at_level(template: Template, level: str, where: NDArray[np.bool_] | None = None) -> Template:
    """Return the template at a level, if the level accepts this number of points.

    Raises
    ------
    InvalidInputs
        If there are too many points.
    """
    count = int(np.prod(template.shape_of_points())) if where is None else int(where.sum())
    most = template.most_points.get(level, count)
    if count > most:
        points = "1 point" if most == 1 else f"{most} points"
        message = f"level {level} takes at most {points} at once, not {count}; ask for fewer, or for less"
        raise InvalidInputs([Fault("level", "too_many_points", message)])
    return template.at(level, where)
