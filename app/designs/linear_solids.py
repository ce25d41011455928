"""Measurements of solids beside a design point, from the slopes of the solids: no other solid is built.

The slopes hold at the design point (`cad.slopes`), so measurements are linear in the parameters of the model.
In a row whose parameters change where a measurement has no slope, it has no value.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from threading import Lock

import numpy as np
from cachetools import LRUCache

from app.designs.analyses import measured_unit
from app.designs.engine.design_engine import DesignEngine, Refusal
from app.designs.engine.row_design import Levels, Rows
from app.designs.engine.row_shapes import numbers_of, shape_of
from app.designs.network import Block
from app.pool.sources import Source, loaded, source_of
from app.pool.steps import in_the_pool
from app.reference import Reference
from cad.errors import GeometryError
from cad.imported_models import ImportedModel
from cad.inspect import MEASURES
from cad.model import CadModel
from cad.regenerate import as_text, build_key
from cad.slopes.results import ParameterSlopes, SolidSlopes
from templates.core.arrays import Array, Mask
from templates.core.language.spec import Choice
from templates.core.units.units import Unit, unit

MOST_ROUNDS = 100  # of a design that iterates through a measurement
SETTLED = 1e-13  # relative change of a measurement in its last round
UNCHANGED = 1e-13  # relative change of a parameter that counts as none

ANALYSED = "it is a finite-element result or a distance between parts"
STUDY = "a study of the method sensitivity computes it by differences of solids"

Sloped = Callable[[CadModel, frozenset[str]], SolidSlopes]
"""Returns the slopes of a solid over some parameters of its model."""


@dataclass(frozen=True)
class LinearSolids:
    """The solids of a design at one point, and their measurements in rows beside it.

    Attributes
    ----------
    engine
        The design; its rows provide the measurements, and may request all parameters of the models.
    measures
        The measurements that rows need.
    point
        The row of the design point: a column of one value for each varied place.
    measured
        Measurements at the point [SI]; others are taken from the slopes of the solids.
    refusals
        For each row without a measurement, the reason, from the last call.
    """

    engine: DesignEngine
    measures: Sequence[Reference]
    point: Rows
    levels: Levels
    measured: Mapping[Reference, float]
    sloped: Sloped
    refusals: dict[int, Refusal] = field(default_factory=dict)

    def columns(self, rows: Rows, count: int) -> dict[Reference, Array]:
        """Return the measurements in each row [SI]; NaN where there is none."""
        solids = list(self._solids())
        nominal = {measure: value for solid in solids for measure, value in solid.nominal.items()}
        columns = {measure: np.full(count, value) for measure, value in nominal.items()}
        for _ in range(MOST_ROUNDS):
            self.refusals.clear()
            before = dict(columns)
            for solid in solids:
                columns |= self._changed(solid, {**rows, **columns}, count)
            if all(_agree(columns[measure], before[measure]) for measure in columns):
                break
        return columns

    def _solids(self) -> Iterator[SolidAtPoint]:
        """Yield the measured solids at the design point, each after those on which it depends."""
        names, values = {measure.block for measure in self.measures}, dict(self.point)
        values |= {measure: np.array([self.measured.get(measure, np.nan)]) for measure in self.measures}
        for node in self.engine.graph.order:
            if isinstance(node, Block) and node.name in names:
                yield (solid := self._solid(node, values))
                values |= {measure: np.array([value]) for measure, value in solid.nominal.items()}

    def _solid(self, model: Block, values: Rows) -> SolidAtPoint:
        """Return the solid of a model at the design point."""
        every = parameters_of(model)
        table = self.engine(values, list(every.values()), levels=self.levels)
        parameters = {name: table.columns[reference] for name, reference in every.items()}
        given = {name: _plain(parameters[name][0]) for name in numbers_of(model)}
        shape = shape_of(model, given)
        nominal = {measure: self.measured.get(measure, np.nan) for measure in self._of(model)}
        if isinstance(shape, CadModel) and any(map(np.isnan, nominal.values())):
            read = self.sloped(shape, frozenset()).measures
            nominal |= {
                measure: float(_scale(measure).to_si(read[measure.member]))
                for measure, value in nominal.items()
                if np.isnan(value) and measure.analysis is None and measure.member in read
            }
        return SolidAtPoint(model, shape, parameters, nominal)

    def _of(self, model: Block) -> list[Reference]:
        return [measure for measure in self.measures if measure.block == model.name]

    def _changed(self, solid: SolidAtPoint, rows: Rows, count: int) -> dict[Reference, Array]:
        """Return the measurements of one solid in each row."""
        every = parameters_of(solid.model)
        table = self.engine(rows, list(every.values()), levels=self.levels)
        self._refuse(table.refusals)
        changes = {
            name: change
            for name, reference in every.items()
            if (change := _change(table.columns[reference], solid.parameters[name])).any()
        }
        if not changes:
            return {measure: np.full(count, value) for measure, value in solid.nominal.items()}
        if isinstance(solid.shape, Refusal):
            self._refuse(dict.fromkeys(range(count), solid.shape))
            return {measure: np.full(count, np.nan) for measure in solid.nominal}
        slopes = self.sloped(solid.shape, frozenset(changes)).parameters
        return {
            measure: np.sum(
                [self._part(measure, slopes[name], name, change) for name, change in changes.items()],
                axis=0,
                initial=value,
            )
            for measure, value in solid.nominal.items()
        }

    def _refuse(self, rows: Mapping[int, Refusal]) -> None:
        """Store the reason for each row that has none yet."""
        for row, refusal in rows.items():
            self.refusals.setdefault(row, refusal)

    def _part(self, measure: Reference, over: ParameterSlopes, name: str, change: Array) -> Array:
        """Return the change of a measurement with one parameter in each row; NaN where it has no slope."""
        slope, reason = over.slopes.get(measure.member), over.reason(measure.member)
        if measure.analysis is not None or measure.member not in MEASURES:
            slope, reason = None, f"{ANALYSED}; {STUDY}"
        if slope is None:
            missing: Mask = change != 0
        elif over.side == "both":
            missing = np.isnan(change)
        else:
            missing = change < 0 if over.side == "above" else change > 0
            reason = over.one_sided
        detail = f"{measure} has no slope over {measure.block}.{name}: {reason}"
        refusal = Refusal(str(measure), "no_slope", detail)
        self._refuse(dict.fromkeys(np.flatnonzero(missing).tolist(), refusal))
        factor = _scale(measure).factor * (slope or 0.0)
        return np.where(missing, np.nan, factor * change)


@dataclass(frozen=True)
class SolidAtPoint:
    """A solid at the design point: its model, its parameters [SI] as columns of one row, its measurements."""

    model: Block
    shape: CadModel | Refusal
    parameters: Mapping[str, Array]
    nominal: Mapping[Reference, float]


def parameters_of(model: Block) -> dict[str, Reference]:
    """Return the parameters of a model, without choices, by name."""
    names = (name for name, declared in model.cls.inputs.items() if not isinstance(declared, Choice))
    return {name: Reference(model.name, None, name) for name in names}


def _change(column: Array, at_point: Array) -> Array:
    """Return the change of a parameter in each row; of a list the greatest change of an item."""
    value = at_point[0]
    with np.errstate(invalid="ignore"):
        change = np.where(np.isnan(column) & np.isnan(value), 0.0, column - value)
        change = np.where(np.abs(change) <= UNCHANGED * np.abs(value), 0.0, change)
    return change if change.ndim == 1 else np.abs(change).max(axis=1, initial=0.0)


def _plain(value: Array) -> float | list[float]:
    return value.tolist()  # type: ignore[no-any-return]


def _agree(new: Array, old: Array) -> bool:
    return bool(np.allclose(new, old, rtol=SETTLED, atol=0.0, equal_nan=True))


def _scale(measure: Reference) -> Unit:
    return unit(measured_unit(measure))


def slopes_of(shape: CadModel, parameters: frozenset[str]) -> SolidSlopes:
    """Return the slopes of a solid over some parameters, computed in the calculation pool.

    Raises
    ------
    StepDeferred
        If the caller does not wait for them.
    """
    key = build_key(shape), parameters
    with _caching:
        slopes = _cache.get(key)
    if slopes is None:
        names = tuple(sorted(parameters))
        slopes = in_the_pool(("slopes", *key), computed, source_of(type(shape)), as_text(shape), names)
        with _caching:
            _cache[key] = slopes
    return slopes


def computed(source: Source, texts: Mapping[str, str], parameters: Collection[str]) -> SolidSlopes:
    """Return the slopes of a solid; this draws, and runs in a calculation process."""
    from cad.slopes.solid_slopes import solid_slopes  # the server needs no kernel

    cls = loaded(source)
    assert issubclass(cls, CadModel), "the source is that of a model"
    if issubclass(cls, ImportedModel):
        return _without(parameters, "an imported solid is drawn anew for each value")
    try:
        return solid_slopes(cls.from_quantities(texts), parameters)
    except GeometryError as error:
        return _without(parameters, error.detail)


def _without(parameters: Collection[str], reason: str) -> SolidSlopes:
    return SolidSlopes({}, dict.fromkeys(parameters, ParameterSlopes(whole=reason)))


MOST_CACHED = 500
_cache: LRUCache[tuple[str, frozenset[str]], SolidSlopes] = LRUCache(MOST_CACHED)
_caching = Lock()
