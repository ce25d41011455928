"""Base class of all expression writers: the position in the sheet, and look-ups of names there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, Self

from app.worksheets.imports.quantities import scaled
from app.worksheets.imports.scope import Function, Scope
from app.worksheets.imports.terms import POWER, Axis, Term, number
from app.worksheets.imports.trees import Node

MOST_INLINED = 12
"""Largest depth of inlined functions."""
MOST_ITEMS = 300


class Sheets(Protocol):
    """The part of the sheet under construction that an expression uses."""

    origin: int

    def function(self, function: Function, arguments: Sequence[Term]) -> str | None:
        """Return the name of a function's statement for these arguments; None if it must be inlined."""

    def curve(self, across: Term, up: Term) -> str:
        """Return the name of a curve through points."""

    def axis(self, length: int) -> Axis:
        """Return the axis for vectors of the given length."""


@dataclass
class Writer:
    """Writes expressions at one position of a sheet.

    `keep` declares a list within a formula in a separate line. `is_counting` states that the index of a sum
    is a number in its term.
    """

    sheet: Sheets
    scope: Scope
    is_vectorised: bool = False
    is_counting: bool = False
    depth: int = 0
    keep: Callable[[Term], Term] | None = None

    def within(self, scope: Scope) -> Self:
        """Return the same writer for another scope."""
        return replace(self, scope=scope)

    def term(self, node: Node) -> Term:
        """Return the expression of a tree.

        Raises
        ------
        Untranslatable
            If worksheets do not have the construct; the error names it.
        Unnamed
            If a name has no meaning here.
        """
        raise NotImplementedError

    def value(self, node: Node) -> Term:
        """Return a tree as a quantity; a condition becomes 1 if it holds and 0 otherwise."""
        raise NotImplementedError

    def condition(self, node: Node) -> Term:
        """Return a tree as a condition; a number becomes the condition that it is not 0."""
        raise NotImplementedError

    def either(self, test: Term, one: Node, other: Node) -> Term:
        """Return an expression that selects one of two values by a condition."""
        raise NotImplementedError

    def quantity(self, node: Node) -> Term | None:
        """Return a tree that consists only of numbers and units as one quantity, else None."""
        scale = scaled(node)
        if scale is None or not scale.powers:
            return None
        unit = scale.unit
        sign = number(scale.number)
        return Term(sign.text if unit == "1" else f"{sign.text} {unit}", min(sign.tight, POWER))

    def argument(self, node: Node) -> Term:
        """Return an argument as a typed quantity if possible, else as a value."""
        return self.quantity(node) or self.value(node)
