"""Relations: `= scale * 48 mm`. Parsed to a checked tree, never evaluated as Python.

A relation ties a value of a design to others, as a cell of a spreadsheet does. A unit stands after a number
and one blank and has no blank itself; every other word is a name. Units are checked before anything runs:
lengths add to lengths, an exponent is a pure number, `degC` is a temperature with a zero of its own and may
not be added.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache, reduce
from importlib.resources import files
from typing import Any

import lark
import numpy as np
import pint

from templates.core.errors import FaultyText
from templates.core.quantity import Unit, Value, compatible, registry, unit

MAX_LENGTH, MAX_DEPTH, MAX_PARTS = 2000, 100, 400
ONE = registry.Unit("")
RADIAN = registry.Unit("radian")

_GRAMMAR = files(__package__).joinpath("relation.lark").read_text(encoding="utf-8")
_parser = lark.Lark(_GRAMMAR, parser="lalr")


@dataclass(frozen=True)
class Kind:
    """What a value is measured in: SI base units; `absolute` for a temperature such as 20 degC."""

    base: pint.Unit = ONE
    absolute: bool = False


@dataclass(frozen=True)
class Relation:
    """A parsed relation: its text, the names it uses, and its tree."""

    text: str
    names: frozenset[str]
    tree: Any

    def kind(self, kinds: Mapping[str, Kind]) -> Kind:
        """What the relation gives, from what its names are.

        Raises
        ------
        FaultyText
            With code `unit_mismatch`, where units do not go together.
        """
        return _kind(self.tree, kinds)

    def value(self, values: Mapping[str, Value]) -> Value:
        """The value in SI, from the SI values of its names; not finite where the arithmetic is not.

        Raises
        ------
        FaultyText
            With code `shape`, where arrays of different lengths meet.
        """
        try:
            with np.errstate(all="ignore"):
                return _value(self.tree, values)
        except ValueError:
            raise FaultyText("shape", f"{self.text!r} joins arrays of different lengths") from None


def is_relation(raw: Any) -> bool:
    """Whether a value is a relation: a text that begins with `=`."""
    return isinstance(raw, str) and raw.lstrip().startswith("=")


@lru_cache(maxsize=4096)
def parse(text: str) -> Relation:
    """Read a relation.

    Raises
    ------
    FaultyText
        With code `syntax` and the place, or `unknown_unit`, `unknown_function`.
    """
    body = text.strip().removeprefix("=")
    if len(body) > MAX_LENGTH:
        raise FaultyText("syntax", f"a relation has at most {MAX_LENGTH} characters")
    try:
        parsed = _parser.parse(body)
    except lark.exceptions.UnexpectedInput as error:
        raise FaultyText("syntax", _where(body, error)) from None
    if sum(1 for _ in parsed.iter_subtrees()) > MAX_PARTS or _height(parsed) > MAX_DEPTH:
        raise FaultyText("syntax", f"a relation has at most {MAX_PARTS} parts, {MAX_DEPTH} deep")
    names = frozenset(str(t.children[0]) for t in parsed.find_data("name"))
    return Relation(text.strip(), names - _CONSTANTS.keys(), _build(parsed))


def _height(tree: lark.Tree[Any]) -> int:
    height, level = 0, [tree]
    while level:
        height += 1
        level = [child for node in level for child in node.children if isinstance(child, lark.Tree)]
    return height


def _where(body: str, error: lark.exceptions.UnexpectedInput) -> str:
    place = getattr(error, "pos_in_stream", None)
    near = body[place : place + 20] if isinstance(place, int) and place >= 0 else ""
    hint = "write units as in 48 mm, names as in film.bearing_diameter, operators + - * / **"
    return f"not understood at {near!r}; {hint}" if near else f"the relation ends too early; {hint}"


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


_OPERATORS = {
    "add": Operation("+", np.add, _sum),
    "subtract": Operation("-", np.subtract, _sum),
    "multiply": Operation("*", np.multiply, _product),
    "divide": Operation("/", np.divide, _product),
    "power": Operation("**", np.float_power, _power),
    "negative": Operation("-", np.negative, _sum),
}
_FUNCTIONS = {
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
_CONSTANTS = {"pi": Constant(np.pi, Kind())}


def _build(node: Any) -> Any:
    """From the parser's tree to ours; every unit, function and number is checked here."""
    match node.data, node.children:
        case "quantity", [text]:
            number, _, name = str(text).partition(" ")
            scale = _unit(name)
            return Constant(_finite(float(scale.to_si(float(number)))), Kind(scale.base, scale.absolute))
        case "number", [text]:
            return Constant(_finite(float(text)), Kind())
        case "name", [text]:
            return _CONSTANTS.get(str(text)) or Name(str(text))
        case "call", [called, *arguments]:
            return _call(str(called)[:-1], tuple(map(_build, arguments)))
        case operator, arguments:
            return Apply(_OPERATORS[operator], tuple(map(_build, arguments)))


def _call(called: str, arguments: tuple[Any, ...]) -> Apply:
    operation = _FUNCTIONS.get(called)
    if operation is None:
        raise FaultyText("unknown_function", f"{called} is no function; there are {', '.join(_FUNCTIONS)}")
    if operation.arity not in (None, len(arguments)):
        raise FaultyText("syntax", f"{called} takes {operation.arity} value, not {len(arguments)}")
    return Apply(operation, arguments)


def _unit(name: str) -> Unit:
    try:
        return unit(name)
    except FaultyText as error:
        hint = f"if {name} holds a name, put blanks around * and /"
        raise FaultyText("unknown_unit", f"{error} ({hint})") from None


def _finite(value: float) -> float:
    if not np.isfinite(value):
        raise FaultyText("not_finite", "a number in the relation is too large")
    return value


def _kind(node: Any, kinds: Mapping[str, Kind]) -> Kind:
    match node:
        case Constant(kind=kind):
            return kind
        case Name(name=name):
            return kinds[name]
    parts = [_kind(argument, kinds) for argument in node.arguments]
    return node.operation.kind(node.operation, parts, node.arguments)


def _value(node: Any, values: Mapping[str, Value]) -> Value:
    match node:
        case Constant(value=value):
            return value
        case Name(name=name):
            return values[name]
    return node.operation.calculate(*(_value(argument, values) for argument in node.arguments))
