"""Tolerances that a relation hands on to a model: of a toleranced value, or of that plus a constant.

Whatever else follows from toleranced values lies in an interval too, but no part is made to that interval: an
analysis of tolerances reports it, and drawing and STEP file do not prescribe it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from app.designs.network import Cell, Graph
from templates.core.units.nodes import Apply, Constant, Name, Node
from templates.core.units.operations import OPERATORS
from templates.core.units.quantity import Typed
from templates.core.units.tolerance import Tolerance

_ADD, _SUBTRACT = OPERATORS["add"], OPERATORS["subtract"]


def tolerance_of(graph: Graph, cell: Cell, typed: Mapping[str, Typed]) -> Tolerance | None:
    """The tolerance that a cell has by its relation; None if it has none.

    `typed` are the values of cells as they were read. A zone of ISO 286 is that of its own nominal size:
    where a constant is added, the limits stay and the zone goes.
    """
    is_moved = False
    while cell.relations:
        if isinstance(cell.raw, list) or (term := _term(cell.relations[0].tree)) is None:
            return None
        name, offset = term
        source = graph.node(cell.uses[name])
        if not isinstance(source, Cell):
            return None
        cell, is_moved = source, is_moved or offset
    read = typed.get(cell.name)
    tolerance = read.tolerance if read is not None and isinstance(read.si, float) else None
    return replace(tolerance, zone=None) if tolerance is not None and is_moved else tolerance


def _term(tree: Node) -> tuple[str, bool] | None:
    """The only name of a relation, and whether a constant is added to it; None of any other relation."""
    match tree:
        case Name(name=name):
            return name, False
        case Apply(operation=operation, arguments=(Name(name=name), other)) if operation in (_ADD, _SUBTRACT):
            return (name, True) if _is_constant(other) else None
        case Apply(operation=operation, arguments=(other, Name(name=name))) if operation is _ADD:
            return (name, True) if _is_constant(other) else None
    return None


def _is_constant(tree: Node) -> bool:
    """Return whether a part of a relation is a number with its unit, as in `= bore - 50 um`."""
    return isinstance(tree, Constant) or (
        isinstance(tree, Apply) and bool(tree.arguments) and all(map(_is_constant, tree.arguments))
    )
