"""Evaluate relations for many rows at once: `loads.main_load_x[bearing]`, `sum(film.pressure)`.

A relation whose values are equal in all rows is calculated once. If a relation is a single name, or a name
plus a constant, its result has the tolerance of that name. Other results of toleranced values also vary
within an interval, which is not a manufacturing tolerance: a tolerance analysis reports the interval, and
drawings and STEP files omit it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.designs.engine.columns import Column, aligned, stacked
from app.designs.network import Cell, Graph
from templates.core.errors import FaultyText
from templates.core.units.evaluation import LISTWISE, check_ranks, listwise
from templates.core.units.items import item_of
from templates.core.units.lists import ITEM, LIST
from templates.core.units.nodes import Apply, Constant, Item, Name, Node, Operation, Word
from templates.core.units.operations import OPERATORS
from templates.core.units.quantity import TypedQuantity
from templates.core.units.relation import Relation
from templates.core.units.tolerance import Tolerance

MOST_VALUES = 100_000  # largest number of values of a relation, or of all outputs of a step
MOST_OPERATIONS = 20_000_000  # largest number of operations on single values in all relations of a design

_ADD, _SUBTRACT = OPERATORS["add"], OPERATORS["subtract"]


def related(relation: Relation, uses: Mapping[str, Column]) -> Column:
    """Return the value of a relation in all rows; NaN where an index is outside its array.

    Raises
    ------
    FaultyText
        If curves have different lengths (code `shape`), or no row has a value (code `index`).
    """
    if not any(column.is_row for column in uses.values()):
        return Column(relation.value({name: column.value for name, column in uses.items()}))
    items = {item.text: _item(item, uses) for item in relation.items}
    columns = {**{name: uses[name] for name in relation.whole_names}, **items}
    if relation.has_lists:
        return _with_lists(relation, columns)
    values, is_row = aligned(columns)
    return Column(relation.value(values), is_row)


def _with_lists(relation: Relation, columns: Mapping[str, Column]) -> Column:
    try:
        with np.errstate(all="ignore"):
            return column_of(relation.tree, columns)
    except ValueError:
        raise FaultyText("shape", f"{relation.text!r} joins arrays of different lengths") from None


def wrong_index(relation: Relation, uses: Mapping[str, Column], row: int) -> FaultyText | None:
    """Return the error if an index is the reason why a row has no value, else None."""
    alone = {name: np.asarray(c.value)[row] if c.is_row else c.value for name, c in uses.items()}
    try:
        for item in relation.items:
            item_of(item, alone)
    except FaultyText as error:
        return error
    return None


def _item(item: Item, uses: Mapping[str, Column]) -> Column:
    whole = uses[item.name]
    index = uses[item.index] if isinstance(item.index, str) else Column(float(item.index))
    rows = {n for n, column in uses.items() if column.is_row}
    values = {name: column.value for name, column in uses.items()}
    if not index.is_row or not whole.rank:
        return Column(item_of(item, values, rows), whole.is_row)
    length = whole.places[0]
    place = np.asarray(index.value)
    right = (place == np.floor(place)) & (place >= 1) & (place <= length)
    if not right.any():
        item_of(item, values, rows)  # raises the error
    chosen = item_of(item, {**values, str(item.index): np.where(right, place, 1.0)}, rows)
    return Column(chosen, is_row=True).without(~right)


def column_of(node: Node, columns: Mapping[str, Column]) -> Column:
    """Return the value of an expression tree in all rows, given the columns of its names and items.

    Raises
    ------
    FaultyText
        If a single value is used where a list is needed, or a list where a single value is needed; the code
        is `shape`.
    """
    match node:
        case Constant(value=value):
            return Column(value)
        case Name(name=name):
            return columns[name]
        case Item():
            return columns[node.text]
        case Word(text=text):
            return Column(text)  # type: ignore[arg-type] # a word is compared with a word
    return _applied(node.operation, [column_of(argument, columns) for argument in node.arguments])


def _applied(operation: Operation, parts: list[Column]) -> Column:
    has_rows = any(part.is_row for part in parts)
    if operation is LIST:
        check_ranks(LIST, [part.rank for part in parts])
        return stacked(parts)
    if operation in LISTWISE:
        value = listwise(operation, [part.value for part in parts], [part.rank for part in parts])
        return Column(value, has_rows)
    values, _ = aligned({str(place): part for place, part in enumerate(parts)})
    return Column(operation.calculate(*values.values()), has_rows)


def rank_of(node: Node, ranks: Mapping[str, int]) -> int:
    """Return the number of axes of an expression tree in one row, given those of its names and items."""
    match node:
        case Constant() | Word():
            return 0
        case Name(name=name):
            return ranks[name]
        case Item():
            return ranks[node.text]
    inside = [rank_of(argument, ranks) for argument in node.arguments]
    if node.operation is LIST:
        return 1
    if node.operation in LISTWISE:
        return 0 if node.operation is ITEM else max(0, inside[0] - 1)
    return max(inside, default=0)


def tolerance_of(graph: Graph, cell: Cell, typed: Mapping[str, TypedQuantity]) -> Tolerance | None:
    """Return the tolerance that a cell gets through its relation; None if it has none.

    `typed` holds the values of cells as read. A tolerance zone of ISO 286 belongs to its nominal size: if a
    constant is added, the limits are kept and the zone is dropped.
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
    """Return the only name of a relation, and whether a constant is added; None for any other relation."""
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


def limit_values(values: int) -> None:
    """Refuse a place that would have more values than a design may have in one place.

    Raises
    ------
    FaultyText
        The code is `too_many_values`.
    """
    if values > MOST_VALUES:
        message = f"this gives {values} values; one place of a design may have at most {MOST_VALUES}"
        raise FaultyText("too_many_values", message)


def limit_operations(operations: int) -> None:
    """Refuse a design whose relations need more operations in total than allowed.

    Raises
    ------
    FaultyText
        The code is `too_many_values`.
    """
    if operations > MOST_OPERATIONS:
        message = f"the relations up to here need {operations} operations on single values"
        raise FaultyText("too_many_values", f"{message}; use shorter arrays; the limit is {MOST_OPERATIONS}")
