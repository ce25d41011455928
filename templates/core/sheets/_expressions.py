"""Expressions until those of `templates.core.units` are there."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import reduce
from importlib.resources import files
from typing import Any, Protocol

import lark
import numpy as np

from templates.core.errors import FaultyText, excerpt
from templates.core.units import operations
from templates.core.units.operations import (
    CONSTANTS,
    FUNCTIONS,
    OPERATORS,
    Apply,
    Constant,
    Kind,
    Name,
    Operation,
)
from templates.core.units.relation import _constant

NO_UNITS = "then|else|and|or|is|to|so|that|over|from|within|gives|with"
_TRUTH = r"""
?truth: "if" truth "then" truth "else" truth -> if | either
?either: both | either "or" both -> or
?both: compared | both "and" compared -> and
?compared: sum | sum (COMPARE sum)+ -> compare
COMPARE: "<=" | ">=" | "==" | "!=" | "<" | ">"
"""
_EXTENSIONS = {
    "?start: sum\n": _TRUTH, 'CALL sum ("," sum)*': 'CALL truth ("," truth)*', '"(" sum ")"': '"(" truth ")"',
    "{1,4})? (1": rf"{{1,4}})? (?!(?:{NO_UNITS})\b)(1",
}  # fmt: skip
GRAMMAR = reduce(
    lambda text, new: text.replace(*new),
    _EXTENSIONS.items(),
    files(operations.__package__).joinpath("relation.lark").read_text("utf-8"),
)


class Scope(Protocol):
    def name(self, text: str) -> tuple[Any, Sort]: ...
    def function(self, name: str) -> Callable[[list[tuple[Any, Sort]]], tuple[Any, Sort]] | None: ...
    def spend(self) -> None: ...


@dataclass(frozen=True)
class Typed(Constant):
    text: str = ""


@dataclass(frozen=True)
class Sort:
    kind: Kind = field(default_factory=Kind)
    weight: float | None = 0.0
    truth: bool = False
    axis: str = ""
    words: tuple[str, ...] = ()


ARITHMETIC = {
    "add": operator.add, "subtract": operator.sub, "multiply": operator.mul, "divide": operator.truediv,
    "power": operator.pow,
}  # fmt: skip
PYTHONS = {
    name: Operation(op.sign, ARITHMETIC.get(name, op.calculate), op.kind) for name, op in OPERATORS.items()
}
COMPARE = {
    sign: Operation(sign, getattr(operator, name), operations._same)
    for sign, name in zip(("<", "<=", ">", ">=", "==", "!="), "lt le gt ge eq ne".split(), strict=True)
}
LOGIC = {w: Operation(w, f, operations._keep) for w, f in (("and", np.logical_and), ("or", np.logical_or))}
IF = Operation(
    "if",
    lambda test, a, b: np.where(test, a, b) if test.ndim else a if test else b,
    lambda op, k, trees: operations._same(op, k[1:], trees),
)
CALLED = {**FUNCTIONS, "log10": Operation("log10", np.log10, operations._pure, 1)}
PAPER: dict[str, tuple[str, int, tuple[int, ...]]] = {
    "+": ("%s+%s", 0, (0, 0)), "-": ("%s-%s", 0, (0, 1)), "*": (r"%s\,%s", 1, (1, 1)),
    "/": (r"\frac{%s}{%s}", 1, (0, 0)),
    "**": ("%s^{%s}", 2, (3, 0)), "sqrt": (r"\sqrt{%s}", 3, (0,)),
    "log10": (r"\lg\left(%s\right)", 3, (0,)),
    "<=": (r"%s\le %s", 0, (0, 0)), ">=": (r"%s\ge %s", 0, (0, 0)), "!=": (r"%s\ne %s", 0, (0, 0)),
    "==": ("%s=%s", 0, (0, 0)),
    "and": (r"%s\ \text{and}\ %s", 0, (0, 0)), "or": (r"%s\ \text{or}\ %s", 0, (0, 0)),
    "if": (r"\begin{cases}%s & %s\\ %s & \text{otherwise}\end{cases}", 1, (0, 0, 0)),
    "<": ("%s<%s", 0, (0, 0)), ">": ("%s>%s", 0, (0, 0)),
}  # fmt: skip


def closure(node: Any) -> Callable[[Any], Any]:
    match node:
        case Constant(value=value):
            constant = np.float64(value)
            return lambda template: constant
        case Name(name=name):
            return operator.attrgetter(name)
    calculate, parts = node.operation.calculate, [closure(part) for part in node.arguments]
    if len(parts) == 2:
        left, right = parts
        return lambda template: calculate(left(template), right(template))
    return lambda template: calculate(*[part(template) for part in parts])


def latex(node: Any, symbols: Mapping[str, str], times: str = r"\,", least: int = 0) -> str:
    text, own = _latex(node, symbols, times)
    return text if own >= least else rf"\left({text}\right)"


def _latex(node: Any, symbols: Mapping[str, str], times: str) -> tuple[str, int]:
    match node:
        case Typed(text=text):
            value, _, name = text.partition(" ")
            return (value if not name else rf"{value}~\text{{{name}}}"), 1 if name else 3
        case Constant():
            return r"\pi", 3
        case Name(name=name):
            shown = symbols.get(name, name)
            return shown, 0 if shown.startswith("-") else 1 if r"\," in shown or "cdot" in shown else 3
    sign, parts = node.operation.sign, node.arguments
    if sign not in PAPER or (len(parts) == 1 and sign == "-"):
        told = ", ".join(latex(part, symbols, times) for part in parts)
        if sign == "-":
            return f"-{latex(parts[0], symbols, times, 1)}", 0
        return rf"\operatorname{{{sign}}}\left({told}\right)", 3
    pattern, own, least = PAPER[sign]
    texts = [latex(part, symbols, times, tight) for part, tight in zip(parts, least, strict=True)]
    if sign == "if":
        texts[:2] = texts[1::-1]
    return pattern.replace(r"\,", times) % tuple(texts), own


def checked(tree: Any, scope: Scope) -> tuple[Any, Sort]:
    scope.spend()
    try:
        return _node(tree, scope)
    except FaultyText as error:
        if not hasattr(error, "meta"):
            error.meta = tree.meta  # type: ignore[attr-defined]
        raise


def _node(tree: Any, scope: Scope) -> tuple[Any, Sort]:
    match tree.data, tree.children:
        case ("quantity" | "number", [text]) | (
            "negative",
            [lark.Tree(data="quantity" | "number", children=[text])],
        ):
            made = _constant(text := f"-{text}" if tree.data == "negative" else str(text))
            kind = Kind(made.kind.base)
            return Typed(made.value, kind, text), Sort(kind, float(made.kind.absolute))
        case "name", [name] if name in CONSTANTS:
            return CONSTANTS[name], Sort()
        case "name", [name]:
            return scope.name(str(name))
        case "call", [called, *rest]:
            return _call(scope, str(called)[:-1], [checked(part, scope) for part in rest])
        case "item", _:
            raise FaultyText("index", "not yet")
        case "compare", [first, *rest]:
            sides = [checked(first, scope), *(checked(part, scope) for part in rest[1::2])]
            pairs = [apply(COMPARE[o], [a, b]) for o, a, b in zip(rest[::2], sides, sides[1:], strict=False)]
            return reduce(lambda a, b: apply(LOGIC["and"], [a, b]), pairs)
    op = LOGIC.get(tree.data) or (IF if tree.data == "if" else PYTHONS[tree.data])
    return apply(op, [checked(part, scope) for part in tree.children])


def _call(scope: Scope, called: str, parts: list[tuple[Any, Sort]]) -> tuple[Any, Sort]:
    own = scope.function(called)
    if own is not None:
        return own(parts)
    if called not in CALLED or CALLED[called].arity not in (None, len(parts)):
        raise FaultyText("unknown_function", f"{excerpt(called)} is no function of {len(parts)} value(s)")
    return apply(CALLED[called], parts)


def apply(op: Operation, parts: list[tuple[Any, Sort]]) -> tuple[Any, Sort]:
    trees = tuple(tree for tree, _ in parts)
    wanted = [op.sign in LOGIC or (op is IF and place == 0) for place in range(len(parts))]
    if [sort.truth for _, sort in parts] != wanted:
        raise FaultyText("no_truth", f"{op.sign} mixes conditions and quantities")
    kind = op.kind(op, [sort.kind for _, sort in parts], trees)
    truth = op.sign in COMPARE or op.sign in LOGIC
    return Apply(op, trees), Sort(Kind(kind.base), _weight(op.sign, parts), truth)


def _weight(sign: str, parts: list[tuple[Any, Sort]]) -> float | None:
    (_, first), (other, second) = parts[0], parts[-1]
    if len(parts) == 2 and sign in "+-" and first.weight is not None and second.weight is not None:
        return first.weight + (second.weight if sign == "+" else -second.weight)
    if len(parts) == 2 and sign in ("*", "/") and isinstance(other, Constant) and first.weight is not None:
        return first.weight * other.value if sign == "*" else first.weight / (other.value or np.inf)
    weights = {sort.weight for _, sort in parts[sign == "if" :]}
    return weights.pop() if sign in ("if", "min", "max") and len(weights) == 1 else 0.0
