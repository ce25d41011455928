"""Conditions: comparisons, `and`, `or`, `not`, the test of a choice, and `if`.

A condition is 1 where it holds, 0 where it does not, and NaN where one of its values is missing: what is not
known decides nothing. So a formula has no value behind a condition that has none.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import Any

import numpy as np

from templates.core.errors import FaultyText
from templates.core.units.nodes import Kind, Operation
from templates.core.units.rules import same, told
from templates.core.units.units import Value, compatible


def _compared(test: Callable[[Value, Value], Any]) -> Callable[[Value, Value], Value]:
    def calculate(one: Value, other: Value) -> Value:
        holds, unknown = test(one, other), np.not_equal(one, one) | np.not_equal(other, other)
        if np.ndim(unknown):
            return np.where(unknown, np.nan, holds)
        return np.float64(np.nan if unknown else holds)

    return calculate


def _all(*conditions: Value) -> Value:
    return reduce(np.minimum, conditions)


def _any(*conditions: Value) -> Value:
    return reduce(np.maximum, conditions)


def _chosen(condition: Value, one: Value, other: Value) -> Value:
    """Either value, wherever the condition is known; both are calculated."""
    if np.ndim(condition) or np.ndim(one) or np.ndim(other):
        holds = np.equal(condition, 1.0)
        return np.where(holds, one, np.where(np.equal(condition, 0.0), other, np.nan))
    return one if condition == 1.0 else other if condition == 0.0 else np.float64(np.nan)


def _compared_kind(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    same(operation, kinds, arguments)
    return Kind()


def _condition(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    return Kind()


def _either(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    one, other = kinds[1:]
    if not compatible(one.base, other.base):
        what = f"{told(one)} and {told(other)}"
        raise FaultyText("unit_mismatch", f"then and else need equal units, not {what}")
    return Kind(one.base, one.absolute or other.absolute)


COMPARISONS = {
    operation.sign: operation
    for operation in (
        Operation("<", _compared(np.less), _compared_kind),
        Operation("<=", _compared(np.less_equal), _compared_kind),
        Operation(">", _compared(np.greater), _compared_kind),
        Operation(">=", _compared(np.greater_equal), _compared_kind),
        Operation("==", _compared(np.equal), _compared_kind),
        Operation("!=", _compared(np.not_equal), _compared_kind),
    )
}
LOGIC = {
    "and": Operation("and", _all, _condition),
    "or": Operation("or", _any, _condition),
    "not": Operation("not", lambda condition: 1.0 - condition, _condition),
}
IS = Operation("is", lambda choice, word: np.float64(choice == word), _condition)
IF = Operation("if", _chosen, _either)
CONDITIONS = frozenset({*COMPARISONS.values(), *LOGIC.values(), IS, IF})
