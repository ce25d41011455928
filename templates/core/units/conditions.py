"""Conditions: comparisons, `and`, `or`, `not`, the test of a choice, and `if`.

A condition is 1 if true, 0 if false, and NaN if one of its values is missing. A formula has no value where
its condition is NaN.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import replace
from functools import reduce
from typing import Any

import numpy as np

from templates.core.errors import FaultyText
from templates.core.units.conformity import turns_remark
from templates.core.units.nodes import Kind, Operation
from templates.core.units.rules import as_compared, same
from templates.core.units.units import Value, base_text, radians, unit

_TRUE, _FALSE, _UNKNOWN = np.float64(1.0), np.float64(0.0), np.float64(np.nan)


def _compared(test: Callable[[Value, Value], Any]) -> Callable[[Value, Value], Value]:
    def calculate(one: Value, other: Value) -> Value:
        if isinstance(one, float) and isinstance(other, float):
            if one != one or other != other:
                return _UNKNOWN
            return _TRUE if test(one, other) else _FALSE
        holds, unknown = test(one, other), np.not_equal(one, one) | np.not_equal(other, other)
        return np.where(unknown, np.nan, holds)[()] if np.any(unknown) else holds

    return calculate


def _all(*conditions: Value) -> Value:
    return reduce(np.minimum, conditions)


def _any(*conditions: Value) -> Value:
    return reduce(np.maximum, conditions)


def _chosen(condition: Value, one: Value, other: Value) -> Value:
    """Return one of two values by a condition; NaN where it is unknown. Both values are calculated."""
    if isinstance(condition, np.ndarray) or isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        if isinstance(condition, np.ndarray) and condition.dtype == bool:  # no value is missing
            return np.where(condition, one, other)
        holds = np.equal(condition, 1.0)
        return np.where(holds, one, np.where(np.equal(condition, 0.0), other, np.nan))
    return one if condition == 1.0 else other if condition == 0.0 else np.float64(np.nan)


def _compared_kind(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    for place, other in ((0, 1), (1, 0)):
        if meant := as_compared(operation.sign, kinds[other], arguments[place], arguments[other]):
            detail = f"{operation.sign} compares a difference of temperatures with {arguments[place].text}"
            raise FaultyText("unit_mismatch", f"{detail}; write {meant}")
    same(operation, kinds, arguments)
    for own, beside in ((kinds[0], kinds[1]), (kinds[1], kinds[0])):
        if own.turned and not radians(beside.base):
            raise FaultyText("unit_mismatch", turns_remark(own, unit(base_text(beside)), ""))
    return Kind()


def _condition(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    return Kind()


def _either(operation: Operation, kinds: list[Kind], nodes: tuple[Any, ...]) -> Kind:
    return same(replace(operation, sign="then and else"), kinds[1:], nodes[1:])


COMPARISONS = {
    operation.sign: operation
    for operation in (
        Operation("<", _compared(operator.lt), _compared_kind),
        Operation("<=", _compared(operator.le), _compared_kind),
        Operation(">", _compared(operator.gt), _compared_kind),
        Operation(">=", _compared(operator.ge), _compared_kind),
        Operation("==", _compared(operator.eq), _compared_kind),
        Operation("!=", _compared(operator.ne), _compared_kind),
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
