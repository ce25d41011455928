"""How errors of steps reach what follows from them, row by row: `app.designs.shifting` for many rows.

Which outputs a value follows from is the same in all rows; how uncertain they are is not. Each uncertain
output is shifted to both ends of its band in all rows at once, and what follows is calculated again.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import reduce
from operator import or_

import numpy as np

from app.calculations.cost import EXPENSIVE, estimated_seconds
from app.designs.columns import Column
from app.designs.network import Block, Cell, Node
from app.designs.row_estimates import RowEstimate, estimate_rows
from app.designs.row_pass import RowPass
from app.designs.rows_needed import is_member
from app.designs.shifting import LONGEST_SHIFTING, MOST_SHIFTED
from app.plain import Raw
from app.reference import Reference
from templates.core.arrays import Mask
from templates.core.units.quantity import Typed


@dataclass(frozen=True)
class Origins:
    """The outputs of steps that a value follows from.

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
        """The same, behind something through which no error is carried."""
        return Origins(stopped=self.carried | self.stopped)


NONE = Origins()


@dataclass
class RowShifting:
    """The errors of one chunk of rows."""

    rows: RowPass
    _beneath: dict[Reference, Origins] = field(default_factory=dict)
    _estimates: dict[Reference, RowEstimate] = field(default_factory=dict)
    _ends: dict[Reference, tuple[RowPass, RowPass]] = field(default_factory=dict)
    _seconds: float = 0.0  # that the calculations so far would take of one row

    def estimate(self, reference: Reference) -> RowEstimate:
        """The value of a name with the error of its own step."""
        if reference not in self._estimates:
            self._estimates[reference] = estimate_rows(self.rows, reference)
        return self._estimates[reference]

    def beneath(self, reference: Reference) -> Origins:
        """The origins of a value, without the error of its own step."""
        if not self._beneath:
            for node in self.rows.question.graph.order:  # in order, so that no chain is too long to follow
                if isinstance(node, Cell) and node in self.rows.cells:
                    self._origins(node.reference)
        return self._origins(reference)

    def unknown(self, origins: Origins) -> Mask:
        """The rows in which the error of any of the outputs is not known."""
        unknown = np.zeros(self.rows.count, dtype=bool)
        for origin in origins.carried:
            unknown |= np.isnan(self.estimate(origin).error.spread(self.rows.count))
        return unknown

    def is_stated(self, origins: Origins) -> bool:
        """Return whether the errors of all outputs are stated, and carried on."""
        return not origins.stopped and all(self.estimate(origin).is_stated for origin in origins.carried)

    def shifts(
        self, references: Mapping[str, Reference], origins: Origins
    ) -> tuple[list[tuple[dict[str, Column], dict[str, Column]]], bool]:
        """The values of some names with each uncertain output at either end, and whether all were shifted."""
        uncertain = [o for o in sorted(origins.carried, key=str) if np.any(self.estimate(o).error.value > 0)]
        carried = [origin for origin in uncertain if self._is_carried(origin)]
        shifts = []
        for origin in carried:
            low, high = (
                {
                    name: (self.rows if reference == origin else end).value(reference)
                    for name, reference in references.items()
                }
                for end in self._ends[origin]
            )
            shifts.append((low, high))
        return shifts, len(carried) == len(uncertain)

    def _origins(self, reference: Reference) -> Origins:
        if reference not in self._beneath:
            self._beneath[reference] = NONE  # an iteration comes back to where it began
            self._beneath[reference] = self._followed(reference)
        return self._beneath[reference]

    def _followed(self, reference: Reference) -> Origins:
        graph = self.rows.question.graph
        if reference in self.rows.given:
            return NONE
        if cell := graph.cell(reference):
            return _joined(self._behind(used) for used in cell.uses.values())
        block = graph.blocks.get(reference.block)
        if block is None:
            return NONE
        if not is_member(graph, reference):
            return _joined(self._origins(cell.reference) for cell in block.cells.values()).without()
        return self._of_block(block, reference.member)

    def _behind(self, reference: Reference) -> Origins:
        own = Origins(frozenset({reference})) if self._is_calculated(reference) else NONE
        return self._origins(reference) | own

    def _is_calculated(self, reference: Reference) -> bool:
        """Return whether a name is an output of a step that is calculated, and so may be off."""
        graph = self.rows.question.graph
        block = graph.blocks.get(reference.block)
        if block is None or block.is_model or reference in self.rows.given or graph.cell(reference):
            return False
        return reference.analysis is None and reference.member in block.cls.formulas

    def _of_block(self, block: Block, member: str) -> Origins:
        """The origins of an input or output of a block: the cells on which it depends."""
        step = self.rows.steps.get(block.name)
        declared = block.cls.inputs.get(member) or block.cls.formulas[member]
        if step is None or not step.parts:
            return NONE
        beneath = step.parts[0].template.depends_on(declared.attribute)
        related = [cell for cell in block.cells.values() if cell.relations and cell.declared]
        used = [cell for cell in related if cell.declared and cell.declared.attribute in beneath]
        origins = _joined(self._origins(cell.reference) for cell in used)
        is_expensive = origins != NONE and not block.is_model and self._of_one_row(block) > EXPENSIVE
        return origins.without() if is_expensive else origins

    def _of_one_row(self, block: Block) -> float:
        """Estimate how long a step takes for a single row [s], as a design of its own."""
        raw = {name: self._first(cell) for name, cell in block.cells.items()}
        step, outputs = self.rows.steps[block.name], self.rows.question.graph.computed(block)
        return estimated_seconds(block.cls, raw, step.level, None, outputs)

    def _first(self, cell: Cell) -> Raw:
        """The value of a cell in the first row."""
        column = self.rows.cells.get(cell)
        if column is None or cell.declared is None:
            return cell.raw
        si = column.of(slice(0, 1)).value[0] if column.is_row else column.value  # type: ignore[index]
        return Typed(None, cell.declared.meaning.unit, si if np.ndim(si) else float(si), {})

    def _is_carried(self, origin: Reference) -> bool:
        """Return whether what follows from an output is calculated at both ends; it is done here, once."""
        if origin in self._ends:
            return True
        following = self._following(origin)
        steps = [node for node in following if isinstance(node, Block) and node.name in self.rows.steps]
        seconds = 2 * sum(self._of_one_row(block) for block in steps)
        if len(self._ends) >= MOST_SHIFTED or self._seconds + seconds > LONGEST_SHIFTING:
            return False
        self._seconds += seconds
        low, high = self.estimate(origin).bounds()
        self._ends[origin] = self._again(origin, low, following), self._again(origin, high, following)
        return True

    def _again(self, origin: Reference, end: Column, following: list[Node]) -> RowPass:
        levels = {name: step.level for name, step in self.rows.steps.items()}
        pinned = replace(self.rows, question=replace(self.rows.question, levels=levels))
        return pinned.again({origin: end}, following)

    def _following(self, origin: Reference) -> list[Node]:
        """The cells and steps that follow from an output, in order; solids stay as they are."""
        graph, moved = self.rows.question.graph, dict[Node, None]()
        for node in graph.order:
            if isinstance(node, Cell):
                is_moved = origin in node.uses.values() or not moved.keys().isdisjoint(graph.sources[node])
            else:
                cells = node.cells.values() if isinstance(node, Block) and not node.is_model else ()
                is_moved = not moved.keys().isdisjoint(cells)
            moved |= {node: None} if is_moved else {}
        return list(moved)


def _joined(parts: Iterable[Origins]) -> Origins:
    return reduce(or_, parts, NONE)
