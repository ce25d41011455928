"""Translate Mathcad's trees into expressions of worksheets.

A vector of Mathcad becomes a list. A range variable becomes the list of its values, and an item with a range
variable as index becomes the list of these items. The message of a refused construct names it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from app.worksheets.imports.arithmetic import Arithmetic
from app.worksheets.imports.calls import Calls
from app.worksheets.imports.conditions import COMPARED, Conditions
from app.worksheets.imports.errors import Unnamed, Untranslatable
from app.worksheets.imports.lists import Lists
from app.worksheets.imports.names import key_of, look
from app.worksheets.imports.quantities import CONSTANTS, unit_named
from app.worksheets.imports.scope import Choice, FailedName, InlineTerm, Meant, Range, Value
from app.worksheets.imports.terms import POWER, Term, number
from app.worksheets.imports.trees import Node

REFUSED = {
    "integral": ("integral", "give its closed form, or a sum"),
    "derivative": ("derivative", "give its closed form"),
    "limit": ("limit", "give its closed form"),
    "crossProduct": ("matrix product", "write its components"),
    "determinant": ("determinant", "write it out"),
    "transpose": ("matrix", "write its items as lists"),
    "matcol": ("the formula uses a column of a matrix", "give the column as a separate list"),
    "matrow": ("the formula uses a row of a matrix", "give the row as a separate list"),
    "product": ("product over an index", "write it out, or as `exp(sum(log(x)))`"),
    "symEval": ("symbolic calculation", "write its result as a formula"),
    "for": ("loop", "write the formula for a list"),
    "while": ("loop", "write the formula for a list, or `solve`"),
    "tryCatch": ("try and catch", "state with if when there is a value"),
    "str": ("text", "use a choice, or a check"),
    "imag": ("complex number", "calculate with the real and imaginary parts"),
    "complex": ("complex number", "calculate with the real and imaginary parts"),
    "elementOf": ("membership of a set", "write a comparison"),
    "symResult": ("symbolic calculation", "write its result as a formula"),
}


class Expressions(Arithmetic, Lists, Calls, Conditions):
    """Writes expressions at one position of a sheet."""

    def term(self, node: Node) -> Term:
        """Return the expression of a tree.

        Raises
        ------
        Untranslatable
            If worksheets do not have the construct; the error names it.
        Unnamed
            If a name has no meaning here.
        """
        if node.tag in REFUSED:
            raise Untranslatable(*REFUSED[node.tag])
        if write := _WRITERS.get(node.tag):
            return write(self, node)
        if node.tag in ("parens", "eval", "apply") and node.parts:
            return self.applied(node) if node.tag == "apply" else self.term(node.parts[0])
        if node.tag.endswith("Control"):
            raise Untranslatable("the control runs a script", "give its value as an input")
        raise Untranslatable(f"construct {node.tag[:30]}", "write the formula by hand")

    def _real(self, node: Node) -> Term:
        try:
            value = float(node.text)
        except ValueError:
            raise Untranslatable("malformed number", "write the number") from None
        if not math.isfinite(value) or abs(value) >= 1e300:
            raise Untranslatable("infinity", "give a number")
        text = node.text.strip().lstrip("+")
        term = number(value)
        plain = text if text.replace(".", "", 1).isdigit() and len(text) < 25 else term.text
        return replace(term, text=plain)

    def named(self, node: Node) -> Term:
        """Return the term to which a name refers."""
        key, label = key_of(node), node.attributes.get("labels", "")
        if label == "UNIT":
            return self._unit(key)
        meant = self.scope.get(key)
        if meant is not None and label != "CONSTANT":
            return _meant(key, meant)
        if key in _WELL_KNOWN:
            return _WELL_KNOWN[key]
        if key == "∞":
            raise Untranslatable("infinity", "give a number")
        if label == "CONSTANT":
            return _constant(key)
        if key == "%":
            return self._unit(key)
        raise Unnamed(key)

    def _unit(self, key: str) -> Term:
        unit = unit_named(key)
        if unit is None:
            raise Untranslatable(f"unit {look(key)[:30]}", "write the quantity in another unit")
        return Term(f"{number(unit.number).text} {unit.unit}", POWER)

    def applied(self, node: Node) -> Term:
        """Return an operator or a function applied to its arguments."""
        operator, parts = node.parts[0], list(node.parts[1:])
        sign = operator.tag
        if sign in REFUSED and sign not in ("transpose", "determinant"):
            raise Untranslatable(*REFUSED[sign])
        if len(parts) == 2 and sign in _BINARY:
            return self.quantity(node) or _BINARY[sign](self, *parts)
        if len(parts) == 1 and sign in _UNARY:
            return self.quantity(node) or _UNARY[sign](self, *parts)
        if sign == "nthRoot" and parts:
            return self.root(parts[:-1], self.value(parts[-1]))
        if sign == "summation":
            return self.summed(parts)
        if sign == "id":
            return self.call(operator, self._arguments(parts))
        if sign in COMPARED or sign in ("and", "or", "not", "xor"):
            return self.condition(node)
        raise Untranslatable(f"operator {sign[:30]}", "write the formula by hand")

    def _arguments(self, parts: list[Node]) -> list[Node]:
        return list(parts[0].parts) if len(parts) == 1 and parts[0].tag == "sequence" else parts


def _meant(key: str, meant: Meant) -> Term:
    match meant:
        case Value() | Range():
            return meant.term()
        case InlineTerm(expression):
            return expression
        case FailedName(region):
            raise Unnamed(key, region)
        case Choice():
            raise Untranslatable("text", "test the choice, for example `law is walther`")
    raise Untranslatable("the formula uses a function as a value", "call the function with its arguments")


def _constant(key: str) -> Term:
    if key not in CONSTANTS:
        raise Unnamed(key)
    value, unit = CONSTANTS[key]
    return number(value) if unit == "1" else Term(f"{value!r} {unit}", POWER)


def _range(at: Expressions, node: Node) -> Term:
    raise Untranslatable("the formula contains a range", "define the range separately, above")


def _empty(at: Expressions, node: Node) -> Term:
    raise Untranslatable("empty place", "fill the placeholder in Mathcad, or write the line")


_WELL_KNOWN: Mapping[str, Term] = {"π": Term("pi", number=math.pi)}
_WRITERS: Mapping[str, Callable[[Expressions, Node], Term]] = {
    "real": Expressions._real,
    "id": Expressions.named,
    "matrix": Expressions.matrix,
    "program": lambda at, node: at.program(list(node.parts)),
    "if": lambda at, node: at.chain([node]),
    "range": _range,
    "placeholder": _empty,
}
_UNARY: Mapping[str, Callable[[Expressions, Node], Term]] = {
    "neg": Expressions.negative,
    "percent": Expressions.percent,
    "vectorize": Expressions.vectorized,
    "absval": lambda at, part: at.size(at.value(part)),
    "determinant": lambda at, part: at.size(at.value(part)),
    "transpose": lambda at, part: at.transposed(at.term(part)),
    "factorial": lambda at, part: at.factorial(at.value(part)),
}
_BINARY: Mapping[str, Callable[[Expressions, Node, Node], Term]] = {
    "scale": Expressions.times,
    "mult": Expressions.times,
    "div": Expressions.over,
    "plus": Expressions.plus,
    "minus": Expressions.minus,
    "pow": Expressions.power,
    "indexer": Expressions.item,
}
