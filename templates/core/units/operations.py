"""The operators and functions of relations: their values, and the kinds of their results."""

from __future__ import annotations

from functools import reduce

import numpy as np

from templates.core.units.nodes import ONE, Apply, Constant, Item, Kind, Name, Operation, Word
from templates.core.units.rules import angle, keep, power, product, pure, root, same, summed, whole

__all__ = [
    "CONSTANTS",
    "FUNCTIONS",
    "ONE",
    "OPERATORS",
    "Apply",
    "Constant",
    "Item",
    "Kind",
    "Name",
    "Operation",
    "Word",
]

OPERATORS = {
    "add": Operation("+", np.add, summed),
    "subtract": Operation("-", np.subtract, summed),
    "multiply": Operation("*", np.multiply, product),
    "divide": Operation("/", np.divide, product),
    "power": Operation("**", np.float_power, power),
    "negative": Operation("-", np.negative, summed),
}
FUNCTIONS = {
    operation.sign: operation
    for operation in (
        Operation("abs", np.abs, keep, 1),
        Operation("sqrt", np.sqrt, root, 1),
        Operation("min", lambda *a: reduce(np.minimum, a), same),
        Operation("max", lambda *a: reduce(np.maximum, a), same),
        Operation("sin", np.sin, pure, 1),
        Operation("cos", np.cos, pure, 1),
        Operation("tan", np.tan, pure, 1),
        Operation("asin", np.arcsin, pure, 1),
        Operation("acos", np.arccos, pure, 1),
        Operation("atan", np.arctan, pure, 1),
        Operation("exp", np.exp, pure, 1),
        Operation("log", np.log, pure, 1),
        Operation("log10", np.log10, pure, 1),
        Operation("sinh", np.sinh, pure, 1),
        Operation("cosh", np.cosh, pure, 1),
        Operation("tanh", np.tanh, pure, 1),
        Operation("atan2", np.arctan2, angle, 2),
        Operation("floor", np.floor, whole, 1),
        Operation("ceil", np.ceil, whole, 1),
    )
}
CONSTANTS = {"pi": Constant(np.pi, Kind(pi=1))}
