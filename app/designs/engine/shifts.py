"""Propagate errors of steps to later values: shift each uncertain output to both ends of its band.

The error of a step does not include the errors of its inputs. So the engine recalculates everything that
depends on an uncertain output, with that output at the lower and at the upper end of its band, in all rows at
once. It names what it cannot recalculate quickly (solids, expensive steps), and states no error for the
values that depend on it. All rows share the same dependencies; the errors differ from row to row.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from operator import or_

import numpy as np

from app.designs.engine.calculate import following, recalculated
from app.designs.engine.calculation import Calculation
from app.designs.engine.columns import Column, RowEstimate
from app.designs.engine.needs import is_member
from app.designs.network import Block, Cell
from app.plain import Raw
from app.pool.cost import EXPENSIVE, estimated_seconds
from app.reference import Reference
from templates.core.arrays import Mask
from templates.core.criteria.evaluation import Absent
from templates.core.units.quantity import TypedQuantity

MOST_SHIFTED = 12
"""Largest number of outputs that are shifted; each needs two calculations of all values that depend on it."""
LONGEST_SHIFTING = 1.0
"""Largest total time of these calculations, by their estimates for one row [s]."""
PER_OPERATION = 2e-8  # time of one operation of a relation on a single value of an array [s]

Shifted = tuple[dict[str, Column], dict[str, Column]]
"""The values of names with an upstream output at the lower and at the upper end of its band."""


@dataclass(frozen=True)
class Origins:
    """The step outputs on which a value depends.

    Attributes
    ----------
    carried
        Outputs whose errors are propagated to the value.
    stopped
        Outputs whose errors are not propagated, because an expensive step or a solid lies in between.
    """

    carried: frozenset[Reference] = frozenset()
    stopped: frozenset[Reference] = frozenset()

    def __or__(self, other: Origins) -> Origins:
        return Origins(self.carried | other.carried, self.stopped | other.stopped)

    def without(self) -> Origins:
        """Return the same origins with some outputs marked as stopped: their errors are not propagated."""
        return Origins(stopped=self.carried | self.stopped)


@dataclass(frozen=True)
class Upstream:
    """The step outputs on which a value depends, sorted by what is known of their errors.

    Attributes
    ----------
    uncertain
        Outputs with a stated error in some row, which can be propagated.
    unknown
        Outputs whose error is unknown in some row.
    stopped
        Outputs whose error is not propagated.
    """

    uncertain: frozenset[Reference] = frozenset()
    unknown: frozenset[Reference] = frozenset()
    stopped: frozenset[Reference] = frozenset()


NONE, NOTHING = Origins(), Upstream()


@dataclass
class Shifts:
    """Propagates the errors of a calculated design; `estimate` returns a value with its step's own error."""

    calculation: Calculation
    estimate: Callable[[Reference], RowEstimate | Absent]
    _beneath: dict[Reference, Origins] = field(default_factory=dict)
    _ends: dict[Reference, tuple[Calculation, Calculation]] = field(default_factory=dict)
    _seconds: float = 0.0  # estimated total time for one row of the recalculations so far

    def upstream(self, references: Iterable[Reference]) -> Upstream:
        """Return the outputs on which some values depend, grouped as `by_error` does."""
        return self.by_error(_joined(map(self._beneath_of, references)))

    def behind(self, reference: Reference) -> Upstream:
        """Return the outputs that make a value uncertain: the value itself, and outputs upstream of it."""
        return self.by_error(self._beneath_of(reference) | self._own(reference))

    def unknown(self, upstream: Upstream) -> Mask:
        """Return the rows in which the error of any output is unknown or is not propagated."""
        count = self.calculation.count
        unknown = np.full(count, bool(upstream.stopped))
        for origin in upstream.unknown:
            estimate = self.estimate(origin)
            unknown |= estimate.unknown(count) if isinstance(estimate, RowEstimate) else False
        return unknown

    def shifts(
        self, references: Mapping[str, Reference], upstream: Upstream
    ) -> tuple[list[Shifted], Upstream]:
        """Return the values of names with each uncertain output at the lower and upper end of its band.

        Uncertain outputs that are too expensive to propagate are returned as stopped.
        """
        carried = [origin for origin in sorted(upstream.uncertain, key=str) if self._is_carried(origin)]
        shifts = [self._shift(origin, references) for origin in carried]
        left_out = upstream.uncertain.difference(carried)
        return shifts, replace(upstream, stopped=upstream.stopped | left_out)

    def _shift(self, origin: Reference, references: Mapping[str, Reference]) -> Shifted:
        """Return the values of names at both ends of an output's band.

        The output itself keeps its value, because its own band is counted separately.
        """
        low, high = self._ends[origin]
        return self._at(low, origin, references), self._at(high, origin, references)

    def _at(
        self, end: Calculation, origin: Reference, references: Mapping[str, Reference]
    ) -> dict[str, Column]:
        return {
            name: (self.calculation if reference == origin else end).column(reference)
            for name, reference in references.items()
        }

    def by_error(self, origins: Origins) -> Upstream:
        """Return the outputs grouped by what is known about their errors; exact outputs are omitted."""
        if origins == NONE:
            return NOTHING
        kinds = {origin: self._kinds(origin) for origin in origins.carried | origins.stopped}
        uncertain, unknown = (
            frozenset(origin for origin in origins.carried if kind in kinds[origin])
            for kind in ("uncertain", "unknown")
        )
        return Upstream(uncertain, unknown, frozenset(one for one in origins.stopped if kinds[one]))

    def _kinds(self, origin: Reference) -> frozenset[str]:
        """Return the groups of `Upstream` to which an output belongs; with many rows there may be several."""
        estimate = self.estimate(origin)
        if isinstance(estimate, Absent):
            return frozenset()
        error, count = estimate.error, self.calculation.count
        unknown = estimate.unknown(count)
        kinds = {"unknown"} if unknown.any() else set[str]()
        off = np.any(error.spread(count).reshape(count, -1) > 0, axis=1)
        return frozenset(kinds | ({"uncertain"} if (off & ~unknown).any() else set()))

    def _beneath_of(self, reference: Reference) -> Origins:
        if not self._is_carried_on:
            return NONE
        if not self._beneath:
            for (
                node
            ) in self.calculation.graph.order:  # in dependency order, so that the recursion stays shallow
                if isinstance(node, Cell):
                    self._origins(node.reference)
        return self._origins(reference)

    @cached_property
    def _is_carried_on(self) -> bool:
        """Return whether any relation uses a calculated or measured value; typed values have no error."""
        graph = self.calculation.graph
        return any(graph.cell(used) is None for cell in graph.cells() for used in cell.uses.values())

    def _origins(self, reference: Reference) -> Origins:
        if reference not in self._beneath:
            self._beneath[reference] = NONE  # ends the recursion around an iteration
            self._beneath[reference] = self._followed(reference)
        return self._beneath[reference]

    def _followed(self, reference: Reference) -> Origins:
        graph = self.calculation.graph
        if reference in self.calculation.given:
            return NONE
        if cell := graph.cell(reference):
            if cell.roundings or not cell.uses:  # a rounded size is exact: it is chosen, whatever its sources
                return NONE
            return _joined(self._behind(used) for used in cell.uses.values())
        block = graph.blocks.get(reference.block)
        if block is None:
            return NONE
        if is_member(graph, reference):
            return self._of_block(block, reference.member)
        return _joined(self._origins(cell.reference) for cell in block.cells.values()).without()

    def _behind(self, reference: Reference) -> Origins:
        return self._origins(reference) | self._own(reference)

    def _own(self, reference: Reference) -> Origins:
        """Return a name as an origin of error if it is a calculated output of a step; otherwise nothing."""
        return Origins(frozenset({reference})) if self.calculation.is_output(reference) else NONE

    def _of_block(self, block: Block, member: str) -> Origins:
        """Return the origins of error of a block's input or output, traced through the block's cells."""
        declared = block.cls.inputs.get(member) or block.cls.formulas[member]
        try:
            beneath = self.calculation.instance(block.name).depends_on(declared.attribute)
        except KeyError:
            return NONE  # the block is pending or refused
        related = [cell for cell in block.cells.values() if cell.relations and cell.declared]
        used = [cell for cell in related if cell.declared and cell.declared.attribute in beneath]
        origins = _joined(self._origins(cell.reference) for cell in used) if used else NONE
        return origins.without() if origins != NONE and self._is_expensive(block) else origins

    def _is_expensive(self, block: Block) -> bool:
        """Return whether a step takes too long to be recalculated repeatedly."""
        return not block.is_model and self._estimated_seconds(block) > EXPENSIVE

    def _estimated_seconds(self, block: Block) -> float:
        """Estimate the time of a step for one row [s], as for a separate design."""
        raw = {name: self._first(cell) for name, cell in block.cells.items()}
        level, evaluation = self._levels[block.name], self.calculation.evaluations.get(block.name)
        outputs = list(evaluation.outputs) if evaluation else self.calculation.graph.computed(block)
        return estimated_seconds(block.cls, raw, level, None, outputs)

    @cached_property
    def _levels(self) -> Mapping[str, str | None]:
        return self.calculation.levels_used()

    def _first(self, cell: Cell) -> Raw:
        """Return the value of a cell in the first row, for use in an estimate of time."""
        column = self.calculation.values.get(cell.name)
        if column is None or cell.declared is None or not column.is_row:
            return self.calculation.typed.get(cell.name, cell.raw)
        si = column.of(slice(0, 1)).value[0]  # type: ignore[index] # it has rows
        return TypedQuantity(None, cell.declared.meaning.unit, si if np.ndim(si) else float(si), {})

    def _is_carried(self, origin: Reference) -> bool:
        """Return whether the error of an output is propagated; the first call recalculates both ends."""
        if origin in self._ends:
            return True
        seconds = 2 * self._following_seconds(origin)
        if len(self._ends) >= MOST_SHIFTED or self._seconds + seconds > LONGEST_SHIFTING:
            return False
        self._seconds += seconds
        estimate = self.estimate(origin)
        assert isinstance(estimate, RowEstimate)
        low, high = (recalculated(self.calculation, {origin: end}, self._levels) for end in estimate.bounds())
        self._ends[origin] = low, high
        return True

    def _following_seconds(self, origin: Reference) -> float:
        """Estimate the time of all steps and relations that depend on an output, for one row [s]."""
        nodes = following(self.calculation, {origin})
        steps = (node for node in nodes if isinstance(node, Block) and node.name in self._levels)
        relations = self.calculation.operations * PER_OPERATION
        return relations + sum(map(self._estimated_seconds, steps))


def _joined(parts: Iterable[Origins]) -> Origins:
    return reduce(or_, parts, NONE)
