"""The sort of a node in an expression: a quantity, a temperature, a condition, a list, or a choice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from templates.core.errors import FaultyText
from templates.core.units.conditions import COMPARISONS, IF, IS, LOGIC
from templates.core.units.lists import ITEM, LIST, OVER_LISTS, TRAILING
from templates.core.units.nodes import Apply, Constant, Kind, Operation, Word

MAX_NODES, MAX_NODES_DEEP = 10_000, 200
PURE = Kind()


@dataclass(frozen=True)
class Sort:
    """The sort of a node.

    Attributes
    ----------
    kind
        The kind of quantity.
    truth
        Whether it is a condition, which is not a quantity.
    axis
        The name of the axis of its list; empty for a single value.
    words
        The options of a choice.
    depth, size
        Depth and size of its tree, which are limited; a part that occurs twice is calculated twice and counts
        twice.
    """

    kind: Kind = PURE
    truth: bool = False
    axis: str = ""
    words: tuple[str, ...] = ()
    depth: int = 1
    size: int = 1


Part = tuple[Any, Sort]
"""A node and its sort."""


def applied(operation: Operation, parts: Sequence[Part]) -> Part:
    """Return the node that applies an operation to its operands, and the sort of its result.

    A single value that is combined with a list gets a trailing axis here, once.

    Raises
    ------
    FaultyText
        The code is `unit_mismatch`, `no_truth`, `axis_mismatch`, `index` or `too_large`.
    """
    sorts = [sort for _, sort in parts]
    axis, meeting = _axis(operation, sorts)
    nodes = tuple(_widened(node, sort) if meeting and not sort.axis else node for node, sort in parts)
    return Apply(operation, nodes), sorted_by(operation, parts, axis)


def sorted_by(operation: Operation, parts: Sequence[Part], axis: str = "") -> Sort:
    """Return the sort of an operation's result, regardless of its list axes.

    Raises
    ------
    FaultyText
        The code is `unit_mismatch`, `no_truth`, `index` or `too_large`.
    """
    nodes, sorts = tuple(node for node, _ in parts), [sort for _, sort in parts]
    truth = _truth(operation, sorts)
    depth = 1 + max(sort.depth for sort in sorts)
    if depth > MAX_NODES_DEEP:
        raise FaultyText("too_large", f"an expression must be at most {MAX_NODES_DEEP} operations deep")
    size = 1 + sum(sort.size for sort in sorts)
    if size > MAX_NODES:
        detail = f"an expression may have at most {MAX_NODES} operations, including those in its functions"
        raise FaultyText("too_large", detail)
    kind = operation.kind(operation, [sort.kind for sort in sorts], nodes)
    return Sort(kind, truth, axis, depth=depth, size=size)


def _truth(operation: Operation, sorts: list[Sort]) -> bool:
    """Return whether the result is a condition; raise an error for operands of the wrong sort."""
    if operation is not IS and (words := next((sort.words for sort in sorts if sort.words), ())):
        raise FaultyText("no_truth", f"a choice is not a quantity: test it, for example `law is {words[0]}`")
    truths = [sort.truth for sort in sorts]
    if operation is IF:
        if not truths[0]:
            raise FaultyText("no_truth", "`if` needs a condition, such as `x < 3 mm`, not a quantity")
        if truths[1] != truths[2]:
            raise FaultyText("no_truth", "then and else must be two quantities or two conditions")
        return truths[1]
    is_logic = operation in LOGIC.values()
    if is_logic and not all(truths):
        raise FaultyText(
            "no_truth", f"`{operation.sign}` joins conditions, such as `x < 3 mm`, not quantities"
        )
    if not is_logic and any(truths):
        raise FaultyText(
            "no_truth",
            f"{operation.sign} takes quantities, not a condition; write `if … then … else …`",
        )
    return is_logic or operation is IS or operation in COMPARISONS.values()


def _axis(operation: Operation, sorts: list[Sort]) -> tuple[str, bool]:
    """Return the axis of the result, and whether single values are combined with a list."""
    axes = list(dict.fromkeys(sort.axis for sort in sorts if sort.axis))
    if operation is LIST:
        if axes:
            raise FaultyText(
                "axis_mismatch", f"an item of a list must be a single value, not a list over {axes[0]}"
            )
        return literal_axis(len(sorts)), False
    if operation is ITEM:
        return _single_item(*sorts), False
    if operation in OVER_LISTS.values():
        if not axes:
            raise FaultyText("axis_mismatch", f"{operation.sign} takes a list; this is a single value")
        return "", False
    if len(axes) > 1:
        raise FaultyText(
            "axis_mismatch", f"{operation.sign} joins a list over {axes[0]} and one over {axes[1]}"
        )
    return (axes[0], True) if axes else ("", False)


def _single_item(whole: Sort, index: Sort) -> str:
    if not whole.axis:
        raise FaultyText("axis_mismatch", "a single value has no items")
    if index.axis:
        raise FaultyText("axis_mismatch", f"an index must be a single number, not a list over {index.axis}")
    return ""


def literal_axis(count: int) -> str:
    """Return the axis name of a literal list."""
    return f"{count} item{'s' if count > 1 else ''}"


def _widened(node: Any, sort: Sort) -> Any:
    return node if isinstance(node, (Constant, Word)) or sort.words else Apply(TRAILING, (node,))
