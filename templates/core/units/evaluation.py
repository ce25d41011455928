"""Evaluate the tree of a relation from the values of its names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from templates.core.errors import FaultyText
from templates.core.units.lists import ITEM, LIST, OVER_LISTS
from templates.core.units.nodes import Apply, Constant, Item, Name, Operation
from templates.core.units.units import Value

LISTWISE = frozenset({LIST, ITEM, *OVER_LISTS.values()})
"""The operations that create or reduce lists; all others act item by item."""


def value_of(node: Any, values: Mapping[str, Value]) -> Value:
    """Return the value of a tree, given the values of its names, and those of its items by their text.

    Raises
    ------
    FaultyText
        If a single value is used as a list, or a list as a single value; the code is `shape`.
    """
    if isinstance(node, Name):
        return values[node.name]
    if isinstance(node, Apply):
        parts = [value_of(argument, values) for argument in node.arguments]
        if node.operation in LISTWISE:
            return listwise(node.operation, parts, [np.ndim(part) for part in parts])
        return node.operation.calculate(*parts)
    if isinstance(node, Constant):
        return node.value
    return values[node.text] if isinstance(node, Item) else node.text  # a word is compared with a word


def listwise(operation: Operation, parts: list[Value], ranks: list[int]) -> Value:
    """Return the value of an operation that takes or creates a list; `ranks` counts the axes of each operand.

    Raises
    ------
    FaultyText
        The code is `shape`.
    """
    check_ranks(operation, ranks)
    if operation in OVER_LISTS.values() and not ranks[0]:
        return parts[0]
    return operation.calculate(*parts)


def check_ranks(operation: Operation, ranks: list[int]) -> None:
    """Raise an error for a single value in place of a list, or a list in place of a single value.

    Raises
    ------
    FaultyText
        The code is `shape`.
    """
    if operation is LIST and any(ranks):
        detail = "each item of a list is a single value, but an expression in it gives an array"
        raise FaultyText("shape", detail)
    if operation is ITEM and ranks[1]:
        raise FaultyText("shape", "an index must be a single number, not an array")
    if operation in OVER_LISTS.values() and not ranks[0] and operation.sign not in ("min", "max"):
        raise FaultyText("shape", f"{operation.sign} takes a list; this is a single value")


def applied_in(node: Any) -> Iterator[Apply]:
    """Return the operations of a tree."""
    return (part for part in nodes_of(node) if isinstance(part, Apply))


def nodes_of(node: Any) -> Iterator[Any]:
    """Yield the nodes of a tree, each node before its arguments."""
    left = [node]
    while left:
        yield (first := left.pop())
        left += reversed(getattr(first, "arguments", ()))


def depth_of(node: Any) -> int:
    """Return the depth of a tree."""
    depth, level = 0, [node]
    while level:
        depth += 1
        level = [argument for part in level for argument in getattr(part, "arguments", ())]
    return depth
