"""The order in which a network can be calculated, or the loop that prevents it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from app.designs.network import Cell, Network, Node
from templates.core.errors import Fault


def ordered(
    network: Network, sources: Mapping[Node, tuple[Node, ...]]
) -> tuple[tuple[Node, ...], list[Fault]]:
    """Return all nodes, each after those from which it follows; or none, and a fault that names the loop."""
    try:
        return tuple(TopologicalSorter(sources).static_order()), []
    except CycleError as error:
        path = list(_named(network, error.args[1]))
    shown = " → ".join([*path, path[0]])
    detail = f"each follows from the one before it: {shown}; break the loop or declare an iteration"
    cells = {cell.name for cell in network.cells()}
    return (), [Fault(next(name for name in path if name in cells), "loop", detail)]


def _named(network: Network, cycle: Sequence[Node]) -> Iterator[str]:
    """Return a cycle of nodes (its last is its first) in the names that its relations use."""
    for node, following in pairwise(cycle):
        if isinstance(node, Cell):
            yield node.name
        elif isinstance(following, Cell):
            yield next(name for name, used in following.uses.items() if network.node(used) is node)
