"""Mathcad's trees as expressions of worksheets.

A vector of Mathcad is a list; a product of two vectors is their scalar product unless it is vectorised. A range
variable stands for its values, one by one, and so does what it indexes. What worksheets do not have is refused
by its name.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from app.worksheets.importing import functions
from app.worksheets.importing.errors import Unnamed, Untranslatable
from app.worksheets.importing.names import key_of, look
from app.worksheets.importing.quantities import CONSTANTS, scaled, unit_named
from app.worksheets.importing.said import (
    ATOM,
    LOOSE,
    POWER,
    PRODUCT,
    SUM,
    Axis,
    Said,
    binary,
    called,
    listed,
    negative,
    number,
    power,
    reduced,
)
from app.worksheets.importing.scope import Choice, Failed, Function, Range, Scope, Value, Written
from app.worksheets.importing.trees import Node

COMPARED = {"lessThan": "<", "lessOrEqual": "<=", "greaterThan": ">", "greaterOrEqual": ">=",
            "equal": "==", "notEqual": "!="}  # fmt: skip
REFUSED = {
    "integral": ("integral", "give its closed form, or a sum"),
    "derivative": ("derivative", "give its closed form"),
    "limit": ("limit", "give its closed form"),
    "crossProduct": ("matrix product", "write its components"),
    "determinant": ("determinant", "write it out"),
    "transpose": ("matrix", "write its items as lists"),
    "matcol": ("column of a matrix", "give the column as a list of its own"),
    "matrow": ("row of a matrix", "give the row as a list of its own"),
    "product": ("product over an index", "write it out, or as exp(sum(log(x)))"),
    "symEval": ("symbolic calculation", "write its result as a formula"),
    "for": ("loop", "write the formula for a list"),
    "while": ("loop", "write the formula for a list, or solve"),
    "tryCatch": ("try and catch", "say with if when there is a value"),
    "str": ("text", "use a choice, or a check"),
    "imag": ("complex number", "calculate with real and imaginary part"),
    "complex": ("complex number", "calculate with real and imaginary part"),
    "elementOf": ("membership of a set", "write a comparison"),
    "symResult": ("symbolic calculation", "write its result as a formula"),
}
MOST_INLINED = 12
"""Functions within functions that are written out."""
MOST_ITEMS = 300


class Sheets(Protocol):
    """What an expression asks of the sheet that is being written."""

    origin: int
    is_labelled: bool

    def function(self, function: Function, arguments: Sequence[Said]) -> str | None:
        """The name of a function's statement for these arguments; None where it must be written out."""

    def curve(self, across: Said, up: Said) -> str:
        """The name of a curve through points."""

    def axis(self, length: int) -> Axis:
        """The axis of the vectors of a length."""


@dataclass
class Expressions:
    """Writes expressions at one place of a sheet."""

    sheet: Sheets
    scope: Scope
    is_vectorised: bool = False
    depth: int = 0
    keep: Callable[[Said], Said] | None = None

    def within(self, scope: Scope, *, is_vectorised: bool | None = None, depth: int = 0) -> Expressions:
        """The same with other meanings of names."""
        vectorised = self.is_vectorised if is_vectorised is None else is_vectorised
        return Expressions(self.sheet, scope, vectorised, self.depth + depth, self.keep)

    def said(self, node: Node) -> Said:
        """The expression of a tree.

        Raises
        ------
        Untranslatable
            With the name of the construct that worksheets do not have.
        Unnamed
            A name has no meaning here.
        """
        if node.tag in REFUSED:
            raise Untranslatable(*REFUSED[node.tag])
        match node.tag:
            case "real":
                return self._real(node)
            case "id":
                return self.named(node)
            case "parens" | "eval" if node.parts:
                return self.said(node.parts[0])
            case "apply" if node.parts:
                return self._applied(node, node.parts[0], node.parts[1:])
            case "matrix":
                return self._matrix(node)
            case "program":
                return self._program(list(node.parts))
            case "if":
                return self._chain([node])
            case "range":
                raise Untranslatable("range within a formula", "define the range by itself, above")
            case "placeholder":
                raise Untranslatable("empty place", "fill it in Mathcad, or write the line")
        if node.tag.endswith("Control"):
            raise Untranslatable("control with a script", "give its value as an input")
        raise Untranslatable(f"construct {node.tag[:30]}", "write the formula by hand")

    def quantity(self, node: Node) -> Said | None:
        """A tree of numbers and units alone as one quantity."""
        made = scaled(node)
        if made is None or not made.powers:
            return None
        unit = made.unit
        sign = number(made.number)
        return Said(sign.text if unit == "1" else f"{sign.text} {unit}", min(sign.tight, POWER))

    def _real(self, node: Node) -> Said:
        try:
            value = float(node.text)
        except ValueError:
            raise Untranslatable("number that is none", "write the number") from None
        if not math.isfinite(value) or abs(value) >= 1e300:
            raise Untranslatable("infinity", "give a number")
        text = node.text.strip().lstrip("+")
        made = number(value)
        plain = text if text.replace(".", "", 1).isdigit() and len(text) < 25 else made.text
        return replace(made, text=plain)

    def named(self, node: Node) -> Said:
        """What a name stands for."""
        key, label = key_of(node), node.attributes.get("labels", "")
        if label == "UNIT":
            return self._unit(key)
        meant = self.scope.get(key)
        if meant is not None and label != "CONSTANT":
            match meant:
                case Value() | Range():
                    return meant.said()
                case Written(expression):
                    return expression
                case Failed(region):
                    raise Unnamed(key, region)
                case Choice():
                    raise Untranslatable("text", "test the choice, as in law is walther")
                case Function():
                    raise Untranslatable("function as a value", "call it with its arguments")
        if key == "π":
            return Said("pi", number=math.pi)
        if key == "∞":
            raise Untranslatable("infinity", "give a number")
        if key == "e" and label in ("CONSTANT", "") and not (label == "" and self.sheet.is_labelled):
            return number(math.e)
        if label == "CONSTANT" and key in CONSTANTS:
            value, unit = CONSTANTS[key]
            return number(value) if unit == "1" else Said(f"{value!r} {unit}", POWER)
        if key == "%" or (label in ("", "*", "None") and key and unit_named(key)):
            return self._unit(key)
        raise Unnamed(key)

    def _unit(self, key: str) -> Said:
        made = unit_named(key)
        if made is None:
            raise Untranslatable(f"unit {look(key)[:30]}", "write the quantity in another unit")
        return Said(f"{number(made.number).text} {made.unit}", POWER)

    def _matrix(self, node: Node) -> Said:
        parts = [part for part in node.parts if part.tag != "display"]
        rows, columns = node.attributes.get("rows"), node.attributes.get("cols")
        if "1" not in (rows, columns) or not parts:
            raise Untranslatable("matrix", "write its rows or columns as lists")
        if len(parts) == 1:
            return self.said(parts[0])
        if len(parts) > MOST_ITEMS:
            raise Untranslatable(f"list of more than {MOST_ITEMS} items", "give it as an input over an axis")
        items = tuple(self.quantity(part) or self.said(part) for part in parts)
        if any(item.axis for item in items):
            raise Untranslatable("list of lists", "write each as a list of its own")
        made = listed(items, self.sheet.axis(len(items)))
        made = replace(made, is_row=columns != "1")
        return made if self.keep is None else self.keep(made)

    def _applied(self, node: Node, operator: Node, parts: list[Node]) -> Said:
        if operator.tag in REFUSED and operator.tag not in ("transpose", "determinant"):
            raise Untranslatable(*REFUSED[operator.tag])
        match operator.tag, parts:
            case "scale" | "mult", [left, right]:
                return self.quantity(node) or self.product(self.said(left), self.said(right))
            case "div", [left, right]:
                return self.quantity(node) or self.quotient(self.said(left), self.said(right))
            case "plus" | "minus", [left, right]:
                sign = "+" if operator.tag == "plus" else "-"
                return binary(self.value(left), sign, self.value(right), SUM)
            case "neg", [part]:
                return self.quantity(node) or negative(self.value(part))
            case "pow", [base, exponent]:
                return self.quantity(node) or self._power(base, exponent)
            case "nthRoot", [*degree, part]:
                return self._root(degree, self.value(part))
            case "absval" | "determinant", [part]:
                return self._size(self.value(part))
            case "percent", [part]:
                return binary(self.value(part), "/", number(100), PRODUCT)
            case "vectorize", [part]:
                return self.within(self.scope, is_vectorised=True).said(part)
            case "transpose", [part]:
                return self._transposed(self.said(part))
            case "indexer", [whole, index]:
                return self._item(whole, index)
            case "summation", [*_]:
                return self._sum(parts)
            case "factorial", [part]:
                return self._factorial(self.value(part))
            case "id", _:
                return self._call(operator, self._arguments(parts))
        if operator.tag in COMPARED or operator.tag in ("and", "or", "not", "xor"):
            return self.condition(node)
        raise Untranslatable(f"operator {operator.tag[:30]}", "write the formula by hand")

    def _arguments(self, parts: list[Node]) -> list[Node]:
        return list(parts[0].parts) if len(parts) == 1 and parts[0].tag == "sequence" else parts

    def value(self, node: Node) -> Said:
        """A quantity; a condition counts 1 where it holds and 0 where not."""
        made = self.said(node)
        if not made.is_truth:
            return made
        return Said(f"if {made.text} then 1 else 0", LOOSE).shaped(made)

    def product(self, left: Said, right: Said) -> Said:
        """A product, which of two vectors is their scalar product."""
        made = binary(left, "*", right, PRODUCT)
        if left.is_vector and right.is_vector and not self.is_vectorised:
            if left.is_row == right.is_row and left.is_row:
                raise Untranslatable("matrix product", "write it as a sum of products")
            if right.is_row and not left.is_row:
                raise Untranslatable("matrix product", "write it as a sum of products")
            return reduced("sum", made)
        return made

    def quotient(self, left: Said, right: Said) -> Said:
        """A quotient."""
        if right.is_vector and not self.is_vectorised:
            raise Untranslatable("division by a vector", "vectorise it, or write it item by item")
        return binary(left, "/", right, PRODUCT)

    def _power(self, base: Node, exponent: Node) -> Said:
        over = self.value(exponent)
        if base.tag == "id" and key_of(base) == "e" and "e" not in self.scope:
            return called("exp", over)
        under = self.value(base)
        if under.is_vector and not self.is_vectorised:
            if over.number != 2:
                raise Untranslatable("power of a vector", "vectorise it, or write it item by item")
            return reduced("sum", power(under, over))
        if over.number is not None and not _is_plain(over.text):
            over = _fraction(exponent) or number(over.number)
        return power(under, over)

    def _root(self, degree: list[Node], part: Said) -> Said:
        if part.is_vector and not self.is_vectorised:
            raise Untranslatable("root of a vector", "vectorise it, or write it item by item")
        if not degree or degree[0].tag == "placeholder":
            return called("sqrt", part)
        by = self.value(degree[0])
        return power(part, binary(number(1), "/", by, PRODUCT))

    def _size(self, part: Said) -> Said:
        if part.is_vector and not self.is_vectorised:
            return called("sqrt", reduced("sum", power(part, number(2))))
        return called("abs", part)

    def _transposed(self, part: Said) -> Said:
        if not part.is_vector:
            raise Untranslatable("matrix", "write its items as lists")
        return replace(part, is_row=not part.is_row)

    def _factorial(self, part: Said) -> Said:
        if part.number is None or part.number != int(part.number) or not 0 <= part.number <= 18:
            raise Untranslatable("factorial", "write its value")
        return number(math.factorial(int(part.number)))

    # Lists

    def _item(self, whole: Node, index: Node) -> Said:
        if index.tag == "sequence":
            raise Untranslatable("item of a matrix", "write its rows or columns as lists")
        made, at = self.said(whole), self.said(index)
        if made.axis is None:
            raise Untranslatable("item of what is no list", "define the list above")
        if at.axis is not None:
            return self._along(made, at)
        if at.number is None or at.number != int(at.number):
            raise Untranslatable("index that is calculated", "write the index as a number")
        place = int(at.number) + 1 - made.axis.start
        if not 1 <= place <= made.axis.length:
            raise Untranslatable("item that the list does not have", "write an index within the list")
        if not made.text.replace("_", "").isalnum() and not made.text.startswith("["):
            raise Untranslatable("item of an expression", "give the list a name of its own")
        return Said(f"{made.text}[{place}]")

    def _along(self, made: Said, at: Said) -> Said:
        """The items of a list along a range that names each of them."""
        assert made.axis is not None
        assert at.axis is not None
        numbers = at.axis.numbers
        wanted = tuple(float(made.axis.start + n) for n in range(made.axis.length))
        if not at.text.replace("_", "").isalnum() or numbers != wanted:
            raise Untranslatable("part of a list", "give the part as a list of its own")
        return replace(made, is_vector=False, is_row=False, axis=replace(at.axis, start=made.axis.start))

    def _sum(self, parts: list[Node]) -> Said:
        function = next((part for part in parts if part.tag == "lambda"), None)
        bounds = {part.tag: part.parts[0] for part in parts if part.parts and part.tag.endswith("Bound")}
        if function is None or len(function.parts) != 2:
            raise Untranslatable("sum without a term", "write it out")
        variable, body = function.parts[0].parts[0], function.parts[1]
        if variable.tag != "id":
            made = self.value(body)
            if not made.is_vector:
                raise Untranslatable("sum over what is no list", "write it out")
            return reduced("sum", made)
        if "lowerBound" not in bounds or "upperBound" not in bounds:
            raise Untranslatable("sum over a range variable", "give its bounds, or sum the list")
        numbers = self._counted(self.said(bounds["lowerBound"]), self.said(bounds["upperBound"]))
        axis = replace(self.sheet.axis(len(numbers)), numbers=numbers)
        literal = f"[{', '.join(number(n).text for n in numbers)}]"
        inner: Scope = {**self.scope, key_of(variable): Written(Said("index", axis=axis))}
        made = self.within(inner).value(body)
        if "index" in made.text.replace("(", " ").replace(")", " ").split():
            inner[key_of(variable)] = Written(Said(literal, axis=axis))
            made = _Counting(self.sheet, inner, self.is_vectorised, self.depth).value(body)
        if made.axis is None:
            return binary(number(len(numbers)), "*", made, PRODUCT)
        return reduced("sum", made)

    def _counted(self, first: Said, last: Said) -> tuple[float, ...]:
        if first.number is None or last.number is None:
            raise Untranslatable("sum over a calculated range", "write its bounds as numbers")
        count = int(last.number - first.number) + 1
        if not 1 <= count <= MOST_ITEMS or first.number != int(first.number):
            raise Untranslatable(f"sum over more than {MOST_ITEMS} numbers", "write its closed form")
        return tuple(first.number + n for n in range(count))

    # Calls

    def _call(self, operator: Node, arguments: list[Node]) -> Said:
        key = key_of(operator)
        meant = self.scope.get(key)
        match meant:
            case Function():
                return self._own(meant, arguments)
            case Failed(region):
                raise Unnamed(key, region)
            case Value() | Range() | Written() | Choice():
                raise Untranslatable("call of what is no function", "write a product with *")
        if key in functions.REFUSED:
            raise Untranslatable(
                functions.REFUSED[key], "write the formula by hand, or give its value as an input"
            )
        if key == "if" and len(arguments) == 3:
            return self._either(self.condition(arguments[0]), arguments[1], arguments[2])
        if key == "linterp" and len(arguments) == 3:
            return self._interpolated(arguments)
        parts = [self.quantity(part) or self.value(part) for part in arguments]
        return self._builtin(key, parts)

    def _builtin(self, key: str, parts: list[Said]) -> Said:
        if key in ("min", "max"):
            return self._extreme(key, parts)
        if key in functions.COUNTS and len(parts) == 1:
            return self._count(key, parts[0])
        if key == "log" and len(parts) <= 2:
            base = [called("log", parts[1])] if len(parts) == 2 else []
            return (
                binary(called("log", parts[0]), "/", base[0], PRODUCT) if base else called("log10", parts[0])
            )
        if key in functions.SAME and len(parts) == 1:
            return called(functions.SAME[key], parts[0])
        pattern = functions.WRITTEN_OUT.get(key)
        if pattern is not None and len(parts) == pattern.count("{1}") // max(pattern.count("{1}"), 1) + 1:
            return _filled(pattern, parts).shaped(*parts)
        pattern = functions.OVER_LISTS.get(key)
        if pattern is not None and parts and len(parts) == (2 if "{1}" in pattern else 1):
            if key == "mean" and parts[0].axis is None:
                return parts[0]
            if any(part.axis is None for part in parts):
                raise Untranslatable(f"{key} of what is no list", "give it a list")
            parts[0].shaped(*parts)
            return _filled(pattern, parts)
        if key in ("sum", "cnt"):
            return reduced("sum", parts[0])
        raise Unnamed(key)

    def _extreme(self, key: str, parts: list[Said]) -> Said:
        if any(part.is_vector for part in parts) and not (self.is_vectorised and len(parts) > 1):
            parts = [reduced(key, part) if part.is_vector else part for part in parts]
            return parts[0] if len(parts) == 1 else called(key, *parts)
        return parts[0] if len(parts) == 1 and parts[0].axis is None else called(key, *parts)

    def _count(self, key: str, part: Said) -> Said:
        if part.axis is None or part.is_row:
            raise Untranslatable("size of a matrix", "write the number")
        count = part.axis.length
        return number(count + part.axis.start - 1 if key == "last" else count)

    def _interpolated(self, arguments: list[Node]) -> Said:
        literal = replace(self, keep=None)
        across, up = (literal.quantity(part) or literal.said(part) for part in arguments[:2])
        at = self.quantity(arguments[2]) or self.said(arguments[2])
        if across.axis is None or up.axis is None or at.is_vector:
            raise Untranslatable("interpolation in what are no lists", "write a curve")
        return called(self.sheet.curve(across, up), at)

    def _own(self, function: Function, arguments: list[Node]) -> Said:
        if len(arguments) != len(function.parameters):
            raise Untranslatable("call with another number of arguments", "call it as it is defined")
        if self.depth >= MOST_INLINED:
            raise Untranslatable("functions within functions", "give the steps names of their own")
        parts = [self.quantity(part) or self.value(part) for part in arguments]
        if not any(part.is_vector and not self.is_vectorised for part in parts):
            name = self.sheet.function(function, parts)
            if name is not None:
                return called(name, *parts) if parts else Said(name)
        return self._written_out(function, parts)

    def _written_out(self, function: Function, parts: list[Said]) -> Said:
        """The body of a function with its arguments in the place of its parameters."""
        inner: Scope = dict(function.scope)
        for key, part in zip(function.parameters, parts, strict=True):
            inner[key] = Written(part)
        return self.within(inner, depth=1).said(function.body)

    # Conditions

    def condition(self, node: Node) -> Said:
        """A tree as a condition; of a number, whether it is not 0."""
        if node.tag == "parens" and node.parts:
            return self.condition(node.parts[0])
        operator, parts = (
            (node.parts[0].tag, node.parts[1:]) if node.tag == "apply" and node.parts else ("", [])
        )
        match operator, parts:
            case sign, [left, right] if sign in COMPARED:
                return self._compared(COMPARED[sign], left, right)
            case "and" | "or", [left, right]:
                sides = self.condition(left), self.condition(right)
                text = f" {operator} ".join(side.bound(ATOM) for side in sides)
                return Said(text, LOOSE, is_truth=True).shaped(*sides)
            case "xor", [left, right]:
                one, other = (self.condition(part) for part in (left, right))
                a, b = one.bound(ATOM), other.bound(ATOM)
                return Said(f"({a} and not {b}) or ({b} and not {a})", LOOSE, is_truth=True).shaped(
                    one, other
                )
            case "not", [part]:
                inner = self.condition(part)
                return Said(f"not {inner.bound(ATOM)}", LOOSE, is_truth=True).shaped(inner)
        made = self.said(node)
        if made.is_truth:
            return made
        return Said(f"{made.bound(SUM)} != 0", LOOSE, is_truth=True).shaped(made)

    def _compared(self, sign: str, left: Node, right: Node) -> Said:
        if word := self._tested(left, right) or self._tested(right, left):
            return Said(f"not ({word})" if sign == "!=" else word, LOOSE, is_truth=True)
        one, other = self.said(left), self.value(right)
        start = one.text if one.is_truth else one.bound(SUM)  # a chain goes on: 1 < x <= 2
        return Said(f"{start} {sign} {other.bound(SUM)}", LOOSE, is_truth=True).shaped(one, other)

    def _tested(self, choice: Node, text: Node) -> str:
        meant = self.scope.get(key_of(choice)) if choice.tag == "id" else None
        if not isinstance(meant, Choice) or text.tag != "str" or text.text not in meant.words:
            return ""
        return f"{meant.name} is {meant.words[text.text]}"

    def _either(self, test: Said, one: Node, other: Node) -> Said:
        then, otherwise = self.value(one), self.value(other)
        text = f"if {test.text} then {then.bound(SUM)} else {otherwise.text}"
        return Said(text, LOOSE).shaped(test, then, otherwise)

    # Programs

    def _program(self, parts: list[Node]) -> Said:
        """Definitions of local names, and then a value: each name is replaced by its expression."""
        parts = [part for part in parts if part.tag != "placeholder"]
        inner: Scope = dict(self.scope)
        for place, part in enumerate(parts):
            if part.tag == "localDefine" and len(part.parts) == 2 and part.parts[0].tag == "id":
                inner[key_of(part.parts[0])] = Written(self.within(inner).value(part.parts[1]))
                continue
            at = self.within(inner)
            if part.tag in ("if", "elseif", "alsoif", "else"):
                return at._chain(parts[place:])
            if part.tag == "return" and part.parts:
                return at.value(part.parts[0])
            if place == len(parts) - 1:
                return at.value(part)
            at.said(part)  # names a construct that is refused
            raise Untranslatable("program of several values", "write one formula")
        raise Untranslatable("program without a value", "write one formula")

    def _chain(self, parts: list[Node]) -> Said:
        """Conditions one after another; the last is `else`, or there is no value."""
        branches: list[tuple[Node, Node]] = []
        waiting = list(parts)
        while waiting:
            part = waiting.pop(0)
            inner = {child.tag: child for child in part.parts}
            if part.tag in ("if", "elseif", "alsoif") and "test" in inner and "then" in inner:
                branches.append((inner["test"].parts[0], inner["then"].parts[0]))
                waiting = [
                    child for child in part.parts if child.tag in ("elseif", "alsoif", "else")
                ] + waiting
            elif part.tag == "else" and part.parts and not waiting:
                return self._cases(branches, part.parts[0])
            else:
                raise Untranslatable("program of several values", "write one formula with if … then … else …")
        remedy = "say in Mathcad, or in the line, what holds otherwise"
        raise Untranslatable("condition without otherwise", remedy)

    def _cases(self, branches: list[tuple[Node, Node]], last: Node) -> Said:
        made = self.value(last)
        for test, then in reversed(branches):
            held, value = self.condition(test), self.value(then)
            text = f"if {held.text} then {value.bound(SUM)} else {made.text}"
            made = Said(text, LOOSE).shaped(held, value, made)
        return made


class _Counting(Expressions):
    """Writes the term of a sum whose index is itself a number in it."""

    def _along(self, made: Said, at: Said) -> Said:
        named = replace(at, text="index")
        return super()._along(made, named)


def _is_plain(text: str) -> bool:
    return text.lstrip("-").replace(".", "", 1).isdigit()


def _fraction(node: Node) -> Said | None:
    """A quotient of two plain numbers, which an exponent may be."""
    while node.tag == "parens" and node.parts:
        node = node.parts[0]
    if node.tag != "apply" or len(node.parts) != 3 or node.parts[0].tag != "div":
        return None
    over, under = node.parts[1], node.parts[2]
    if over.tag != "real" or under.tag != "real" or not _is_plain(over.text + under.text):
        return None
    return Said(f"{over.text} / {under.text}", PRODUCT, number=float(over.text) / float(under.text))


def _filled(pattern: str, parts: Sequence[Said]) -> Said:
    texts = [part.bound(ATOM) for part in parts]
    return Said(pattern.format(*texts), LOOSE if pattern.startswith("if") else SUM)


Caller = Callable[[Function, Sequence[Said]], str | None]
