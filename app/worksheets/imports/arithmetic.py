"""Arithmetic of Mathcad: a product of two vectors is their scalar product unless it is vectorised."""

from __future__ import annotations

import math
from dataclasses import replace

from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.names import key_of
from app.worksheets.imports.terms import PRODUCT, SUM, Term, binary, called, negative, number, reduced
from app.worksheets.imports.terms import power as raised
from app.worksheets.imports.trees import Node
from app.worksheets.imports.unit_names import UNLABELLED
from app.worksheets.imports.writer import Writer


class Arithmetic(Writer):
    """Writes arithmetic operators."""

    def times(self, left: Node, right: Node) -> Term:
        """Return a product of two trees."""
        return self.product(self.term(left), self.term(right))

    def over(self, left: Node, right: Node) -> Term:
        """Return a quotient of two trees."""
        return self.quotient(self.term(left), self.term(right))

    def plus(self, left: Node, right: Node) -> Term:
        """Return a sum."""
        return binary(self.value(left), "+", self.value(right), SUM)

    def minus(self, left: Node, right: Node) -> Term:
        """Return a difference."""
        return binary(self.value(left), "-", self.value(right), SUM)

    def negative(self, part: Node) -> Term:
        """Return the negative of a tree."""
        return negative(self.value(part))

    def percent(self, part: Node) -> Term:
        """Return one hundredth of a tree."""
        return binary(self.value(part), "/", number(100), PRODUCT)

    def vectorized(self, part: Node) -> Term:
        """Return a tree whose operators apply item by item."""
        return replace(self, is_vectorised=True).term(part)

    def product(self, left: Term, right: Term) -> Term:
        """Return a product; for two vectors, their scalar product."""
        result = binary(left, "*", right, PRODUCT)
        if left.is_vector and right.is_vector and not self.is_vectorised:
            if left.is_row == right.is_row and left.is_row:
                raise Untranslatable("matrix product", "write it as a sum of products")
            if right.is_row and not left.is_row:
                raise Untranslatable("matrix product", "write it as a sum of products")
            return reduced("sum", result)
        return result

    def quotient(self, left: Term, right: Term) -> Term:
        """Return a quotient."""
        if right.is_vector and not self.is_vectorised:
            raise Untranslatable(
                "worksheets cannot divide by a vector", "vectorise it, or write it item by item"
            )
        return binary(left, "/", right, PRODUCT)

    def power(self, base: Node, exponent: Node) -> Term:
        """Return a power; a vector can only be squared, which gives a scalar product."""
        over = self.value(exponent)
        if base.tag == "id" and self._is_euler(base):
            return called("exp", over)
        under = self.value(base)
        if under.is_vector and not self.is_vectorised:
            if over.number != 2:
                raise Untranslatable(
                    "worksheets cannot raise a vector to a power", "vectorise it, or write it item by item"
                )
            return reduced("sum", raised(under, over))
        if over.number is not None and not _is_plain(over.text):
            over = _fraction(exponent) or number(over.number)
        return raised(under, over)

    def _is_euler(self, base: Node) -> bool:
        """Return whether a base is Euler's number: labelled `e`, or an unlabelled `e` without definition."""
        label = base.attributes.get("labels", "")
        is_free = label in UNLABELLED and "e" not in self.scope
        return key_of(base) == "e" and (label == "CONSTANT" or is_free)

    def root(self, degree: list[Node], part: Term) -> Term:
        """Return a root of any degree."""
        if part.is_vector and not self.is_vectorised:
            raise Untranslatable(
                "worksheets cannot take the root of a vector", "vectorise it, or write it item by item"
            )
        if not degree or degree[0].tag == "placeholder":
            return called("sqrt", part)
        by = self.value(degree[0])
        return raised(part, binary(number(1), "/", by, PRODUCT))

    def size(self, part: Term) -> Term:
        """Return an absolute value, or the length of a vector."""
        if part.is_vector and not self.is_vectorised:
            return called("sqrt", reduced("sum", raised(part, number(2))))
        return called("abs", part)

    def factorial(self, part: Term) -> Term:
        """Return a factorial, as a number."""
        if part.number is None or part.number != int(part.number) or not 0 <= part.number <= 18:
            raise Untranslatable("factorial", "write its value")
        return number(math.factorial(int(part.number)))


def _is_plain(text: str) -> bool:
    return text.lstrip("-").replace(".", "", 1).isdigit()


def _fraction(node: Node) -> Term | None:
    """Return a quotient of two plain numbers as text, for use as an exponent; None for other trees."""
    while node.tag == "parens" and node.parts:
        node = node.parts[0]
    if node.tag != "apply" or len(node.parts) != 3 or node.parts[0].tag != "div":
        return None
    over, under = node.parts[1], node.parts[2]
    if over.tag != "real" or under.tag != "real" or not _is_plain(over.text + under.text):
        return None
    return Term(f"{over.text} / {under.text}", PRODUCT, number=float(over.text) / float(under.text))
