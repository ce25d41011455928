"""Expressions of relations and worksheets: convert the parser's tree to a checked tree of our own nodes.

Both use the grammar of `relation.lark`. A worksheet knows the meaning of its names when it is read, and calls
`checked`; a relation of a design learns them later, and calls `built`. A scope may replace a name by an
expression: a parameter of a function becomes the argument of the call.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.resources import files
from typing import Any, Protocol

import lark
import numpy as np

from templates.core.errors import FaultyText, excerpt, unknown_name
from templates.core.units.conditions import COMPARISONS, IF, IS, LOGIC
from templates.core.units.evaluation import nodes_of
from templates.core.units.lists import ITEM, LIST, OVER_LISTS
from templates.core.units.nodes import kind_of
from templates.core.units.operations import (
    CONSTANTS,
    FUNCTIONS,
    OPERATORS,
    Apply,
    Constant,
    Item,
    Kind,
    Name,
    Operation,
    Word,
)
from templates.core.units.rules import as_compared
from templates.core.units.sorts import Part, Sort, applied
from templates.core.units.units import Unit, is_rate, unit

__all__ = ["GRAMMAR", "FaultyPlace", "Scope", "Sort", "applied", "built", "checked", "height"]

GRAMMAR = files(__package__).joinpath("relation.lark").read_text(encoding="utf-8")
"""The grammar; statements use its rule `expression`."""

MAX_INDEX = 10**9
MAX_TWICE = 1000
"""Most nodes of an expression between two signs of a chained comparison."""
RESERVED = frozenset({"if", "then", "else", "and", "or", "not", "is"})
"""Reserved words of the grammar; only `if` and `not` cannot be names in front of a value."""

_COMPARED = frozenset(COMPARISONS.values())
_OPERATIONS = {**OPERATORS, **LOGIC, "if": IF, "list": LIST}


class Scope(Protocol):
    """The names that an expression can use."""

    def name(self, text: str) -> Part:
        """Return the node of a name, and its sort.

        Raises
        ------
        FaultyText
            The code is `unknown_name`.
        """

    def function(self, name: str) -> Callable[[list[Part]], Part] | None:
        """Return the call of the user's function of that name as an expression; None if there is none."""

    def spend(self) -> None:
        """Count one operation against the limit.

        Raises
        ------
        FaultyText
            The code is `too_large`.
        """


class FaultyPlace(FaultyText):
    """A fault of an expression with its place: `meta` has `line`, `column` and `end_column`."""

    def __init__(self, error: FaultyText, meta: Any) -> None:
        super().__init__(error.code, str(error))
        self.meta = meta


def checked(tree: lark.Tree[Any], scope: Scope) -> Part:
    """Return a checked expression, and its sort.

    Raises
    ------
    FaultyPlace
        The code is `unknown_name`, `unknown_function`, `unknown_unit`, `unit_mismatch`, `no_truth`,
        `axis_mismatch`, `index`, `syntax`, `not_finite` or `too_large`.
    """
    return _CheckedBuilder(scope).part(tree)


def built(tree: lark.Tree[Any]) -> Any:
    """Return the tree of an expression whose names are not known yet.

    Every unit, function and number is checked.

    Raises
    ------
    FaultyText
        The code is `unknown_function`, `unknown_unit`, `syntax` or `not_finite`.
    """
    return _Builder().part(tree)[0]


def height(tree: lark.Tree[Any]) -> int:
    """Return the depth of a parser's tree, computed without recursion."""
    deep, level = 0, [tree]
    while level:
        deep += 1
        level = [child for node in level for child in node.children if isinstance(child, lark.Tree)]
    return deep


class _Builder:
    """Builds a tree whose names are checked later."""

    def part(self, tree: lark.Tree[Any]) -> Part:
        match str(tree.data), tree.children:
            case "quantity" | "number", [text]:
                return self.constant(str(text))
            case "negative", [lark.Tree(data="quantity" | "number", children=[text])]:
                return self.constant(f"-{text}")
            case "name", [text]:
                return self.constant_or_name(str(text))
            case "item", [whole, lark.Token() as index]:
                return self.item(whole, index)
            case "is", [name, word]:
                return self.choice(str(name), str(word).strip('"'))
            case "call", [called, *arguments]:
                return self.call(str(called)[:-1], self.parts(arguments))
            case "compare", [first, *rest]:
                return self.compared(self.parts([first, *rest[1::2]]), [str(sign) for sign in rest[::2]])
            case operator, arguments:
                return self.apply(_OPERATIONS[operator], self.parts(arguments))

    def parts(self, trees: Sequence[Any]) -> list[Part]:
        return list(map(self.part, trees))

    def constant(self, text: str) -> Part:
        one = constant(text)
        return one, Sort(one.kind)

    def constant_or_name(self, text: str) -> Part:
        return (CONSTANTS[text], Sort(CONSTANTS[text].kind)) if text in CONSTANTS else self.name(text)

    def name(self, text: str) -> Part:
        return Name(text), Sort()

    def item(self, whole: Any, index: lark.Token) -> Part:
        """Return an item of an array or of a literal list."""
        shown = excerpt(f"{whole if isinstance(whole, lark.Token) else 'the list'}[{index}]")
        if whole in CONSTANTS or index in CONSTANTS:
            raise FaultyText("syntax", f"{shown}: pi is neither an array nor an index")
        place = str(index) if index.type == "NAME" else _place(shown, float(index))
        if isinstance(whole, lark.Token):
            return self.named_item(str(whole), place)
        return self.apply(ITEM, [self.part(whole), self.index(place)])

    def index(self, place: int | str) -> Part:
        if isinstance(place, str):
            return self.name(place)
        return Constant(float(place), Kind(), str(place)), Sort()

    def named_item(self, name: str, index: int | str) -> Part:
        return Item(name, index), Sort()

    def choice(self, name: str, word: str) -> Part:
        return self.apply(IS, [(Name(name), Sort()), (Word(word), Sort())])

    def call(self, called: str, arguments: list[Part]) -> Part:
        first, second = (OVER_LISTS, FUNCTIONS) if len(arguments) == 1 else (FUNCTIONS, OVER_LISTS)
        operation = first.get(called) or second.get(called)
        if operation is None:
            names = ", ".join(dict.fromkeys([*FUNCTIONS, *OVER_LISTS]))
            raise FaultyText("unknown_function", f"{called[:60]} is not a function; use one of {names}")
        if operation.arity not in (None, len(arguments)):
            count = f"{operation.arity} value{'s' if operation.arity != 1 else ''}"
            raise FaultyText("syntax", f"{called} takes {count}, not {len(arguments)}")
        return self.apply(operation, arguments)

    def compared(self, sides: list[Part], signs: list[str]) -> Part:
        """Return a comparison; a chain of comparisons is true if all of them are true.

        Raises
        ------
        FaultyText
            If an expression between two signs, which is calculated twice, is too large (code `too_large`).
        """
        if any(_size(node) > MAX_TWICE for node, _ in sides[1:-1]):
            raise FaultyText("too_large", "chained comparisons are nested too deeply; join them by `and`")
        pairs = zip(signs, sides, sides[1:], strict=False)
        tests = [self.apply(COMPARISONS[sign], [one, other]) for sign, one, other in pairs]
        return tests[0] if len(tests) == 1 else self.apply(LOGIC["and"], tests)

    def apply(self, operation: Operation, parts: Sequence[Part]) -> Part:
        return Apply(operation, tuple(node for node, _ in parts)), Sort()


class _CheckedBuilder(_Builder):
    """Builds a tree whose names are known, and checks each node."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope

    def part(self, tree: lark.Tree[Any]) -> Part:
        try:
            self.scope.spend()
            return super().part(tree)
        except FaultyPlace:
            raise
        except FaultyText as error:
            raise FaultyPlace(error, tree.meta) from None

    def name(self, text: str) -> Part:
        return self.scope.name(text)

    def named_item(self, name: str, index: int | str) -> Part:
        return self.apply(ITEM, [self.name(name), self.index(index)])

    def choice(self, name: str, word: str) -> Part:
        node, sort = self.name(name)
        check_word(name, word, sort.words)
        return self.apply(IS, [(node, sort), (Word(word), Sort())])

    def call(self, called: str, arguments: list[Part]) -> Part:
        own = self.scope.function(called)
        return super().call(called, arguments) if own is None else own(arguments)

    def apply(self, operation: Operation, parts: Sequence[Part]) -> Part:
        return applied(operation, self.compared_alike(operation, *parts) if operation in _COMPARED else parts)

    def compared_alike(self, operation: Operation, one: Part, other: Part) -> list[Part]:
        """Return both sides of a comparison.

        A number in degC compared with a temperature difference is read as a difference.
        """
        meant = [
            as_compared(operation.sign, beside[1].kind, side[0], beside[0])
            for side, beside in ((one, other), (other, one))
        ]
        return [self.constant(text) if text else side for text, side in zip(meant, (one, other), strict=True)]


def check_word(name: str, word: str, options: Sequence[str]) -> None:
    """Raise an error if the test of a choice can never be true.

    Raises
    ------
    FaultyText
        If the name is not a choice (code `no_truth`), or the word is not one of its options (code
        `unknown_name`).
    """
    if not options:
        raise FaultyText("no_truth", f"{name[:60]} is not a choice; compare it with < <= > >= == or !=")
    if word not in options:
        raise FaultyText("unknown_name", unknown_name(word, options, f"option of {name[:60]}").detail)


def _size(node: Any) -> int:
    return sum(1 for _ in nodes_of(node))


def _place(shown: str, number: float) -> int:
    if not number.is_integer() or not 1 <= number <= MAX_INDEX:
        raise FaultyText(
            "syntax", f"{shown}: an index must be a whole number from 1 to the length of the list"
        )
    return int(number)


def constant(text: str) -> Constant:
    """Return a number, with its unit if it has one; the sign belongs to it, so -20 degC is a temperature.

    Raises
    ------
    FaultyText
        The code is `unknown_unit` or `not_finite`.
    """
    number, _, name = text.partition(" ")
    scale, value = _unit(name or "1"), float(number)
    kind = replace(kind_of(scale.text, text), literal=scale.absolute)
    if not name and value and value % 2 == 0:
        kind = replace(kind, twos=frozenset((1,)))
    elif scale.turns and kind.turned == {text} and not is_rate(scale.base):  # 1 turn is 2*pi rad, as written
        kind = replace(kind, pi=1, twos=frozenset((1,)), turned=frozenset())
    return Constant(_finite(float(scale.to_si(value))), kind, text)


def _unit(name: str) -> Unit:
    try:
        return unit(name)
    except FaultyText as error:
        hint = f"if {name[:60]} contains a name, put blanks around * and /"
        raise FaultyText("unknown_unit", f"{error} ({hint})") from None


def _finite(value: float) -> float:
    if not np.isfinite(value):
        raise FaultyText("not_finite", "a number in the expression is too large; give one below 1.8e308")
    return value
