"""Trace values of a design to their origins: the typed quantities, and the solids in between."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.designs.analyses import is_table
from app.designs.engine.calculation import Calculation
from app.designs.engine.needs import Needs, is_member, needs
from app.designs.engine.row_design import Targets
from app.designs.network import Block, Cell, Graph
from app.reference import Reference
from templates.core.errors import FaultyText


def literals_behind(calculation: Calculation, starts: Iterable[Reference]) -> list[Cell]:
    """Return the typed single quantities on which values depend; each formula is traced separately.

    Quantities that act through a measurement of a solid are included.
    """
    graph, cells = calculation.graph, list[Cell]()
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
    return [cell for cell in cells if not cell.relations and _is_single(calculation, cell)]


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


def through_solids(graph: Graph, wanted: Targets) -> Mapping[Reference, Block]:
    """Return the cells that affect values through a solid, each with the model of one such solid.

    A step is traced as a whole, because its calculation needs all its inputs.
    """
    cells: dict[Reference, Block] = {}
    left, seen = [*_needs(graph, wanted).waiting], set[str]()
    while left:
        model = graph.blocks[left.pop().block]
        if model.name not in seen:
            seen.add(model.name)
            behind = needs(graph, (cell.reference for cell in model.cells.values()), ())
            cells = {cell.reference: model for cell in behind.cells} | cells
            left += behind.waiting
    return cells


def measures_behind(calculation: Calculation, wanted: Targets) -> dict[Reference, float]:
    """Return the known measurements of solids [SI] on which values depend, without tables."""
    measures: dict[Reference, float] = {}
    for reference in _needs(calculation.graph, wanted).waiting:
        if is_table(reference):
            continue
        try:
            measures[reference] = float(calculation.value(reference))
        except (FaultyText, KeyError):  # the solid is not built or not analysed
            continue
    return measures


def _needs(graph: Graph, wanted: Targets) -> Needs:
    return needs(graph, wanted.references, (), wanted.inside)
