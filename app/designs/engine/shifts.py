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
"""Uncertain outputs of a design that are shifted; each takes two calculations of what follows from it."""
LONGEST_SHIFTING = 1.0
"""What all these calculations may take together, by their estimates for one row [s]."""
PER_OPERATION = 2e-8  # of a relation on a single value of an array [s]

Shifted = tuple[dict[str, Column], dict[str, Column]]
"""The values of names with something upstream at the lower, and at the upper end of its band."""


@dataclass(frozen=True)
class Origins:
    """The outputs of steps from which a value follows.

    Attributes
    ----------
    carried
        Those whose errors are carried on.
    stopped
        Those behind something through which no error is carried.
    """

    carried: frozenset[Reference] = frozenset()
    stopped: frozenset[Reference] = frozenset()

    def __or__(self, other: Origins) -> Origins:
        return Origins(self.carried | other.carried, self.stopped | other.stopped)

    def without(self) -> Origins:
        """Return the same errors after a barrier through which no error is propagated."""
        return Origins(stopped=self.carried | self.stopped)


@dataclass(frozen=True)
class Upstream:
    """Outputs of steps from which a value follows, by what is known of their errors.

    Attributes
    ----------
    uncertain
        Of a stated error in some row, which can be carried on.
    unknown
        Of an error that is not known in some row.
    stopped
        Of an error that is not carried on.
    """

    uncertain: frozenset[Reference] = frozenset()
    unknown: frozenset[Reference] = frozenset()
    stopped: frozenset[Reference] = frozenset()


NONE, NOTHING = Origins(), Upstream()


@dataclass
class Shifts:
    """The errors of a calculated design; `estimate` returns the value of a name with its step's error."""

    calculation: Calculation
    estimate: Callable[[Reference], RowEstimate | Absent]
    _beneath: dict[Reference, Origins] = field(default_factory=dict)
    _ends: dict[Reference, tuple[Calculation, Calculation]] = field(default_factory=dict)
    _seconds: float = 0.0  # that the calculations so far were estimated to take of one row

    def upstream(self, references: Iterable[Reference]) -> Upstream:
        """Return the origins of some values, without the errors of their own steps."""
        return self.by_error(_joined(map(self._beneath_of, references)))

    def behind(self, reference: Reference) -> Upstream:
        """Return the origins of a value for its users: the error of its own step, and those upstream."""
        return self.by_error(self._beneath_of(reference) | self._own(reference))

    def unknown(self, upstream: Upstream) -> Mask:
        """Return the rows in which the error of any output is unknown, or not propagated."""
        count = self.calculation.count
        unknown = np.full(count, bool(upstream.stopped))
        for origin in upstream.unknown:
            estimate = self.estimate(origin)
            unknown |= estimate.unknown(count) if isinstance(estimate, RowEstimate) else False
        return unknown

    def shifts(
        self, references: Mapping[str, Reference], upstream: Upstream
    ) -> tuple[list[Shifted], Upstream]:
        """Return values of names with each uncertain origin at either end; omitted origins are blocked."""
        carried = [origin for origin in sorted(upstream.uncertain, key=str) if self._is_carried(origin)]
        shifts = [self._shift(origin, references) for origin in carried]
        left_out = upstream.uncertain.difference(carried)
        return shifts, replace(upstream, stopped=upstream.stopped | left_out)

    def _shift(self, origin: Reference, references: Mapping[str, Reference]) -> Shifted:
        """Return values of names at both ends; the origin keeps its value: its band counts elsewhere."""
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
        """Return origins grouped by the knowledge of their errors; exact ones are left out."""
        if origins == NONE:
            return NOTHING
        kinds = {origin: self._kinds(origin) for origin in origins.carried | origins.stopped}
        uncertain, unknown = (
            frozenset(origin for origin in origins.carried if kind in kinds[origin])
            for kind in ("uncertain", "unknown")
        )
        return Upstream(uncertain, unknown, frozenset(one for one in origins.stopped if kinds[one]))

    def _kinds(self, origin: Reference) -> frozenset[str]:
        """Return the indices of an output in an `Upstream`; with rows there may be several."""
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
            for node in self.calculation.graph.order:  # in order, so that no chain is too long to follow
                if isinstance(node, Cell):
                    self._origins(node.reference)
        return self._origins(reference)

    @cached_property
    def _is_carried_on(self) -> bool:
        """Return whether any relation uses a calculated or measured value; typed values are exact."""
        graph = self.calculation.graph
        return any(graph.cell(used) is None for cell in graph.cells() for used in cell.uses.values())

    def _origins(self, reference: Reference) -> Origins:
        if reference not in self._beneath:
            self._beneath[reference] = NONE  # an iteration comes back to where it began
            self._beneath[reference] = self._followed(reference)
        return self._beneath[reference]

    def _followed(self, reference: Reference) -> Origins:
        graph = self.calculation.graph
        if reference in self.calculation.given:
            return NONE
        if cell := graph.cell(reference):
            return _joined(self._behind(used) for used in cell.uses.values()) if cell.uses else NONE
        block = graph.blocks.get(reference.block)
        if block is None:
            return NONE
        if is_member(graph, reference):
            return self._of_block(block, reference.member)
        return _joined(self._origins(cell.reference) for cell in block.cells.values()).without()

    def _behind(self, reference: Reference) -> Origins:
        return self._origins(reference) | self._own(reference)

    def _own(self, reference: Reference) -> Origins:
        """Return an output of a step that is calculated, and so may be off."""
        return Origins(frozenset({reference})) if self.calculation.is_output(reference) else NONE

    def _of_block(self, block: Block, member: str) -> Origins:
        """Return the origins of an input or output of a block: the cells on which it depends."""
        declared = block.cls.inputs.get(member) or block.cls.formulas[member]
        try:
            beneath = self.calculation.instance(block.name).depends_on(declared.attribute)
        except KeyError:
            return NONE  # it waits, or is refused
        related = [cell for cell in block.cells.values() if cell.relations and cell.declared]
        used = [cell for cell in related if cell.declared and cell.declared.attribute in beneath]
        origins = _joined(self._origins(cell.reference) for cell in used) if used else NONE
        return origins.without() if origins != NONE and self._is_expensive(block) else origins

    def _is_expensive(self, block: Block) -> bool:
        """Return whether a step takes too long to be recalculated repeatedly, by its estimate."""
        return not block.is_model and self._estimated_seconds(block) > EXPENSIVE

    def _estimated_seconds(self, block: Block) -> float:
        """Estimate the time of a step for a single row [s], as a separate design."""
        raw = {name: self._first(cell) for name, cell in block.cells.items()}
        level, evaluation = self._levels[block.name], self.calculation.evaluations.get(block.name)
        outputs = list(evaluation.outputs) if evaluation else self.calculation.graph.computed(block)
        return estimated_seconds(block.cls, raw, level, None, outputs)

    @cached_property
    def _levels(self) -> Mapping[str, str | None]:
        return self.calculation.levels_used()

    def _first(self, cell: Cell) -> Raw:
        """Return the value of a cell in the first row."""
        column = self.calculation.values.get(cell.name)
        if column is None or cell.declared is None or not column.is_row:
            return self.calculation.typed.get(cell.name, cell.raw)
        si = column.of(slice(0, 1)).value[0]  # type: ignore[index] # it has rows
        return TypedQuantity(None, cell.declared.meaning.unit, si if np.ndim(si) else float(si), {})

    def _is_carried(self, origin: Reference) -> bool:
        """Return whether the values that depend on an output are recalculated at both ends; do so once."""
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
        """Estimate the time of all steps that depend on an output for a single row [s]."""
        nodes = following(self.calculation, {origin})
        steps = (node for node in nodes if isinstance(node, Block) and node.name in self._levels)
        relations = self.calculation.operations * PER_OPERATION
        return relations + sum(map(self._estimated_seconds, steps))


def _joined(parts: Iterable[Origins]) -> Origins:
    return reduce(or_, parts, NONE)
