"""The objective and the requirements of a request as functions of rows of its free places.

A place with two ends, such as a fit, makes several rows of the engine of each row: one for each combination
of ends. A requirement is judged at the worst of them, and the objective is the worst one too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from time import process_time

import numpy as np

from app.answers.places import FreePlace, bounds_of
from app.answers.requirements import TargetBand
from app.designs.engine.design_engine import DesignEngine
from app.reference import Reference
from app.studies.archive import AnyArray
from app.studies.criteria import JUDGED, SIDES, judged_of
from app.studies.methods.answers import Answer, Columns, Problem
from app.studies.methods.points import sobol_sequence
from app.studies.methods.response_surface import ResponseSurface, fitted
from app.studies.methods.space import Values
from templates.core.arrays import Array, Integers

Levels = Mapping[str, str | None]
Chosen = tuple[int, ...]
"""The numbers of the options of all choices."""
SURFACE_ROWS = 512
FIT_ERROR = 2e-3
"""Largest deviation of a response surface from rows that it has not seen."""
MOST_SURFACES = 8
MOST_ERRORS = 64  # rows of a call whose errors of the objective are kept
EXPLORED_SECONDS = 20.0
"""Estimated time of the rows of a surface above which fewer rows define it [s]."""
FEWEST_ROWS = 24


@dataclass
class LevelTally:
    """The rows calculated at some levels, and their time [s]."""

    levels: Levels
    rows: int = 0
    seconds: float = 0.0


@dataclass(frozen=True)
class RequestColumns:
    """Calculates the objective and the requirements of a request.

    Attributes
    ----------
    engine_of
        Returns the engine of the design with some options.
    objective, sense
        The output to minimise or maximise; None for none, then the targets or the margins decide.
    """

    engine_of: Callable[[Chosen], DesignEngine]
    places: Sequence[FreePlace]
    required: Sequence[str]
    targets: Sequence[TargetBand]
    objective: Reference | None
    problem: Problem
    _kept: dict[tuple[object, bytes], Columns] = field(default_factory=dict)
    _errors: dict[bytes, Array] = field(default_factory=dict)

    @property
    def numbers(self) -> list[int]:
        """Return the columns of places that are quantities."""
        return [n for n, place in enumerate(self.places) if not place.options]

    @property
    def choices(self) -> list[int]:
        """Return the columns of places that are choices."""
        return [n for n, place in enumerate(self.places) if place.options]

    def at(self, use: LevelTally) -> Answer:
        """Return the function that calculates rows at some levels, and counts them."""

        def source(chosen: Chosen, inputs: Array) -> Columns:
            key = (tuple(sorted(use.levels.items())), chosen), inputs.tobytes()
            if key not in self._kept:
                self._kept[key] = self._calculated(chosen, inputs, use)
            return self._kept[key]

        return lambda rows: self.reduced(rows, source)

    def explored(self, use: LevelTally) -> Answer:
        """Return the function that a search calls: response surfaces if they are good enough.

        Otherwise it calculates each row at the coarse levels.
        """
        exact, surfaces = self.at(use), dict[Chosen, ResponseSurface | None]()
        if not self.needs_surface:
            return exact

        def source(chosen: Chosen, inputs: Array) -> Columns:
            if chosen not in surfaces:
                surfaces[chosen] = self._surface(chosen, use)
            surface = surfaces[chosen]
            if surface is None:
                return self._calculated(chosen, inputs, use)
            return self._of_surface(surface, inputs)

        return lambda rows: self.reduced(rows, source)

    @property
    def needs_surface(self) -> bool:
        """Return whether a search calls its coarse level often enough to be worth a surface."""
        options = int(np.prod([len(self.places[n].options) for n in self.choices], initial=1.0))
        lists = [
            len(one.values) if isinstance(one, Values) else len(one.grid)
            for one in self.problem.space.variables
        ]
        is_short = all(lists) and int(np.prod(lists)) <= SURFACE_ROWS
        return bool(self.numbers) and options <= MOST_SURFACES and not is_short

    def reduced(self, rows: Array, source: Callable[[Chosen, Array], Columns]) -> Columns:
        """Return the columns of rows, each judged at the worst combination of its ends."""
        inputs = self.inputs(rows)
        corners = inputs.shape[1]
        parts: list[tuple[Integers, Columns]] = []
        for chosen in sorted({tuple(row) for row in rows[:, self.choices].astype(int).tolist()}):
            which = np.flatnonzero((rows[:, self.choices] == np.array(chosen)).all(axis=1))
            if not self.numbers:  # one row serves all: the options alone decide
                parts += [(which[[n]], source(chosen, np.empty((1, 0)))) for n in range(len(which))]
                continue
            flat = np.ascontiguousarray(inputs[which].reshape(-1, inputs.shape[2]))
            parts.append((which, _worst(source(chosen, flat), len(which), corners, self.problem)))
        return self._with_goal(_joined(parts))

    def inputs(self, rows: Array) -> Array:
        """Return the values that the engine receives [SI]: rows, combinations of ends, quantities."""
        ends = [self.places[n].ends(rows[:, n], self.sizes(rows, n)) for n in self.numbers]
        corners = list(product(*(range(each.shape[1]) for each in ends)))
        columns = [
            np.stack([each[:, corner[n]] for n, each in enumerate(ends)], axis=-1)
            if ends
            else np.empty((len(rows), 0))
            for corner in corners
        ]
        return np.stack(columns, axis=1)

    def sizes(self, rows: Array, number: int) -> Array:
        """Return the nominal size [m] of a fit in each row."""
        size = self.places[number].size
        if not isinstance(size, Reference):
            return np.full(len(rows), size)
        for column, place in enumerate(self.places):
            if place.reference == size:
                return rows[:, column]
        return np.full(len(rows), self.engine_of(self.first).nominal_value(size))

    @property
    def first(self) -> Chosen:
        """Return the first option of each choice."""
        return tuple(0 for _ in self.choices)

    def _calculated(self, chosen: Chosen, inputs: Array, use: LevelTally) -> Columns:
        start = process_time()
        engine = self.engine_of(chosen)
        rows = {self.places[n].reference: inputs[:, k] for k, n in enumerate(self.numbers)}
        wanted = [self.objective] if self.objective else []
        table = engine(rows, wanted, levels=use.levels, judge=True, criteria=self.required)
        sides = [judged_of(engine, name, table) for name in self.required]
        values, limits, low, high, certain = (_side_by_side(sides, self.required, side) for side in SIDES)
        goal = table.columns[self.objective] if self.objective else np.zeros(table.count)
        if self.objective in table.errors and table.count <= MOST_ERRORS:
            self._errors[inputs.tobytes()] = table.errors[self.objective]
        seconds = process_time() - start
        use.rows += len(inputs)
        use.seconds += seconds
        reasons = {row: f"{one.place}: {one.detail}" for row, one in table.refusals.items()}
        return Columns(goal[:, None], values, limits, low, high, reasons, seconds, is_known=certain == 1)

    def error_at(self, at: Array, use: LevelTally) -> float | None:
        """Return the largest relative error of the objective at a point; None if one is unknown."""
        if self.objective is None:
            return None
        self.at(use)(at[None])
        errors = self._errors.get(self.inputs(at[None])[0].tobytes())
        return float(np.max(errors)) if errors is not None and np.isfinite(errors).all() else None

    def _surface(self, chosen: Chosen, use: LevelTally) -> ResponseSurface | None:
        """Return the surface through rows at the coarse levels, if it reproduces others well enough."""
        dimensions, engine = len(self.numbers), self.engine_of(chosen)
        wanted = [self.objective] if self.objective else []
        seconds = engine.seconds(SURFACE_ROWS, wanted, use.levels, criteria=self.required)
        count = SURFACE_ROWS if dimensions <= 3 else 2 * SURFACE_ROWS
        while count > FEWEST_ROWS and seconds * count / SURFACE_ROWS > EXPLORED_SECONDS:
            count //= 2
        unit = sobol_sequence(dimensions, 1, 0, count)
        low, high = self._box
        columns = self._calculated(chosen, low + unit * (high - low), use)
        whole = np.hstack([columns.objectives, columns.values, columns.limits])
        if not np.isfinite(whole).all():
            return None
        surface = fitted(unit, whole)
        return surface if surface is not None and surface.error <= FIT_ERROR else None

    @cached_property
    def _box(self) -> tuple[Array, Array]:
        """Return the least and the greatest value [SI] of each quantity, with its ends."""
        ends = [_extremes(self.places[n], self._largest_sizes(n)) for n in self.numbers]
        return np.array([low for low, _ in ends]), np.array([high for _, high in ends])

    def _largest_sizes(self, number: int) -> Array:
        """Return the ends of the range of the nominal size of a fit [m]."""
        rows = np.transpose([bounds_of(one.variable) for one in self.places])
        return self.sizes(rows, number)

    def _of_surface(self, surface: ResponseSurface, inputs: Array) -> Columns:
        low, high = self._box
        width = np.where(high > low, high - low, 1.0)
        whole, count = surface((inputs - low) / width), len(self.required)
        values, limits = whole[:, 1 : 1 + count], whole[:, 1 + count :]
        margin = self.problem.signs * (values - limits)
        return Columns(whole[:, :1], values, limits, margin, margin)

    def _with_goal(self, columns: Columns) -> Columns:
        """Return the columns with the objective of a request that names none."""
        if self.objective is not None:
            return columns
        return replace(columns, objectives=1 + self._apart(columns)[:, None])

    def _apart(self, columns: Columns) -> Array:
        """Return how far a row is from its targets; without targets, how small its least margin is."""
        names = list(self.required)
        if self.targets:
            parts = [
                (columns.values[:, [names.index(one.least), names.index(one.most)]].mean(axis=1) - one.value)
                / one.half
                for one in self.targets
            ]
            return np.asarray(np.sum(np.square(parts), axis=0))
        scale = np.where(columns.limits == 0, 1.0, np.abs(columns.limits))
        margins = self.problem.signs * (columns.values - columns.limits) / scale
        least = np.min(margins, axis=1, initial=1.0)
        return np.asarray(np.square(1 - least))


def _side_by_side(sides: Sequence[Mapping[str, AnyArray]], names: Sequence[str], side: str) -> Array:
    """Return one side of all requirements as the columns of an array, shape (N, m)."""
    each = [np.asarray(one[f"{JUDGED}{name}/{side}"], float) for name, one in zip(names, sides, strict=True)]
    return np.stack(each, axis=-1)


def _extremes(place: FreePlace, sizes: Array) -> tuple[float, float]:
    """Return the least and the greatest value [SI] that the engine receives for a place."""
    if place.fits:
        both = np.array([fit.ends(sizes) for fit in place.fits])
        return float(np.nanmin(both)), float(np.nanmax(both))
    ends = place.ends(np.array(bounds_of(place.variable)), sizes)
    return float(ends.min()), float(ends.max())


def _worst(columns: Columns, count: int, corners: int, problem: Problem) -> Columns:
    """Return one row of each group of `corners` rows: each requirement and the objective at their worst."""
    if corners == 1:
        return columns
    bad = np.where(np.isfinite(columns.low), columns.low, problem.signs * (columns.values - columns.limits))
    bad = np.where(np.isnan(bad), -np.inf, bad).reshape(count, corners, -1)
    at = bad.argmin(axis=1)[:, None]

    def worst(array: Array) -> Array:
        return np.asarray(np.take_along_axis(array.reshape(count, corners, -1), at, axis=1)[:, 0])

    goal = problem.senses * np.max(problem.senses * columns.objectives.reshape(count, corners, -1), axis=1)
    reasons = {row // corners: reason for row, reason in columns.reasons.items()}
    if columns.is_known is not None:
        everywhere = columns.is_known.reshape(count, corners, -1).all(axis=1)
        columns = replace(columns, is_known=np.repeat(everywhere, corners, axis=0))
    return replace(columns.with_sides(worst), objectives=goal, reasons=reasons)


def _joined(parts: Sequence[tuple[Integers, Columns]]) -> Columns:
    """Return the columns of rows that were calculated in parts, each with the numbers of its rows."""
    if len(parts) == 1:
        return parts[0][1]

    order = np.argsort(np.concatenate([which for which, _ in parts]))

    def whole(arrays: Sequence[Array]) -> Array:
        return np.concatenate(arrays)[order]

    every = [columns for _, columns in parts]
    certain = [
        np.ones_like(one.values) if one.is_known is None else one.is_known.astype(np.float64) for one in every
    ]
    return Columns(
        whole([one.objectives for one in every]),
        whole([one.values for one in every]),
        whole([one.limits for one in every]),
        whole([one.low for one in every]),
        whole([one.high for one in every]),
        {int(which[row]): why for which, one in parts for row, why in one.reasons.items()},
        sum(one.seconds for one in every),
        is_known=whole(certain) == 1,
    )
