"""Print an expression of a relation or worksheet: LaTeX from its tree."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from templates.core.errors import FaultyText
from templates.core.paper.mathml import (
    ATOM,
    POWER,
    PRODUCT,
    SUM,
    Written,
    named_symbol,
    tightness,
)
from templates.core.units.evaluation import depth_of
from templates.core.units.operations import Constant, Item, Name, Word
from templates.core.units.relation import is_relation, parse
from templates.core.units.units import unit_symbol

CONDITION = SUM - 1
DEEPEST_ON_PAPER = 8  # the typesetter supports little nesting
_NO_LATEX = str.maketrans("{}\\&", "()/+")  # characters in a text that LaTeX or markup would interpret
_TWO = {  # LaTeX, precedence, and the least precedence of both sides
    "+": ("{}+{}", SUM, SUM, SUM),
    "-": ("{}-{}", SUM, SUM, PRODUCT),
    "/": (r"\frac{{{}}}{{{}}}", PRODUCT, CONDITION, CONDITION),
    "**": ("{}^{{{}}}", POWER, ATOM, CONDITION),
    "<": ("{}<{}", CONDITION, SUM, SUM),
    ">": ("{}>{}", CONDITION, SUM, SUM),
    "<=": (r"{}\le {}", CONDITION, SUM, SUM),
    ">=": (r"{}\ge {}", CONDITION, SUM, SUM),
    "==": ("{}={}", CONDITION, SUM, SUM),
    "!=": (r"{}\ne {}", CONDITION, SUM, SUM),
    "item": ("{}_{{{}}}", ATOM, ATOM, CONDITION),
}
_CALLED = {
    "log": r"\ln", "log10": r"\lg", "exp": r"\exp", "sin": r"\sin", "cos": r"\cos", "tan": r"\tan",
    "sinh": r"\sinh", "cosh": r"\cosh", "tanh": r"\tanh", "asin": r"\arcsin", "acos": r"\arccos",
    "atan": r"\arctan", "min": r"\min", "max": r"\max", "sum": r"\sum",
}  # fmt: skip
_BRACKETS = {
    "sqrt": (r"\sqrt{", "}"),
    "abs": (r"\left|", r"\right|"),
    "floor": (r"\left\lfloor ", r"\right\rfloor "),
    "ceil": (r"\left\lceil ", r"\right\rceil "),
    "mean": (r"\overline{", "}"),
    "list": (r"\left[", r"\right]"),
}


def latex(node: Any, symbols: Mapping[str, str], times: str = r"\,", least: int = CONDITION) -> str:
    """Return the LaTeX of a tree, in parentheses if it binds more loosely than `least`.

    Parameters
    ----------
    node
        The tree.
    symbols
        The symbols of its names, or numbers; a name without a symbol is printed as it is.
    times
        The multiplication sign.
    """
    return _Writer(symbols, times).within(node, least)


def relation_latex(raw: object) -> str:
    """Return the LaTeX of a relation as typed.

    The result is empty for a single name, a list of relations, text that is not a relation, and a relation
    that is nested too deeply to be readable.
    """
    try:
        relation = parse(str(raw)) if is_relation(raw) else None
    except FaultyText:
        return ""
    if relation is None or relation.only_name or depth_of(relation.tree) > DEEPEST_ON_PAPER:
        return ""
    written = latex(relation.calculated.tree, {})
    rule = relation.rounding.words if relation.rounding else ""
    return rf"{written}\quad {_words(rule.translate(_NO_LATEX))}" if rule else written


class _Writer:
    def __init__(self, symbols: Mapping[str, str], times: str) -> None:
        self.symbols, self.times = symbols, times

    def within(self, node: Any, least: int = CONDITION) -> str:
        text, own = self.written(node)
        return text if own >= least else rf"\left({text}\right)"

    def written(self, node: Any) -> Written:
        match node:
            case Constant(text=text):
                return _constant(text)
            case Word(text=text):
                return _words(text.translate(_NO_LATEX)), ATOM
            case Name(name=name):
                shown = self.symbol(name)
                return shown, tightness(shown)
            case Item(name=name, index=index):
                place = self.symbol(index) if isinstance(index, str) else str(index)
                return _indexed(self.symbol(name), place), ATOM
        return self.operation(node.operation.sign, node.arguments)

    def symbol(self, name: str) -> str:
        """Return the symbol of a name; a value of a step has the step as its index."""
        return self.symbols.get(name) or _symbol(*name.rpartition(".")[::2])

    def operation(self, sign: str, parts: tuple[Any, ...]) -> Written:
        match sign, parts:
            case "trailing", [part]:
                return self.written(part)
            case "-", [part]:
                return f"-{self.within(part, PRODUCT)}", SUM
            case "not", [part]:
                return rf"\text{{not}}\ {self.within(part, ATOM)}", CONDITION
            case "*", [left, right]:
                return self.product(left, right)
            case (("and" | "or"), _):
                return rf"\ \text{{{sign}}}\ ".join(self.joined(part, sign) for part in parts), CONDITION
            case "if", [test, one, other]:
                return self.cases(test, one, other), PRODUCT
            case "is", [name, word]:
                return f"{self.within(name)}={self.within(word)}", CONDITION
        if sign in _TWO:
            pattern, own, left, right = _TWO[sign]
            return pattern.format(self.within(parts[0], left), self.within(parts[1], right)), own
        return self.called(sign, parts)

    def product(self, left: Any, right: Any) -> Written:
        one, other = self.within(left, PRODUCT), self.within(right, PRODUCT)
        times = r"\cdot " if other[0].isdigit() else self.times  # "2 3" reads as one number
        return f"{one}{times}{other}", PRODUCT

    def joined(self, part: Any, sign: str) -> str:
        """Return an operand of `and` or `or`, in parentheses if the two are mixed."""
        inner = part.operation.sign if hasattr(part, "operation") else ""
        return self.within(part, ATOM if inner in ("and", "or") and inner != sign else CONDITION)

    def cases(self, test: Any, one: Any, other: Any) -> str:
        rows = [(one, test)]
        while getattr(getattr(other, "operation", None), "sign", "") == "if":  # else if
            test, one, other = other.arguments
            rows.append((one, test))
        written = [rf"{self.within(value)} & \text{{if }} {self.within(when)}" for value, when in rows]
        written.append(rf"{self.within(other)} & \text{{otherwise}}")
        lines = r"\\ ".join(written)
        return rf"\begin{{cases}}{lines}\end{{cases}}"

    def called(self, sign: str, parts: tuple[Any, ...]) -> Written:
        inside = ", ".join(self.within(part) for part in parts)
        if sign in _BRACKETS:
            before, behind = _BRACKETS[sign]
            return f"{before}{inside}{behind}", ATOM
        name = _CALLED.get(sign) or self.symbols.get(sign) or rf"\operatorname{{{sign}}}"
        return rf"{name}\left({inside}\right)", ATOM


def _constant(text: str) -> Written:
    """Return the LaTeX of a constant as it was typed."""
    if not text:
        return r"\pi", ATOM
    number, _, unit = text.partition(" ")
    mantissa, _, exponent = number.lower().partition("e")
    shown = rf"{mantissa}\cdot 10^{{{int(exponent)}}}" if exponent else mantissa
    printed = unit_symbol(unit)
    own = SUM if number.startswith("-") else PRODUCT if unit or exponent else ATOM
    return (rf"{shown}~{_words(printed)}" if printed else shown), own


def _symbol(block: str, name: str) -> str:
    """Return the LaTeX of a name: a letter with its index, or words, then the block to which it belongs."""
    symbol = named_symbol(name)
    own = symbol if not symbol.startswith(r"\mathrm") else _roman(name)
    return _indexed(own, _roman(block))


def _indexed(symbol: str, index: str) -> str:
    """Return a symbol with a further index after its existing one."""
    if not index:
        return symbol
    return f"{symbol[:-1]},{index}}}" if symbol.endswith("}") and "_{" in symbol else f"{symbol}_{{{index}}}"


def _roman(name: str) -> str:
    return _words(name.replace("_", " "))


def _words(text: str) -> str:
    """Return the LaTeX of a text in upright letters, with its percent signs escaped."""
    return r"\%".join(rf"\text{{{part}}}" if part else "" for part in text.split("%"))
