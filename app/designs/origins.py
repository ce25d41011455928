"""Trace values of a design to their origins: the typed quantities, and the solids in between."""

from __future__ import annotations

import math
from collections.abc import Iterable

from app.designs.analyses import is_table
from app.designs.engine.calculation import Calculation
from app.designs.engine.needs import is_member, needs
from app.designs.engine.row_design import Targets
from app.designs.network import Cell, Graph
from app.reference import Reference
from templates.core.errors import FaultyText


def literals_behind(calculation: Calculation, starts: Iterable[Reference]) -> list[Cell]:
    """Return the typed single quantities on which values depend; each formula is traced separately.

    Quantities that act through a measurement of a solid are included.
    """
    cells = cells_behind(calculation.graph, starts)
    return [cell for cell in cells if not cell.relations and _is_single(calculation, cell)]


def cells_behind(graph: Graph, starts: Iterable[Reference]) -> list[Cell]:
    """Return the cells on which values depend, also through a measurement of a solid."""
    cells = list[Cell]()
    left, seen = [*starts][::-1], set[Reference]()
    while left:
        reference = left.pop()
        if reference in seen:
            continue
        seen.add(reference)
        if cell := graph.cell(reference):
            cells.append(cell)
            left += cell.uses.values()
        elif reference.block in graph.blocks:
            left += _inputs(graph, reference)
    return cells


def _inputs(graph: Graph, reference: Reference) -> list[Reference]:
    """Return the cells on which an input or output of a block depends; all cells for a measurement."""
    block = graph.blocks[reference.block]
    if not is_member(graph, reference):
        return [cell.reference for cell in block.cells.values()]
    inputs = block.cls.inputs
    declared = inputs.get(reference.member) or block.cls.formulas[reference.member]
    used = block.cls.dependencies(declared.attribute)
    return [cell.reference for name, cell in block.cells.items() if inputs[name].attribute in used]


def _is_single(calculation: Calculation, cell: Cell) -> bool:
    column = calculation.values.get(cell.name)
    return column is not None and isinstance(column.value, float)


def measures_behind(calculation: Calculation, wanted: Targets) -> dict[Reference, float]:
    """Return the measurements of solids [SI] on which values depend, also through other solids.

    A measurement is NaN if its solid is not built or not analysed.
    """
    return {measure: _measure(calculation, measure) for measure in solid_measures(calculation.graph, wanted)}


def solid_measures(graph: Graph, wanted: Targets) -> list[Reference]:
    """Return the measurements of solids on which values depend, without tables, also through other solids."""
    measures = dict[Reference, None]()
    left, seen = [*needs(graph, wanted.references, (), wanted.inside).waiting], set[Reference]()
    while left:
        if (reference := left.pop()) in seen:
            continue
        seen.add(reference)
        if not is_table(reference):
            measures[reference] = None
        cells = graph.blocks[reference.block].cells.values()
        left += needs(graph, (cell.reference for cell in cells), ()).waiting
    return list(measures)


def _measure(calculation: Calculation, reference: Reference) -> float:
    try:
        return float(calculation.value(reference))
    except (FaultyText, KeyError):  # the solid is not built or not analysed
        return math.nan
