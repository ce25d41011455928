"""Relations with lists for many rows: `sum(film.pressure)`, `[a, b][n]`, each row by itself."""

from __future__ import annotations

from collections.abc import Mapping

from app.designs.columns import Column, aligned, stacked
from templates.core.units.lists import ITEM, LIST
from templates.core.units.nodes import Constant, Item, Name, Node, Operation, Word
from templates.core.units.walking import LISTWISE, check_ranks, listwise


def column_of(node: Node, columns: Mapping[str, Column]) -> Column:
    """The value of a tree in all rows, from the columns of its names and of items by their text.

    Raises
    ------
    FaultyText
        With code `shape`, where a single value stands in place of a list, or a list in place of one.
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
    """Return the number of axes of a tree in one row, from those of its names and of items by their text."""
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
