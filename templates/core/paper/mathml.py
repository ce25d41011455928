"""Print a formula from its code: LaTeX from the syntax tree, then MathML from the LaTeX.

Calls of physics functions are expanded if the function is a single expression, or printed by their declared
LaTeX.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from sys import getsizeof
from threading import Lock
from typing import Any

from cachetools import LRUCache, cached

from templates.core.language.body import Body
from templates.core.language.spec import Declaration, Formula
from templates.core.language.syntax import returned, syntax
from templates.core.language.template import Template
from templates.core.units.units import unit_symbol

SUM, PRODUCT, POWER, ATOM = range(4)
Written = tuple[str, int]  # LaTeX, and the precedence of its outermost operation

_GREEK = {
    "alpha", "beta", "gamma", "delta", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi", "pi",
    "rho", "sigma", "tau", "phi", "psi", "omega",
}  # fmt: skip
_OPERATOR = re.compile(
    r"\\operatorname\{([^{}]*)\}"
)  # which latex2mathml would set in italics, letter by letter
_NAMES = re.compile(r"(<mi>(?:lg|ln|exp|sin|cos|tan)</mi>)(?=<m(?!o[ >]))")  # except before a bracket
_KEPT = 16 * 2**20  # size of the cache of converted formulas [bytes]
_LESS, _MORE = "\ue000", "\ue001"  # private-use characters, which no formula contains
_SPECIAL = {"eps": r"\varepsilon"}
_FUNCTIONS = {"log10": r"\lg", "log": r"\ln", "exp": r"\exp", "sin": r"\sin", "cos": r"\cos", "tan": r"\tan"}


def symbol(declared: Declaration) -> str:
    r"""Return the printed symbol: the declared one, or one from the attribute, `\nu_{1}` for `nu_1`."""
    return declared.meaning.symbol or named_symbol(declared.attribute)


def named_symbol(attribute: str) -> str:
    r"""Return the symbol for a name: `nu_1` is `\nu_{1}`, and `width` an upright word."""
    head, _, index = attribute.partition("_")
    plain = head if len(head) == 1 else rf"\mathrm{{{head}}}"
    letter = _SPECIAL.get(head) or (f"\\{head}" if head in _GREEK else plain)
    if not index:
        return letter
    words = index.replace("_", r"\ ")
    subscript = index if len(index) == 1 else rf"\mathrm{{{words}}}"
    return f"{letter}_{{{subscript}}}"


def number(value: float) -> str:
    """Return a number with five significant digits, as LaTeX."""
    mantissa, _, exponent = f"{value:.5g}".partition("e")
    return rf"{mantissa}\,\cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def amount(value: float, unit: str) -> str:
    """Return a number with its unit, as LaTeX."""
    printed = unit_symbol(unit)
    shown = r"\%" if printed == "%" else rf"\text{{{printed}}}"  # in a text it would begin a comment
    return number(value) + (rf"\,{shown}" if printed else "")


def expression(formula: Formula[Any], symbols: Mapping[str, str], times: str = r"\,") -> str:
    """Return the right-hand side of a formula as LaTeX, with these symbols or numbers for its names."""
    if formula.latex is not None:
        return formula.latex
    if isinstance(formula.function, Body):
        return formula.function.latex(symbols, times)
    attributes = {name: (text, tightness(text)) for name, text in symbols.items()}
    return Writer(formula.function.__globals__, attributes, {}, times).write(formula.expression)[0]


def tightness(text: str) -> int:
    """Return the precedence of a symbol or of a number with its unit."""
    if text.startswith("-"):
        return SUM
    return PRODUCT if r"\," in text or "cdot" in text else ATOM


def symbols(cls: type[Template]) -> dict[str, str]:
    """Return the symbol of each declaration, by attribute."""
    return {attribute: symbol(declared) for attribute, declared in cls.declarations.items()}


@cached(LRUCache(_KEPT, getsizeof=getsizeof), lock=Lock())
def mathml(latex: str) -> str:
    """Return LaTeX as MathML for browsers; texts quoted from a user are escaped."""
    import latex2mathml.converter  # slow to import, and many commands print no formula

    # latex2mathml does not escape texts, so placeholders replace the angle brackets during conversion.
    upright = _OPERATOR.sub(_upright, latex)
    markup: str = latex2mathml.converter.convert(upright.replace("<", _LESS).replace(">", _MORE))
    for letter, entity in ((_LESS, "&lt;"), (_MORE, "&gt;")):
        markup = markup.replace(f"<mi>{letter}</mi>", f"<mo>{entity}</mo>").replace(letter, entity)
    return _NAMES.sub(r'\1<mspace width="0.167em" />', markup)


def _upright(operator: re.Match[str]) -> str:
    words = operator[1].replace(r"\ ", " ")
    return rf"\operatorname{{\text{{{words}}}}}"


class Writer:
    """Prints expressions; `attributes` replace `self.x`, `names` replace a physics function's arguments."""

    def __init__(
        self,
        scope: Mapping[str, Any],
        attributes: Mapping[str, Written],
        names: Mapping[str, Written],
        times: str,
    ) -> None:
        self.scope, self.attributes, self.names, self.times = scope, attributes, names, times

    def write(self, node: ast.expr) -> Written:
        """Return the LaTeX of a node.

        Raises
        ------
        TypeError
            For syntax that is not allowed in a formula.
        """
        match node:
            case ast.Constant(value=int() | float() as value):
                return (text := number(value)), tightness(text)
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                return self.attributes.get(name) or (named_symbol(name), ATOM)
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self")), attr=name):
                return named_symbol(name), ATOM
            case ast.Attribute(attr="pi") | ast.Name(id="pi"):
                return r"\pi", ATOM
            case ast.Name(id=name):
                return self.names.get(name) or self._constant(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return f"-{self._in(operand, PRODUCT)}", SUM
            case ast.BinOp():
                return self._operation(node)
            case ast.Call():
                return self._call(node)
        raise TypeError(f"{ast.unparse(node)!r} is not allowed in a formula; move it to a physics function")

    def _in(self, node: ast.expr, tightness: int) -> str:
        """Return the LaTeX of a node, in parentheses if it binds more loosely than its context requires."""
        text, own = self.write(node)
        return text if own >= tightness else rf"\left({text}\right)"

    def _operation(self, node: ast.BinOp) -> Written:
        match node.op:
            case ast.Div():
                return rf"\frac{{{self.write(node.left)[0]}}}{{{self.write(node.right)[0]}}}", PRODUCT
            case ast.Pow():
                return f"{self._in(node.left, ATOM)}^{{{self.write(node.right)[0]}}}", POWER
            case ast.Mult():
                left, right = self._in(node.left, PRODUCT), self._in(node.right, PRODUCT)
                times = r"\cdot " if right[0].isdigit() else self.times  # "2 3" reads as one number
                return f"{left}{times}{right}", PRODUCT
            case ast.Add():
                return f"{self._in(node.left, SUM)}+{self._in(node.right, SUM)}", SUM
            case ast.Sub():
                return f"{self._in(node.left, SUM)}-{self._in(node.right, PRODUCT)}", SUM
        raise TypeError(f"{ast.unparse(node)!r} is not allowed in a formula")

    def _call(self, node: ast.Call) -> Written:
        if any(keyword.arg != "axis" for keyword in node.keywords):
            raise TypeError(f"{ast.unparse(node)!r}: in a formula, give the arguments by position")
        name = node.func.attr if isinstance(node.func, ast.Attribute) else ast.unparse(node.func)
        if name in ("sqrt", "abs"):
            inside = self.write(node.args[0])[0]
            return (rf"\sqrt{{{inside}}}" if name == "sqrt" else rf"\left|{inside}\right|"), ATOM
        if name in _FUNCTIONS:
            return rf"{_FUNCTIONS[name]}\left({self.write(node.args[0])[0]}\right)", ATOM
        return self._physics(name, [self.write(argument) for argument in node.args])

    def _physics(self, name: str, arguments: list[Written]) -> Written:
        """Return the LaTeX of a physics function: as declared, as expanded, or as a call by its name."""
        function = self.scope.get(name)
        latex = getattr(function, "latex", None)
        if latex:
            return self._filled_in(latex, arguments), PRODUCT
        return (callable(function) and self._written_out(function, arguments)) or _named(name, arguments)

    def _filled_in(self, latex: str, arguments: list[Written]) -> str:
        """Return the declared LaTeX of a physics function with its arguments, in parentheses where needed."""
        shown = latex.replace(r"\,", self.times)
        for place, (_, tightness) in enumerate(arguments):
            mark, bracketed = f"{{{place}}}", rf"\left({{{place}}}\right)"
            if tightness < ATOM:
                shown = shown.replace(f"{mark}^", f"{bracketed}^")
            if tightness < PRODUCT:
                for before in {"-", "+", self.times}:
                    shown = shown.replace(before + mark, before + bracketed)
        return shown.format(*(text for text, _ in arguments))

    def _written_out(self, function: Callable[..., Any], arguments: list[Written]) -> Written | None:
        """Return the expression that a function returns, if it does nothing else and can be printed."""
        try:
            body, parameters = returned(function), syntax(function).args.args
            names = dict(zip((p.arg for p in parameters), arguments, strict=True))
            return Writer(function.__globals__, {}, names, self.times).write(body)
        except (TypeError, ValueError, OSError):
            return None

    def _constant(self, name: str) -> Written:
        value = self.scope.get(name)
        if isinstance(value, (int, float)) and math.isfinite(value):
            return (text := number(value)), tightness(text)
        return rf"\mathrm{{{name}}}", ATOM


def _named(name: str, arguments: list[Written]) -> Written:
    words = {"minimum": "min", "maximum": "max"}.get(name) or name.strip("_").replace("_", r"\ ")
    return rf"\operatorname{{{words}}}\left({', '.join(text for text, _ in arguments)}\right)", ATOM
