"""Find what a design must calculate for the requested values, and which parts differ from row to row.

Pure functions over the network: no value is calculated here.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from app.designs.network import Block, Cell, Graph, Node, Solid, SolidAnalysis
from app.reference import Reference
from templates.core.errors import Fault


@dataclass(frozen=True)
class Needs:
    """The cells and blocks on which some values depend.

    Attributes
    ----------
    cells
        Cells whose values are used.
    members
        For each block, its inputs and outputs that are used and are not cells.
    waiting
        Measurements of solids and outputs of analyses that are not known yet.
    """

    cells: set[Cell] = field(default_factory=set)
    members: dict[str, set[str]] = field(default_factory=dict)
    waiting: set[Reference] = field(default_factory=set)

    def outputs(self, block: Block) -> tuple[str, ...]:
        """Return the used formulas of a block, in declaration order."""
        used = self.members.get(block.name, set())
        return tuple(name for name in block.cls.formulas if name in used)


def needs(
    graph: Graph,
    wanted: Iterable[Reference],
    measured: Collection[Reference],
    inside: Iterable[Reference] = (),
) -> Needs:
    """Return all nodes on which some values depend, without the nodes behind known (`measured`) values.

    For the inputs in `inside`, the steps themselves are also needed.
    """
    result, seen = Needs(), set[Reference]()
    left = [*wanted, *(before for reference in inside for before in _of_member(graph, reference, result))]
    while left:
        reference = left.pop()
        if reference in seen:
            continue
        seen.add(reference)
        left += _before(graph, reference, measured, result)
    return result


def _before(
    graph: Graph, reference: Reference, measured: Collection[Reference], result: Needs
) -> Iterator[Reference]:
    """Mark a value as needed, and yield the values that it uses."""
    if cell := graph.cell(reference):
        result.cells.add(cell)
        if reference not in measured:
            yield from cell.uses.values()
    elif reference in measured:
        return
    elif is_member(graph, reference):
        yield from _of_member(graph, reference, result)
    else:
        result.waiting.add(reference)


def _of_member(graph: Graph, reference: Reference, result: Needs) -> list[Reference]:
    """Mark an input or output of a block as needed, and return the values on which it depends."""
    block = graph.blocks[reference.block]
    result.members.setdefault(block.name, set()).add(reference.member)
    return [cell.reference for cell in block.cells.values()]


def is_member(graph: Graph, reference: Reference) -> bool:
    """Return whether a name refers to an input or output of a step or model, not to a measurement."""
    block = graph.blocks.get(reference.block)
    if block is None or reference.analysis is not None:
        return False
    return reference.member in block.cls.inputs or reference.member in block.cls.formulas


@dataclass(frozen=True)
class MovingNodes:
    """The nodes that depend on varied places; `because` gives for each the node through which it depends."""

    because: Mapping[Node, Node | None]

    def __contains__(self, node: object) -> bool:
        return node in self.because

    def chain(self, node: Node) -> list[Node]:
        """Return the path from the varied cell to a node that depends on it."""
        nodes = [node]
        while before := self.because[nodes[-1]]:
            nodes.append(before)
        return nodes[::-1]


def varying(graph: Graph, varied: Collection[Reference]) -> MovingNodes:
    """Return all nodes that depend on varied places."""
    because: dict[Node, Node | None] = {}
    for node in graph.order:
        if source := next((source for source in graph.sources.get(node, ()) if source in because), None):
            because[node] = source
        elif isinstance(node, Cell) and _is_varied(node, varied):
            because[node] = None
    return MovingNodes(because)


def _is_varied(cell: Cell, varied: Collection[Reference]) -> bool:
    """Return whether a cell is varied, or uses a varied value such as a measurement that rows provide."""
    return any(reference in varied for reference in (cell.reference, *cell.uses.values()))


def solids_in_the_way(graph: Graph, measures: Iterable[Reference], moving: MovingNodes) -> list[Fault]:
    """Return a fault for each measurement whose solid differs between rows, with the chain of names."""
    solids = {reference: graph.blocks[reference.block].solid for reference in sorted(measures, key=str)}
    return [_in_the_way(graph, r, moving.chain(solid)) for r, solid in solids.items() if solid in moving]


def _in_the_way(graph: Graph, reference: Reference, chain: list[Node]) -> Fault:
    uses = [cell.name for cell in graph.cells() if reference in cell.uses.values()]
    names = [*map(_name, chain), str(reference), *uses[:1]]
    path = " → ".join(dict.fromkeys(filter(None, names)))
    detail = (
        f"{reference} is measured on a solid that differs from row to row ({path}); every row needs its own"
    )
    return Fault(names[0], "needs_solids", detail)


def _name(node: Node) -> str:
    match node:
        case Cell(name=name) | Block(name=name):
            return name
        case Solid() | SolidAnalysis():
            return ""  # the measurement is named instead
