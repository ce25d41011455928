"""Sensitivities of a value or criterion of a design to each quantity that its user typed.

The slopes are central differences at the design point: 1 + 2 n rows in one array call, at the levels that the
design used. Measurements of solids change by the slopes of the solids (`app.designs.linear_solids`), so no
other solid is built. A quantity that acts through a rounded value gets a reason instead of a slope, because
the result changes in steps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.analyses import is_table
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.design_engine import DesignEngine, Table
from app.designs.engine.needs import needs, varying
from app.designs.engine.relations import MOST_OPERATIONS
from app.designs.engine.row_design import MOST_VALUES, Targets
from app.designs.linear_solids import LinearSolids, parameters_of, slopes_of
from app.designs.network import Cell, Subject
from app.designs.origins import literals_behind, measures_behind
from app.designs.roundings import between, in_words
from app.designs.schemas.designs import Sensitivity
from app.designs.slopes import Local, Slopes, slopes_at
from app.pool.cost import EXPENSIVE
from app.presentation.units import System, shown_unit
from app.reference import Reference
from app.schemas.slopes import slope_in
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs, listed
from templates.core.units.units import registry, unit

MOST_SHOWN = 50
MOST_VARIED = 500  # varied quantities; the call has twice as many rows
STUDY = "a study of the method sensitivity computes them"
STEP = 1e-4  # relative to the value of a quantity, or to its unit if the value is 0


@dataclass(frozen=True)
class SensitivityQuestion:
    """A value, or a criterion, whose sensitivities are requested, by its name.

    Slopes have the units of `system`.
    """

    name: str
    subject: Subject | None = None
    system: System = "si"

    @property
    def values(self) -> list[Reference]:
        """Return the name as a reference if it is a value; otherwise nothing."""
        return [] if self.subject else [Reference.parse(self.name)]

    @property
    def criteria(self) -> list[str]:
        """Return the name if it is a criterion; otherwise nothing."""
        return [self.name] if self.subject else []

    @property
    def wanted(self) -> Targets:
        """Return the values that must be calculated."""
        return Targets.of(self.values, [self.subject] if self.subject else [])

    def unit(self, engine: DesignEngine) -> str:
        """Return the unit in which the value is shown."""
        return self.subject.criterion.unit if self.subject else engine.unit(*self.values)

    def columns(self, table: Table) -> tuple[Array, Array | None]:
        """Return the value [SI] in each row; for a criterion also its margin, positive if it is met."""
        if self.subject is None:
            return table.columns[Reference.parse(self.name)], None
        judged = table.judged[self.name]
        return judged.value, judged.margin


@dataclass(frozen=True)
class Sensitivities:
    """The sensitivities of one value, largest elasticity first, and why some of them are missing."""

    items: Sequence[Sensitivity]
    reason: str | None = None


def sensitivities(
    document: Document, calculation: Calculation, catalogues: Catalogues, asked: SensitivityQuestion
) -> Sensitivities:
    """Return the sensitivities of a value to the typed single quantities on which it depends."""
    wanted = asked.wanted
    behind = literals_behind(calculation, [*wanted.references, *wanted.inside])
    places_behind = [cell.reference for cell in behind]
    steps = between(calculation.graph, places_behind, [*wanted.references, *wanted.inside])
    apart = {*steps, *asked.values}
    places = [place for place in places_behind if place not in apart]
    through = [_of_rounding(str(place), cells) for place, cells in steps.items()]
    try:
        surroundings = DifferenceRows(document, calculation, catalogues, asked, places[:MOST_VARIED])
        items = sorted(surroundings.items(), key=_rank) if places else []
    except InvalidInputs as error:
        return Sensitivities(through[:MOST_SHOWN], error.faults[0].detail)
    all_items = [*items, *through]
    return Sensitivities(all_items[:MOST_SHOWN], _left_out(len(places), len(through), len(all_items)))


def _of_rounding(place: str, cells: Sequence[Cell]) -> Sensitivity:
    reason = f"it acts through {in_words(cells)}, so the value changes in steps and has no slope"
    return Sensitivity(name=place, reason=reason)


def _rank(item: Sensitivity) -> tuple[int, float]:
    """Return a sort key: largest elasticity first, then slopes without an elasticity, then missing slopes."""
    if item.elasticity is not None:
        return 0, -abs(item.elasticity)
    return (2 if item.slope is None else 1), 0.0


def _left_out(places: int, through: int, shown: int) -> str | None:
    """Return a sentence saying that the list of quantities is incomplete; None if it is complete."""
    if places > MOST_VARIED:
        return (
            f"only the first {MOST_VARIED} of {places + through} places were varied; {MOST_SHOWN} are listed"
        )
    return f"the first {MOST_SHOWN} of {shown} places are listed" if shown > MOST_SHOWN else None


@dataclass(frozen=True)
class DifferenceRows:
    """The rows around one design point, and the slopes that they give."""

    document: Document
    calculation: Calculation
    catalogues: Catalogues
    asked: SensitivityQuestion
    places: Sequence[Reference]

    def items(self) -> Iterator[Sensitivity]:
        """Yield the sensitivity to each quantity, in the given order.

        Raises
        ------
        InvalidInputs
            If the design cannot be calculated for rows, if that would take too long, or if the value is
            missing or not a single number.
        """
        table = self._table()
        value, margin = self.asked.columns(table)
        self._check(value, table)
        slopes = slopes_at(self._points, value)
        margins = None if margin is None else slopes_at(self._points, margin).slopes
        for number in range(len(self.places)):
            item = self._item(number, slopes)
            if reason := _one_sided(*self._points.beside(number), value, table):
                item = item.model_copy(update={"reason": reason})
            if margins is not None and abs(margins[number]) > 0:
                helps = "increase" if margins[number] > 0 else "decrease"
                item = item.model_copy(update={"helps": helps})
            yield item

    def _table(self) -> Table:
        self._check_measures()
        count, levels = self._points.count, self._levels
        values, criteria = self.asked.values, self.asked.criteria
        self._check_cost()
        rows = self._points.rows(0, count)
        columns = {place: rows[:, column] for column, place in enumerate(self.places)}
        if not self._moving:
            return self._engine(columns, values, levels=levels, judge=bool(criteria), criteria=criteria)
        point = {place: column[:1] for place, column in columns.items()}
        solids = LinearSolids(self._engine, self._moving, point, levels, self._measures, slopes_of)
        columns |= solids.columns(columns, count)
        table = self._engine(columns, values, levels=levels, judge=bool(criteria), criteria=criteria)
        table.refusals |= solids.refusals
        return table

    def _check_cost(self) -> None:
        """Raise InvalidInputs if the rows would take too long, or need too many operations on lists."""
        count, wanted = self._points.count, self.asked.wanted
        seconds = self._engine.seconds(count, self.asked.values, self._levels, criteria=self.asked.criteria)
        values = count * sum(self._engine.design.sizes(wanted).values())
        if seconds > EXPENSIVE:
            raise self._refused(
                "expensive", f"{count} rows would take too long to wait for{self._at()}; {STUDY}"
            )
        if values > MOST_VALUES or count * self.calculation.operations > MOST_OPERATIONS:
            raise self._refused(
                "too_many_values", f"{count} rows with lists of this length would take too long; {STUDY}"
            )

    def _at(self) -> str:
        """Return the levels of the calculated steps in words, in brackets, for a message."""
        steps = [step.name for step in self._engine.design.steps(self.asked.wanted)]
        used = [f"{name} at {self._levels[name]}" for name in steps if name in self._levels]
        return f" ({', '.join(used)})" if used else ""

    def _check(self, value: Array, table: Table) -> None:
        """Raise InvalidInputs if a slope of the value is not defined."""
        if value.ndim > 1:
            raise self._refused("shape", f"{self.asked.name} is a list; sensitivities need a single number")
        if not math.isfinite(value[0]):
            raise self._refused("no_value", self._missing(table))

    def _check_measures(self) -> None:
        """Raise InvalidInputs if the value depends on a missing solid, or on a table of an analysis."""
        wanted = self.asked.wanted
        waiting = needs(self.calculation.graph, wanted.references, (), wanted.inside).waiting
        if tables := sorted(str(reference) for reference in waiting if is_table(reference)):
            what = f"{listed(tables)}, a table or a list"
            detail = f"{self.asked.name} depends on {what}, so its slopes are not computed"
            raise self._refused("no_value", detail)
        if missing := sorted(str(measure) for measure, value in self._measures.items() if math.isnan(value)):
            raise self._refused("no_value", f"{self.asked.name} waits for {listed(missing)}")

    def _missing(self, table: Table) -> str:
        """Return the reason why the value is missing at the design point."""
        refusal = table.refusals.get(0)
        return refusal.detail if refusal else f"{self.asked.name} has no value"

    def _refused(self, code: str, detail: str) -> InvalidInputs:
        return InvalidInputs([Fault(self.asked.name, code, detail)])

    @cached_property
    def _measures(self) -> dict[Reference, float]:
        """Return the known measurements [SI] on which the value depends."""
        return measures_behind(self.calculation, self.asked.wanted)

    @cached_property
    def _moving(self) -> list[Reference]:
        """Return the measurements that differ between the rows."""
        graph = self.calculation.graph
        moving = varying(graph, self.places)
        return [measure for measure in self._measures if graph.blocks[measure.block].solid in moving]

    @cached_property
    def _engine(self) -> DesignEngine:
        blocks = self.calculation.graph.blocks
        models = [blocks[name] for name in dict.fromkeys(measure.block for measure in self._moving)]
        parameters = [reference for model in models for reference in parameters_of(model).values()]
        return DesignEngine.of(
            self.document,
            self.catalogues,
            [*self.places, *self._moving],
            wanted=[*self.asked.values, *parameters],
            criteria=self.asked.criteria,
            measured={
                measure: value for measure, value in self._measures.items() if measure not in self._moving
            },
        )

    @cached_property
    def _levels(self) -> dict[str, str | None]:
        """Return the levels that the design used."""
        blocks = self.calculation.graph.blocks
        used = {name: evaluation.level for name, evaluation in self.calculation.evaluations.items()}
        return {name: level for name, level in used.items() if level in blocks[name].cls.levels}

    @cached_property
    def _points(self) -> Local:
        at = np.array([self.calculation.value(place) for place in self.places], dtype=float)
        units = np.array([unit(self._engine.unit(place)).factor for place in self.places])
        return Local(at, STEP * np.where(at == 0, units, np.abs(at)))

    def _item(self, number: int, slopes: Slopes) -> Sensitivity:
        name, place = str(self.places[number]), float(self._points.at[number])
        over, under = self.asked.unit(self._engine), self._engine.unit(self.places[number])
        system, slope_si = self.asked.system, float(slopes.slopes[number])
        slope = slope_in(shown_unit(over, system), shown_unit(under, system), slope_si)
        if slope is None:
            return Sensitivity(name=name, reason="its slope is not finite")
        elasticity = float(slopes.elasticities[number])
        has_ratio = place != 0 and math.isfinite(elasticity) and not _is_temperature(over, under)
        return Sensitivity(name=name, slope=slope, elasticity=elasticity if has_ratio else None)


def _one_sided(below: int, above: int, value: Array, table: Table) -> str | None:
    """Return the reason why a slope is missing or one-sided; None if it is central."""
    sides = {"below": below, "above": above}
    missing = {side: row for side, row in sides.items() if not math.isfinite(value[row])}
    refusals = {side: table.refusals.get(row) for side, row in missing.items()}
    why = {side: refusal.detail if refusal else "there is no value" for side, refusal in refusals.items()}
    if len(why) == 2 and why["below"] == why["above"]:
        return f"on both sides: {why['below']}"
    return "; ".join(f"{side}: {detail}" for side, detail in why.items()) or None


def _is_temperature(*units: str) -> bool:
    """Return whether any unit is a temperature, whose ratios have no meaning.

    Ratios of temperature differences have a meaning.
    """
    return any(unit(name).base == registry.kelvin and not unit(name).difference for name in units)
