"""The parameters and inputs that rows vary: which ones can vary, and the shape of their values."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from app.designs.analyses import axes_of, is_measured
from app.designs.document import Document
from app.designs.engine.calculate import literal
from app.designs.engine.needs import MovingNodes
from app.designs.engine.relations import rank_of
from app.designs.network import Block, Cell, Graph
from app.plain import Raw
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_name
from templates.core.language.spec import Choice, Curve, Given, Input, Profile, Table
from templates.core.units.units import Value


def with_places(document: Document, graph: Graph, varied: Collection[Reference]) -> Document:
    """Return the document with a literal at every varied place that has a default or a relation.

    The literal only fixes the shape, because the rows provide the values.
    """
    plain = document.model_copy(deep=True)
    for reference in varied:
        declared, cell = _declared(graph, reference), graph.cell(reference)
        if isinstance(declared, Choice) or (cell and not cell.relations):
            continue
        if declared is None:
            if cell:
                plain.parameters[reference.block] = {"value": 1.0, "unit": _unit(graph, reference)}
        elif reference.block in plain.steps:
            plain.steps[reference.block].inputs[reference.member] = _placeholder(declared)
        else:
            plain.models[reference.block].parameters[reference.member] = _placeholder(declared)
    return plain


def _unit(graph: Graph, reference: Reference) -> str:
    """Return the unit of a parameter that a relation sets."""
    return graph.kinds[str(reference)].unit


def _placeholder(declared: Input) -> Raw:
    default = declared.default if isinstance(declared, Given) else None
    if default is not None:
        return {"value": default.value, "unit": default.unit}
    return {"value": [1.0] if isinstance(declared, Curve) else 1.0, "unit": declared.meaning.unit}


def _declared(graph: Graph, reference: Reference) -> Input | None:
    block = graph.blocks.get(reference.block)
    if block is None or reference.analysis is not None:
        return None
    return block.cls.inputs.get(reference.member)


def place_faults(
    graph: Graph, varied: Collection[Reference], set_aside: Collection[Reference] = ()
) -> Iterator[Fault]:
    """Yield the faults of places that cannot vary, and of places whose relation cannot be set aside."""
    for reference in set_aside:
        cell, block = graph.cell(reference), graph.blocks.get(reference.block)
        if reference not in varied or (block and block.is_worksheet):
            yield Fault(str(reference), "not_varied", f"{reference} cannot vary here")
        elif cell is None or not cell.relations:
            yield Fault(
                str(reference),
                "no_relation",
                f"no relation sets {reference}, so it can vary without this option",
            )
    for reference in varied:
        name, cell = str(reference), graph.cell(reference)
        block = graph.blocks.get(reference.block)
        if block and block.is_model and is_measured(reference, block.analyses, block.cls):
            continue  # the caller provides the measurements of each row
        if cell is None and _declared(graph, reference) is None:
            yield unknown_name(name, _places(graph), "place")
        elif isinstance(_declared(graph, reference), Choice):
            yield Fault(name, "not_a_number", f"{name} is not a quantity; only quantities can vary")
        elif cell and cell.relations and reference not in set_aside:
            yield Fault(name, "follows_from", _followed(cell))


def _followed(cell: Cell) -> str:
    """Return a message that a relation sets a value, and the values that can vary instead."""
    text = cell.raw if isinstance(cell.raw, str) else "a list with relations"
    instead = (
        f"; vary {', '.join(sorted(cell.uses))} instead, or replace the relation with a value"
        if cell.uses
        else ""
    )
    return f"{cell.name} is calculated ({text.strip()}){instead}"


def _places(graph: Graph) -> list[str]:
    blocks = (block for block in graph.blocks.values() if not block.is_worksheet)
    inputs = (f"{block.name}.{name}" for block in blocks for name in block.cls.inputs)
    return [*graph.parameters, *inputs]


@dataclass(frozen=True)
class Ranks:
    """The number of axes that each value has in one row, as far as known before the calculation."""

    graph: Graph
    moving: MovingNodes
    _ranks: dict[Cell, int] = field(default_factory=dict)

    def faults(self, blocks: Collection[str]) -> Iterator[Fault]:
        """Yield a fault for each single-valued input that gets a list, in steps that differ between rows."""
        for node in self.graph.order:
            if isinstance(node, Cell):
                self._ranks[node] = self._of_cell(node)
            elif isinstance(node, Block) and node in self.moving and node.name in blocks:
                yield from self._of_step(node)

    def _of_step(self, block: Block) -> Iterator[Fault]:
        for name, cell in block.cells.items():
            declared = block.cls.inputs[name]
            if not isinstance(declared, Table) and self._ranks[cell] > int(isinstance(declared, Curve)):
                detail = "this is a list; if rows vary, an input has one value in each row"
                yield Fault(cell.name, "shape", f"{detail}: give one value, or vary it too")

    def _of_cell(self, cell: Cell) -> int:
        if isinstance(cell.declared, Choice):
            return 0
        if isinstance(cell.raw, list) and cell.relations:
            return 1
        if not cell.relations:
            return _rank(cell)
        relation = cell.relations[0]
        ranks = {name: self._of_reference(cell.uses[name]) for name in relation.whole_names}
        ranks |= {item.text: self._of_reference(cell.uses[item.name]) - 1 for item in relation.items}
        return rank_of(relation.tree, ranks)

    def _of_reference(self, reference: Reference) -> int:
        if cell := self.graph.cell(reference):
            return self._ranks[cell]
        if axes := axes_of(reference):
            return axes
        block = self.graph.blocks[reference.block]
        formula = block.cls.formulas.get(reference.member)
        own = formula.axes if isinstance(formula, Profile) else 0
        return own + (0 if block in self.moving else self._points(block))

    def _points(self, block: Block) -> int:
        """Return the number of axes of the points at which a step is calculated in each row."""
        inputs = ((self._ranks[cell], block.cls.inputs[name]) for name, cell in block.cells.items())
        return max((n - isinstance(d, Curve) for n, d in inputs if not isinstance(d, Table)), default=0)


def _rank(cell: Cell) -> int:
    try:
        return np.ndim(literal(cell).si)
    except FaultyText:
        return 0  # reported when the cell is read


def checked_rows(
    graph: Graph, varied: Collection[Reference], rows: Mapping[Reference, Value]
) -> tuple[int, dict[Reference, Array]]:
    """Return the number of rows, and their columns as arrays.

    Raises
    ------
    InvalidInputs
        If columns are missing, too many, of different lengths or of the wrong shape.
    """
    faults = [
        Fault(str(r), "missing", "this parameter varies, so every row needs a value for it")
        for r in varied
        if r not in rows
    ]
    faults += [
        Fault(str(r), "unknown_name", "this parameter was not declared as varied")
        for r in rows
        if r not in varied
    ]
    arrays = {reference: np.asarray(value, dtype=float) for reference, value in rows.items()}
    count = next((len(array) for array in arrays.values() if array.ndim), 1)
    for reference, array in arrays.items():
        if reference in varied and array.ndim - 1 not in _ranks(graph, reference):
            faults.append(
                Fault(
                    str(reference), "shape", f"values of this parameter cannot have the shape {array.shape}"
                )
            )
        elif array.ndim and len(array) != count:
            detail = (
                f"all columns must have the same length, but this one has {len(array)} rows, another {count}"
            )
            faults.append(Fault(str(reference), "shape", detail))
    if faults:
        raise InvalidInputs(faults)
    return count, arrays


def _ranks(graph: Graph, reference: Reference) -> set[int]:
    """Return the numbers of axes that a varied value may have in one row."""
    declared = _declared(graph, reference)
    if isinstance(declared, Curve):
        return {0, 1} if declared.constant else {1}
    if isinstance(declared, Table):
        return {2}
    cell = graph.cell(reference)
    return {_rank(cell)} if cell and declared is None else {0}
