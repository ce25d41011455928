"""Expressions within statements: their trees, what they measure, and limits that are one number."""

from __future__ import annotations

from typing import Any

import lark

from templates.core.errors import FaultyText
from templates.core.sheets.grammar import Parsed
from templates.core.sheets.names import Names, sort_of
from templates.core.units.expressions import FaultyPlace, checked
from templates.core.units.operations import Constant
from templates.core.units.rules import is_number, told
from templates.core.units.sorts import Part
from templates.core.units.units import compatible, unit


class Reader:
    """Reads the expressions of statements, all within the names of one worksheet."""

    def __init__(self, names: Names) -> None:
        self.names = names

    sort_of = staticmethod(sort_of)

    def part(self, statement: Parsed, tree: lark.Tree[Any]) -> Part:
        """An expression and what it gives.

        Raises
        ------
        Refusal
            With the place of what is wrong.
        """
        try:
            return checked(tree, self.names)
        except FaultyPlace as error:
            raise statement.at(error.code, str(error), error.meta) from None

    def fitting(self, statement: Parsed, part: Part, unit_text: str, name: str, at: Any) -> Any:
        """The tree of an expression that gives what is declared.

        Raises
        ------
        Refusal
            With code `unit_mismatch` or `no_truth`.
        """
        tree, got = part
        wanted = sort_of(unit_text)
        if got.truth:
            message = f"{name} is a quantity, but this is a condition"
            raise statement.refuse("no_truth", message, at, "write if … then … else …")
        if not compatible(got.kind.base, wanted.kind.base):
            message = f"{name} is declared in {unit_text}, but this gives {told(got.kind)}"
            raise statement.refuse("unit_mismatch", message, at, "correct the unit or the formula")
        if unit(unit_text).absolute and abs((got.weight or 0.0) - 1) > 1e-9:
            message = f"{name} is a difference of temperatures, or no plain one"
            raise statement.refuse("unit_mismatch", message, at, "declare it in K")
        return tree

    def limit(self, statement: Parsed, tree: lark.Tree[Any], unit_text: str) -> float:
        """A limit in the declared unit: typed in it without a unit, or in any other with one.

        Raises
        ------
        Refusal
            With code `limit` if it is not one number, or `unit_mismatch`.
        """
        part = self.part(statement, tree)
        constant, sort = part
        if not isinstance(constant, Constant):
            raise statement.refuse("limit", "a limit is one number", tree, "write it as in <= 2 m")
        if next(tree.find_data("quantity"), None) is None and is_number(sort.kind):
            return float(constant.value)
        value = self.fitting(statement, part, unit_text, "a limit", tree).value
        return float(unit(unit_text).from_si(value))

    def declared_unit(self, statement: Parsed, text: lark.Token) -> str:
        """The unit between brackets.

        Raises
        ------
        Refusal
            With code `unknown_unit`.
        """
        name = text[1:-1].strip()
        try:
            sort_of(name)
        except FaultyText as error:
            raise statement.refuse(error.code, str(error), text) from None
        return name
