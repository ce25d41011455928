"""Relations: `= scale * 48 mm`. Parsed to a checked tree, never evaluated as Python.

A relation ties a value of a design to others, as a cell of a spreadsheet does. A unit stands after a number
and one blank and has no blank itself; every other word is a name. Units are checked before anything runs:
lengths add to lengths, an exponent is a pure number, `degC` is a temperature with a zero of its own and may
not be added. `loads.main_load_x[2]` is the second item of an array along its first axis, so that of several
curves it is one curve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib.resources import files
from typing import Any

import lark
import numpy as np

from templates.core.errors import FaultyText, excerpt
from templates.core.units.items import check_index, item_of
from templates.core.units.operations import (
    CONSTANTS,
    FUNCTIONS,
    OPERATORS,
    Apply,
    Constant,
    Item,
    Kind,
    Name,
)
from templates.core.units.units import Unit, Value, forget_units, unit

__all__ = ["Kind", "Relation", "is_relation", "parse"]

MAX_LENGTH, MAX_DEPTH, MAX_PARTS = 2000, 100, 400
MAX_INDEX = 10**9
REMEMBERED = 1024  # trees of up to 50 kB

_GRAMMAR = files(__package__).joinpath("relation.lark").read_text(encoding="utf-8")
_parser = lark.Lark(_GRAMMAR, parser="lalr")


@dataclass(frozen=True)
class Relation:
    """A parsed relation: its text, the names it uses, and its tree."""

    text: str
    names: frozenset[str]
    tree: Any
    parts: int = 1
    items: tuple[Item, ...] = ()

    @cached_property
    def whole_names(self) -> frozenset[str]:
        """The names whose values are used whole, not an item of them."""
        inside = {name for item in self.items for name in (item.name, item.index)}
        return self.names if not inside else frozenset(_whole(self.tree))

    @cached_property
    def only_name(self) -> str | None:
        """The name, where the relation is nothing but a name."""
        return self.tree.name if isinstance(self.tree, Name) else None

    def kind(self, kinds: Mapping[str, Kind]) -> Kind:
        """What the relation gives, from what its names are.

        Raises
        ------
        FaultyText
            With code `unit_mismatch`, where units do not go together.
        """
        return _checked(self.text, tuple((name, kinds[name]) for name in sorted(self.names)))

    def value(self, values: Mapping[str, Value]) -> Value:
        """The value in SI, from the SI values of its names; not finite where the arithmetic is not.

        Items that are known already stand among the values, by their text: `loads.main_load_x[2]`.

        Raises
        ------
        FaultyText
            With code `shape`, where arrays of different lengths meet; `index`, where an index is no place of
            its array.
        """
        if self.only_name:
            return values[self.only_name]
        known = self._with_items(values) if self.items else values
        try:
            with np.errstate(all="ignore"):
                return _value(self.tree, known)
        except ValueError:
            raise FaultyText("shape", f"{self.text!r} joins arrays of different lengths") from None

    def _with_items(self, values: Mapping[str, Value]) -> Mapping[str, Value]:
        """The values, and those of items of arrays by their text."""
        chosen = {item.text: item_of(item, values) for item in self.items if item.text not in values}
        return {**values, **chosen}


def is_relation(raw: Any) -> bool:
    """Whether a value is a relation: a text that begins with `=`."""
    return isinstance(raw, str) and raw.lstrip().startswith("=")


@lru_cache(maxsize=REMEMBERED)
def parse(text: str) -> Relation:
    """Read a relation.

    Raises
    ------
    FaultyText
        With code `syntax` and the place, or `unknown_unit`, `unknown_function`.
    """
    if len(text) > MAX_LENGTH:
        raise FaultyText("syntax", f"a relation has at most {MAX_LENGTH} characters")
    body = text.strip().removeprefix("=")
    try:
        parsed = _parser.parse(body)
    except lark.exceptions.UnexpectedInput as error:
        raise FaultyText("syntax", _where(body, error)) from None
    parts = sum(1 for _ in parsed.iter_subtrees())
    if parts > MAX_PARTS or _height(parsed) > MAX_DEPTH:
        raise FaultyText("syntax", f"a relation has at most {MAX_PARTS} parts, {MAX_DEPTH} deep")
    names = frozenset(str(t.children[0]) for t in parsed.find_data("name"))
    items = tuple(dict.fromkeys(_build(t) for t in parsed.find_data("item")))
    names |= {name for item in items for name in (item.name, item.index) if isinstance(name, str)}
    return Relation(text.strip(), names - CONSTANTS.keys(), _build(parsed), parts, items)


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
    return f"not understood at {excerpt(near)}; {hint}" if near else f"the relation ends too early; {hint}"


def _build(node: Any) -> Any:
    """From the parser's tree to ours; every unit, function and number is checked here."""
    match node.data, node.children:
        case "quantity" | "number", [text]:
            return _constant(str(text))
        case "negative", [lark.Tree(data="quantity" | "number", children=[text])]:
            return _constant(f"-{text}")
        case "name", [text]:
            return CONSTANTS.get(str(text)) or Name(str(text))
        case "item", [name, index]:
            return _item(name, index)
        case "call", [called, *arguments]:
            return _call(str(called)[:-1], tuple(map(_build, arguments)))
        case operator, arguments:
            return Apply(OPERATORS[operator], tuple(map(_build, arguments)))


def _item(name: lark.Token, index: lark.Token) -> Item:
    """An item of an array.

    Raises
    ------
    FaultyText
        With code `syntax`, if its index is neither a whole number from 1 nor a name.
    """
    if name in CONSTANTS or index in CONSTANTS:
        raise FaultyText("syntax", f"{excerpt(f'{name}[{index}]')}: pi is no array, and no index")
    if index.type == "NAME":
        return Item(str(name), str(index))
    number = float(index)
    if not number.is_integer() or not 1 <= number <= MAX_INDEX:
        hint = f"an index is a whole number from 1 to the length of {str(name)[:60]}"
        raise FaultyText("syntax", f"{excerpt(f'{name}[{index}]')}: {hint}")
    return Item(str(name), int(number))


def _constant(text: str) -> Constant:
    """A number, or a number and its unit; its sign belongs to it, so that -20 degC is a temperature."""
    number, _, name = text.partition(" ")
    scale = _unit(name or "1")
    return Constant(_finite(float(scale.to_si(float(number)))), Kind(scale.base, scale.absolute))


def _call(called: str, arguments: tuple[Any, ...]) -> Apply:
    operation = FUNCTIONS.get(called)
    if operation is None:
        message = f"{called[:60]} is no function; there are {', '.join(FUNCTIONS)}"
        raise FaultyText("unknown_function", message)
    if operation.arity not in (None, len(arguments)):
        raise FaultyText("syntax", f"{called} takes {operation.arity} value, not {len(arguments)}")
    return Apply(operation, arguments)


def _unit(name: str) -> Unit:
    try:
        return unit(name)
    except FaultyText as error:
        hint = f"if {name[:60]} holds a name, put blanks around * and /"
        raise FaultyText("unknown_unit", f"{error} ({hint})") from None


def _finite(value: float) -> float:
    if not np.isfinite(value):
        raise FaultyText("not_finite", "a number in the relation is too large")
    return value


@lru_cache(maxsize=REMEMBERED)
def _checked(text: str, kinds: tuple[tuple[str, Kind], ...]) -> Kind:
    """The kind of a relation, from those of its names; raises as `Relation.kind`."""
    forget_units()
    return _kind(parse(text).tree, dict(kinds))


def _whole(node: Any) -> Iterator[str]:
    """The names of a tree that are no part of an item."""
    if isinstance(node, Name):
        yield node.name
    for argument in getattr(node, "arguments", ()):
        yield from _whole(argument)


def _kind(node: Any, kinds: Mapping[str, Kind]) -> Kind:
    match node:
        case Constant(kind=kind):
            return kind
        case Name(name=name):
            return kinds[name]
        case Item(name=name):
            check_index(node, kinds)
            return kinds[name]
    parts = [_kind(argument, kinds) for argument in node.arguments]
    return node.operation.kind(node.operation, parts, node.arguments)


def _value(node: Any, values: Mapping[str, Value]) -> Value:
    match node:
        case Constant(value=value):
            return value
        case Name(name=name):
            return values[name]
        case Item():
            return values[node.text]
    return node.operation.calculate(*(_value(argument, values) for argument in node.arguments))
