"""Relations with items of arrays, `loads.main_load_x[bearing]`, for many rows: each row has its own index."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.designs.columns import Column, aligned
from app.designs.row_lists import column_of
from templates.core.errors import FaultyText
from templates.core.units.items import item_of
from templates.core.units.operations import Item
from templates.core.units.relation import Relation


def related(relation: Relation, uses: Mapping[str, Column]) -> Column:
    """The value of a relation in all rows; NaN where an index is no place of its array.

    Raises
    ------
    FaultyText
        With code `shape`, where curves of different lengths meet; `index`, if no row has a value.
    """
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
        raise FaultyText("shape", f"{relation.text!r} combines arrays of different lengths") from None


def wrong_index(relation: Relation, uses: Mapping[str, Column], row: int) -> FaultyText | None:
    """Why a row has no value, if that is because of an index."""
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
        item_of(item, values, rows)  # says what is wrong
    chosen = item_of(item, {**values, str(item.index): np.where(right, place, 1.0)}, rows)
    return Column(chosen, is_row=True).without(~right)
