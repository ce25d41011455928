"""Lists: `[a, b]`, `x[3]`, and `sum`, `mean`, `count`, `min` and `max` of one list.

A list is the last axis of an array; the axes before it are points.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from templates.core.errors import FaultyText
from templates.core.units.nodes import DIFFERENCE, ONE, Kind, Operation
from templates.core.units.rules import in_words, keep, relative, same
from templates.core.units.units import Value


def _stacked(*items: Value) -> Value:
    return np.stack(np.broadcast_arrays(*items), axis=-1)


def _item(values: Value, index: Value) -> Value:
    """Return the item of a list at an index counted from 1; NaN outside the list."""
    whole, place = np.asarray(values, dtype=float), np.asarray(index, dtype=float)
    right = (place == np.floor(place)) & (place >= 1) & (place <= whole.shape[-1])
    at = np.where(right, place, 1.0).astype(np.intp) - 1
    at, _ = np.broadcast_arrays(at, whole[..., 0])
    chosen = np.take_along_axis(np.broadcast_to(whole, (*at.shape, whole.shape[-1])), at[..., None], axis=-1)
    return np.where(right, chosen[..., 0], np.nan)[()]


def _count(values: Value) -> Value:
    """Return the number of items; NaN where one of them is missing."""
    return np.where(np.isnan(np.sum(values, axis=-1)), np.nan, float(np.shape(values)[-1]))[()]


def _summed(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    relative(operation, kinds)
    counts = kinds[0].temperatures
    return replace(kinds[0], temperatures=DIFFERENCE if counts and 0.0 in counts else None)


def _counted(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    return Kind()


def _indexed(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    if kinds[1].base != ONE:
        raise FaultyText("index", f"an index must be a pure number, not {in_words(kinds[1])}")
    return kinds[0]


def _trailing(value: Value) -> Value:
    return value[..., None] if isinstance(value, np.ndarray) and value.ndim else value


LIST = Operation("list", _stacked, same)
ITEM = Operation("item", _item, _indexed, 2)
TRAILING = Operation("trailing", _trailing, keep, 1)
"""An operation that adds a list axis after the axes of the points to a single value."""
OVER_LISTS = {
    operation.sign: operation
    for operation in (
        Operation("sum", lambda values: np.sum(values, axis=-1), _summed, 1),
        Operation("mean", lambda values: np.mean(values, axis=-1), keep, 1),
        Operation("count", _count, _counted, 1),
        Operation("min", lambda values: np.min(values, axis=-1), keep, 1),
        Operation("max", lambda values: np.max(values, axis=-1), keep, 1),
    )
}
