"""Items of arrays in relations, counted from 1: `loads.main_load_x[2]`, `loads.main_load_x[bearing]`."""

from __future__ import annotations

from collections.abc import Container, Mapping

import numpy as np
from numpy.typing import NDArray

from templates.core.errors import FaultyText
from templates.core.units.operations import ONE, Item, Kind
from templates.core.units.units import Value


def check_index(item: Item, kinds: Mapping[str, Kind]) -> None:
    """Raise an error for an index that is not a number or a parameter of unit 1.

    Raises
    ------
    FaultyText
        The code is `index`.
    """
    if not isinstance(item.index, str):
        return
    if "." in item.index:
        hint = "an index must be a whole number or a parameter of the design"
        raise FaultyText("index", f"{item.text}: {hint}, such as bearing")
    if kinds[item.index].base != ONE:
        given = f"{kinds[item.index].base:~P}"
        raise FaultyText("index", f"{item.text}: {item.index} is in {given}; an index must be a pure number")


def item_of(item: Item, values: Mapping[str, Value], rows: Container[str] = ()) -> Value:
    """Return one item of an array along its first axis, or along the axis after that of the rows.

    Parameters
    ----------
    item
        The item; an index with a value for each row selects an item in each row.
    values
        The values of its names, in SI.
    rows
        The names whose first axis is that of the rows.

    Raises
    ------
    FaultyText
        The code is `index`.
    """
    whole = np.asarray(values[item.name], dtype=float)
    has_rows = item.name in rows
    if whole.ndim <= has_rows:
        raise FaultyText("index", f"{item.text}: {item.name} is a single value and has no items")
    axis = int(has_rows)
    places = _places(item, values, rows, whole.shape[axis])
    if not places.ndim:
        return _plain(np.take(whole, int(places), axis=axis))
    if not has_rows:
        return np.take(whole, places, axis=0)
    return whole[np.arange(len(places)), places]


def _places(item: Item, values: Mapping[str, Value], rows: Container[str], length: int) -> NDArray[np.intp]:
    """Return the index counted from 0: a single index, or one for each row."""
    raw = np.asarray(values[item.index] if isinstance(item.index, str) else item.index, dtype=float)
    if raw.ndim > (item.index in rows):
        raise FaultyText("index", f"{item.text}: an index must be a single number, not an array")
    wrong = raw[~((raw == np.floor(raw)) & (raw >= 1) & (raw <= length))]
    if wrong.size:
        have = f"{item.name} has {length} item{'s' if length > 1 else ''}"
        detail = f"an index is a whole number from 1 to {length}, not {float(wrong[0]):.6g}"
        raise FaultyText("index", f"{item.text}: {have}; {detail}")
    return raw.astype(np.intp) - 1


def _plain(value: NDArray[np.float64]) -> Value:
    return value if np.ndim(value) else float(value)
