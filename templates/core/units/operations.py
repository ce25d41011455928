"""The nodes of a relation's tree: constants, names, and operations that know their value and their unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
import pint

from templates.core.errors import FaultyText
from templates.core.units.units import compatible, registry

ONE = registry.Unit("")
RADIAN = registry.Unit("radian")


@dataclass(frozen=True)
class Kind:
    """What a value is measured in: SI base units; `absolute` for a temperature such as 20 degC."""

    base: pint.Unit = ONE
    absolute: bool = False


@dataclass(frozen=True)
class Constant:
    """A number, or a number with a unit, in SI."""

    value: float
    kind: Kind


@dataclass(frozen=True)
class Name:
    """A value of the design."""

    name: str


@dataclass(frozen=True)
class Item:
    """An item of an array of the design, counted from 1; the index is a number or the name of one."""

    name: str
    index: int | str

    @property
    def text(self) -> str:
        """As it is written: `loads.main_load_x[2]`."""
        return f"{self.name}[{self.index}]"


@dataclass(frozen=True)
class Apply:
    """An operator or function applied to its arguments."""

    operation: Operation
    arguments: tuple[Any, ...]


@dataclass(frozen=True)
class Operation:
    """How to calculate, and what comes out in terms of what goes in."""

    sign: str
    calculate: Callable[..., Any]
    kind: Callable[[Operation, list[Kind], tuple[Any, ...]], Kind]
    arity: int | None = None  # any number of arguments, if None


def _same(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    for other in kinds[1:]:
        if not compatible(kinds[0].base, other.base):
            what = f"{_told(kinds[0])} and {_told(other)}"
            raise FaultyText("unit_mismatch", f"{operation.sign} needs equal units, not {what}")
    return Kind(kinds[0].base, any(kind.absolute for kind in kinds))


def _relative(operation: Operation, kinds: list[Kind]) -> None:
    if any(kind.absolute for kind in kinds):
        hint = "write it in K, and differences in delta_degC"
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} cannot take a temperature in degC or degF; {hint}"
        )


def _sum(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    _relative(operation, kinds)
    return _same(operation, kinds, arguments)


def _product(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    _relative(operation, kinds)
    return Kind(reduce(lambda a, b: a / b if operation.sign == "/" else a * b, (k.base for k in kinds)))


def _power(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    _relative(operation, kinds)
    base, exponent = kinds
    if not _is_number(exponent):
        raise FaultyText("unit_mismatch", f"an exponent is a pure number, not {_told(exponent)}")
    if _is_number(base):
        return Kind()
    if not isinstance(arguments[1], Constant):
        raise FaultyText(
            "unit_mismatch", "a quantity with a unit takes a plain number as exponent, as in d**2"
        )
    if abs(arguments[1].value) > 12:
        raise FaultyText("unit_mismatch", "an exponent of a quantity with a unit is at most 12")
    return Kind(registry.Unit(base.base ** arguments[1].value))


def _root(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    _relative(operation, kinds)
    return Kind(registry.Unit(kinds[0].base ** 0.5))


def _keep(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    return kinds[0]


def _pure(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    if not _is_number(kinds[0]):
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} takes an angle or a pure number, not {_told(kinds[0])}"
        )
    return Kind(RADIAN) if operation.sign in ("asin", "acos", "atan") else Kind()


def _is_number(kind: Kind) -> bool:
    return bool(registry.get_dimensionality(kind.base) == registry.get_dimensionality(ONE))


def _told(kind: Kind) -> str:
    return f"{kind.base:~P}" or "a pure number"


OPERATORS = {
    "add": Operation("+", np.add, _sum),
    "subtract": Operation("-", np.subtract, _sum),
    "multiply": Operation("*", np.multiply, _product),
    "divide": Operation("/", np.divide, _product),
    "power": Operation("**", np.float_power, _power),
    "negative": Operation("-", np.negative, _sum),
}
FUNCTIONS = {
    operation.sign: operation
    for operation in (
        Operation("abs", np.abs, _keep, 1),
        Operation("sqrt", np.sqrt, _root, 1),
        Operation("min", lambda *a: reduce(np.minimum, a), _same),
        Operation("max", lambda *a: reduce(np.maximum, a), _same),
        Operation("sin", np.sin, _pure, 1),
        Operation("cos", np.cos, _pure, 1),
        Operation("tan", np.tan, _pure, 1),
        Operation("asin", np.arcsin, _pure, 1),
        Operation("acos", np.arccos, _pure, 1),
        Operation("atan", np.arctan, _pure, 1),
        Operation("exp", np.exp, _pure, 1),
        Operation("log", np.log, _pure, 1),
    )
}
CONSTANTS = {"pi": Constant(np.pi, Kind())}
