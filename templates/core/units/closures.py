"""Compile a checked tree to nested functions: the tree is walked once, the functions are called often."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from templates.core.units.conditions import COMPARISONS, IF, IS, LOGIC
from templates.core.units.nodes import Constant, Name, Operation, Word
from templates.core.units.operations import OPERATORS
from templates.core.units.units import Value

Closure = Callable[[Any], Any]


def _quotient(over: Value, under: Value) -> Value:
    try:
        return over / under
    except ZeroDivisionError:  # from two Python floats
        return np.divide(over, under)


def _power(base: Value, exponent: Value) -> Value:
    return (np.float64(base) if type(base) is float else base) ** exponent


_PLAIN: dict[
    Operation, Callable[..., Any]
] = {  # Python's operators are faster on single values than NumPy's functions
    OPERATORS["add"]: operator.add,
    OPERATORS["subtract"]: operator.sub,
    OPERATORS["multiply"]: operator.mul,
    OPERATORS["divide"]: _quotient,
    OPERATORS["power"]: _power,
    OPERATORS["negative"]: operator.neg,
}


def closure(node: Any, attributes: Mapping[str, str] | None = None) -> Closure:
    """Return a tree as a function; for a condition it returns truth values, False where it is unknown.

    The function takes an object with an attribute for each name of the tree, in SI: single values, or arrays
    whose first axis is that of the points. `attributes` maps names to attributes with a different name.
    """
    run = _closure(node, attributes or {})
    return (lambda template: np.equal(run(template), 1.0)) if is_condition(node) else run


def is_condition(node: Any) -> bool:
    """Return whether a tree is a condition."""
    operation = getattr(node, "operation", None)
    if operation is IF:
        return is_condition(node.arguments[1])
    return operation is IS or operation in LOGIC.values() or operation in COMPARISONS.values()


def _closure(node: Any, attributes: Mapping[str, str]) -> Closure:
    match node:
        case Constant(value=value):
            plain = np.float64(value)  # a Python float would raise an error at 1/0
            return lambda template: plain
        case Word(text=text):
            return lambda template: text
        case Name(name=name):
            return operator.attrgetter(attributes.get(name, name))
    calculate = _calculation(node.operation)
    parts = [_closure(part, attributes) for part in node.arguments]
    match parts:
        case [only]:
            return lambda template: calculate(only(template))
        case [left, right]:
            return lambda template: calculate(left(template), right(template))
    return lambda template: calculate(*[part(template) for part in parts])


def _calculation(operation: Operation) -> Callable[..., Any]:
    return _PLAIN.get(operation, operation.calculate)
