"""How errors of steps reach what follows from them: each uncertain output is shifted to both ends.

The error of a step leaves out that of its inputs. So whatever follows from an uncertain output is calculated
again with that output at the lower and at the upper end of its band. What cannot be calculated again at once
(solids, expensive steps) is named, and the error of what follows is then not stated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, reduce
from operator import or_

import numpy as np

from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.designs.calculate import recalculated
from app.designs.calculation import Calculation
from app.designs.network import Block, Cell
from app.reference import Reference
from templates.core.errors import TemplateError
from templates.core.judging.bands import Estimate, Shift
from templates.core.judging.judging import Absent
from templates.core.units.units import Value

MOST_SHIFTED = 12
"""Uncertain outputs of a design that are shifted; each takes two calculations of what follows from it."""
LONGEST_SHIFTING = 1.0
"""What all these calculations may take together, by their estimates [s]."""
PER_OPERATION = 2e-8  # of a relation on a single value of an array [s]


@dataclass(frozen=True)
class Upstream:
    """Outputs of steps from which a value follows, by what is known of their errors.

    Attributes
    ----------
    uncertain
        Of a stated error, which can be carried on.
    unknown
        Of an error that was measured, but not here.
    unstated
        Of an error that nobody measured, or that is not carried on.
    """

    uncertain: frozenset[Reference] = frozenset()
    unknown: frozenset[Reference] = frozenset()
    unstated: frozenset[Reference] = frozenset()

    def __or__(self, other: Upstream) -> Upstream:
        return Upstream(
            self.uncertain | other.uncertain, self.unknown | other.unknown, self.unstated | other.unstated
        )

    def stopped(self) -> Upstream:
        """The same, behind something through which no error is carried."""
        return Upstream(unstated=self.uncertain | self.unknown | self.unstated)


NOTHING = Upstream()

EstimateOf = Callable[[Reference], Estimate | Absent]


@dataclass
class Shifting:
    """The errors of one calculated design.

    Attributes
    ----------
    calculation
        The design as calculated.
    estimate
        Returns the value of a name with the error of its own step.
    """

    calculation: Calculation
    estimate: EstimateOf
    _beneath: dict[Reference, Upstream] = field(default_factory=dict)
    _ends: dict[Reference, tuple[_End, _End]] = field(default_factory=dict)
    _seconds: float = 0.0  # that the calculations so far were estimated to take

    def beneath(self, reference: Reference) -> Upstream:
        """The origins of a value, without the error of its own step."""
        if not self._is_carried_on:
            return NOTHING
        if not self._beneath:
            for node in self.calculation.graph.order:  # in order, so that no chain is too long to follow
                if isinstance(node, Cell):
                    self._upstream(node.reference)
        return self._upstream(reference)

    @cached_property
    def _is_carried_on(self) -> bool:
        """Whether any relation uses what is calculated or measured; what is written in a cell is exact."""
        graph = self.calculation.graph
        return any(graph.cell(used) is None for cell in graph.cells() for used in cell.uses.values())

    def _upstream(self, reference: Reference) -> Upstream:
        if reference not in self._beneath:
            self._beneath[reference] = NOTHING  # an iteration comes back to where it began
            self._beneath[reference] = self._followed(reference)
        return self._beneath[reference]

    def shifts(
        self, references: Mapping[str, Reference], upstream: Upstream
    ) -> tuple[Sequence[Shift], frozenset[Reference]]:
        """The values of some names with each uncertain origin at either end, and the origins left out."""
        if not upstream.uncertain:
            return (), frozenset()
        origins = sorted(upstream.uncertain, key=str)
        carried = [origin for origin in origins if self._is_carried(origin)]
        shifts = [
            (self._values(low, references), self._values(high, references))
            for low, high in (self._ends[origin] for origin in carried)
        ]
        return shifts, upstream.uncertain.difference(carried)

    def _followed(self, reference: Reference) -> Upstream:
        graph = self.calculation.graph
        if reference in graph.assumed:
            return self._of_model(reference.block)
        if cell := graph.cell(reference):
            return _joined(self._behind(used) for used in cell.uses.values()) if cell.uses else NOTHING
        block = graph.blocks.get(reference.block)
        if block is None:
            return NOTHING
        if reference.analysis or not (block.cls.inputs.keys() | block.cls.formulas.keys()) & {
            reference.member
        }:
            return self._of_model(block.name)
        return self._of_block(block, reference.member)

    def behind(self, reference: Reference) -> Upstream:
        """The origins of a value for those who use it: the error of its own step, and those beneath it."""
        return self.beneath(reference) | self._own(reference)

    def _behind(self, reference: Reference) -> Upstream:
        return self._upstream(reference) | self._own(reference)

    def _own(self, reference: Reference) -> Upstream:
        estimate = self.estimate(reference)
        if isinstance(estimate, Absent):
            return NOTHING
        here = frozenset({reference})
        if np.isnan(estimate.error).any():
            return Upstream(unknown=here)
        if not estimate.is_stated:
            return Upstream(unstated=here)
        return NOTHING if estimate.is_exact else Upstream(uncertain=here)

    def _of_block(self, block: Block, member: str) -> Upstream:
        """The origins of an input or output of a block: the cells on which it depends here."""
        declared = block.cls.inputs.get(member) or block.cls.formulas[member]
        try:
            beneath = self.calculation.instance(block.name).depends_on(declared.attribute)
        except KeyError:
            return NOTHING  # it waits
        related = [cell for cell in block.cells.values() if cell.relations and cell.declared]
        used = [cell for cell in related if cell.declared and cell.declared.attribute in beneath]
        upstream = _joined(self._upstream(cell.reference) for cell in used) if used else NOTHING
        return upstream.stopped() if upstream != NOTHING and self._is_expensive(block) else upstream

    def _of_model(self, name: str) -> Upstream:
        """The origins of a measure of a solid: all its parameters. No error is carried through a solid."""
        cells = self.calculation.graph.blocks[name].cells.values()
        return _joined(self._upstream(cell.reference) for cell in cells).stopped()

    def _is_expensive(self, block: Block) -> bool:
        """True if a step takes too long to be calculated again and again; by its estimate, not by a clock."""
        return not block.is_model and self._estimated_seconds(block) > EXPENSIVE

    def _estimated_seconds(self, block: Block) -> float:
        raw = {name: self.calculation.typed.get(cell.name, cell.raw) for name, cell in block.cells.items()}
        level = levels_of(self.calculation)[block.name]
        outputs = list(self.calculation.evaluations[block.name].outputs)
        return estimated_seconds(block.cls, raw, level, None, outputs)

    def _is_carried(self, origin: Reference) -> bool:
        """Return whether what follows from an output is calculated at both ends; it is done here, once."""
        if origin in self._ends:
            return True
        seconds = 2 * self._following(origin)
        if len(self._ends) >= MOST_SHIFTED or self._seconds + seconds > LONGEST_SHIFTING:
            return False
        self._seconds += seconds
        estimate = self.estimate(origin)
        assert isinstance(estimate, Estimate)
        levels = levels_of(self.calculation)
        low, high = (
            _End(origin, recalculated(self.calculation, {origin: end}, levels)) for end in estimate.bounds()
        )
        self._ends[origin] = low, high
        return True

    def _following(self, origin: Reference) -> float:
        """Estimate how long all that follows from an output takes [s]."""
        steps = (block for block in self.calculation.graph.blocks.values() if not block.is_model)
        follow = (
            block
            for block in steps
            if block.name in self.calculation.evaluations
            and any(origin in self.beneath(cell.reference).uncertain for cell in block.cells.values())
        )
        relations = self.calculation.operations * PER_OPERATION
        return relations + sum(map(self._estimated_seconds, follow))

    def _values(self, end: _End, references: Mapping[str, Reference]) -> dict[str, Value]:
        """Values of names at one end; the origin keeps its value: its own band is counted elsewhere."""
        return {name: self._value(end, reference) for name, reference in references.items()}

    def _value(self, end: _End, reference: Reference) -> Value:
        calculation = self.calculation if reference == end.origin else end.calculation
        try:
            return calculation.value(reference)
        except (KeyError, AttributeError, TemplateError):  # refused at this end, so it is not known there
            return np.float64(np.nan)


@dataclass(frozen=True)
class _End:
    """A design calculated with one output at one end of its band."""

    origin: Reference
    calculation: Calculation


def levels_of(calculation: Calculation) -> dict[str, str | None]:
    """The level at which each step was calculated; None of a step without levels."""
    levels = {name: evaluation.level for name, evaluation in calculation.evaluations.items()}
    return {name: level if isinstance(level, str) else None for name, level in levels.items()}


def _joined(parts: Iterable[Upstream]) -> Upstream:
    return reduce(or_, parts, NOTHING)
