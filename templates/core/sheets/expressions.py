"""Read the expressions in statements: their trees, their kinds of quantity, and numeric limits."""

from __future__ import annotations

from typing import Any

import lark
import numpy as np

from templates.core.errors import FaultyText
from templates.core.sheets.body import TreeBody
from templates.core.sheets.grammar import ParsedStatement
from templates.core.sheets.names import Names, sort_of
from templates.core.sheets.remedies import declared_in, names_in_units, remedy_at
from templates.core.units.conformity import misfit
from templates.core.units.expressions import FaultyPlace, checked
from templates.core.units.expressions import constant as checked_constant
from templates.core.units.operations import Constant
from templates.core.units.rules import as_difference, is_number
from templates.core.units.sorts import Part, Sort
from templates.core.units.units import require_same_kind, unit


class Reader:
    """Reads the expressions of statements with the names of one worksheet."""

    def __init__(self, names: Names) -> None:
        self.names = names

    sort_of = staticmethod(sort_of)

    def part(self, statement: ParsedStatement, tree: lark.Tree[Any]) -> Part:
        """Return an expression and its sort.

        Raises
        ------
        Refusal
            If the expression has a fault; the refusal states its place.
        """
        before = self.names.fuel
        try:
            part = checked(tree, self.names)
        except FaultyPlace as error:
            message, _, remedy = str(error).partition("; ")
            if error.code == "axis_mismatch":  # the second half of its message describes the expression
                message, remedy = str(error), ""
            remedy = remedy or remedy_at(error.code, tree, error.meta, self.names)
            raise statement.at(error.code, message, error.meta, remedy) from None
        try:  # a part in several places, such as an argument of a function, was built only once
            self.names.spend(max(0, part[1].size - (before - self.names.fuel)))
        except FaultyText as error:
            raise statement.refuse(
                error.code, str(error), tree, "define its parts under names of their own"
            ) from None
        return part

    def fitting(
        self,
        statement: ParsedStatement,
        part: Part,
        unit_text: str,
        name: str,
        at: Any,
        axis: str | None = None,
    ) -> Any:
        """Return the tree of an expression that matches its declaration; an `axis` of None allows any axis.

        Raises
        ------
        Refusal
            The code is `unit_mismatch`, `axis_mismatch` or `no_truth`.
        """
        tree, got = part
        if got.truth:
            message = f"{name} is a quantity, but this is a condition"
            raise statement.refuse("no_truth", message, at, "write `if … then … else …`")
        if mismatch := misfit(got.kind, unit(unit_text), statement.text_of(at)):
            why, remedy = mismatch
            is_declared = str(statement.parts[0]).rstrip("(") == name
            remedy = remedy or (declared_in(name, got.kind) if is_declared else _given_in(unit_text))
            remedy = names_in_units(at, self.names) or remedy
            message = f"{name} is declared in {unit_text}, but {why}"
            raise statement.refuse("unit_mismatch", message, at, remedy)
        if axis is not None:
            self._along(statement, got, axis, name, at)
        return tree

    def _along(self, statement: ParsedStatement, got: Sort, axis: str, name: str, at: Any) -> None:
        """Refuse a list where a single value is declared, or a single value where a list is declared."""
        if got.axis and not axis:
            message = f"{name} is a single value, but this is a list over {got.axis}"
            over = f"over {got.axis}" if " " not in got.axis else "over the name of its axis"
            raise statement.refuse("axis_mismatch", message, at, f"declare it {over}, or take `max(…)` of it")
        if axis and got.axis != axis and not is_literal(got.axis):
            what = f"a list over {got.axis}" if got.axis else "a single value"
            message = f"{name} is declared over {axis}, but this is {what}"
            raise statement.refuse("axis_mismatch", message, at, _along_of(got.axis))

    def limit(
        self, statement: ParsedStatement, tree: lark.Tree[Any], unit_text: str, accepted: str | None = None
    ) -> float:
        """Return a limit as a number in the declared unit; it may be typed without a unit or in another.

        The limit has the kind of the quantity that it limits, which `accepted` gives if the declared unit
        does not determine it.

        Raises
        ------
        Refusal
            If it is not a single number (code `limit`), or its unit does not match (code `unit_mismatch`).
        """
        part = self.part(statement, tree)
        constant, sort = part
        if not isinstance(constant, Constant):
            raise statement.refuse("limit", "a limit must be one number", tree, "write it like `<= 2 m`")
        if next(tree.find_data("quantity"), None) is None and is_number(sort.kind):
            return float(constant.value)
        accepted = accepted or unit_text
        if sort.kind.literal and unit(accepted).difference:
            constant = checked_constant(as_difference(constant.text))
            part = constant, Sort(constant.kind)
        value = self.fitting(statement, part, accepted, "a limit", tree).value
        return float(unit(unit_text).from_si(value))

    def typed(self, statement: ParsedStatement, tree: lark.Tree[Any], unit_text: str, name: str) -> Any:
        """Return a value without names in the form in which a user types it.

        The form is a text for a single number, else a list or a number.

        Raises
        ------
        Refusal
            If it needs a name or is not finite (code `limit`), or if `fitting` refuses it.
        """
        part = self.part(statement, tree)
        if isinstance(part[0], Constant) and part[0].text and " " not in part[0].text:
            return part[0].text if unit_text == "1" else f"{part[0].text} {unit_text}"
        node = self.fitting(statement, part, unit_text, name, tree)
        return self.number(statement, node, tree, unit_text, name)

    def number(
        self, statement: ParsedStatement, node: Any, tree: lark.Tree[Any], unit_text: str, name: str
    ) -> Any:
        """Return a checked tree without names in the form in which a user types its value.

        Raises
        ------
        Refusal
            If it needs a name, or is not finite; the code is `limit`.
        """
        body = TreeBody(node, statement.chunk.line)
        if body.uses:
            raise statement.refuse("limit", f"{name} takes numbers, not names", tree, "write its value")
        if isinstance(node, Constant) and node.text:
            return self._as_typed(statement, node.text, tree, unit_text)
        with np.errstate(all="ignore"):
            value = np.asarray(body(None), dtype=float)
        if not np.isfinite(value).all():
            remedy = "write a number below 1e308, and divide by none that is 0"
            raise statement.refuse("limit", f"{name} is not finite", tree, remedy)
        shown = np.asarray(unit(unit_text).from_si(value))
        return {"value": shown.tolist(), "unit": unit_text}

    def _as_typed(self, statement: ParsedStatement, text: str, tree: lark.Tree[Any], unit_text: str) -> str:
        """Return a number with its unit if a user might type it for the declared unit, otherwise None."""
        if " " not in text and unit_text != "1":
            return f"{text} {unit_text}"
        try:
            require_same_kind(text.partition(" ")[2] or "1", unit_text)
        except FaultyText as error:
            message, _, remedy = str(error).partition("; ")
            raise statement.refuse("unit_mismatch", message, tree, remedy or _given_in(unit_text)) from None
        return text

    def declared_unit(self, statement: ParsedStatement, text: lark.Token) -> str:
        """Return the unit between brackets.

        Raises
        ------
        Refusal
            The code is `unknown_unit`.
        """
        name = text[1:-1].strip()
        try:
            sort_of(name)
        except FaultyText as error:
            message, _, remedy = str(error).partition("; ")
            raise statement.refuse(error.code, message, text, remedy) from None
        return name


def is_literal(axis: str) -> bool:
    """Return whether an axis, such as `3 items`, belongs to a list that is written out."""
    return " " in axis


def _given_in(unit_text: str) -> str:
    """Return the advice to write a value in a unit."""
    return (
        "write it without a unit"
        if unit_text == "1"
        else f"write it in {unit_text} or another unit of the same kind"
    )


def _along_of(axis: str) -> str:
    """Return the advice to declare a value over an axis, or as a single value."""
    return f"declare it over {axis}" if axis else "omit `over` and the name after it"
