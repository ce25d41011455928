"""Functions of a worksheet, written out wherever they are called; each sees those above it only."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import lark

from templates.core.errors import FaultyText
from templates.core.sheets.expressions import Reader, is_temperature, no_temperature
from templates.core.sheets.grammar import Parsed
from templates.core.sheets.names import Names, sort_of
from templates.core.units.expressions import FaultyPlace, checked
from templates.core.units.operations import Name
from templates.core.units.rules import in_words
from templates.core.units.sorts import Part, Sort
from templates.core.units.units import compatible


@dataclass(frozen=True)
class Function:
    """A function: what its parameters measure, and the expression of them."""

    name: str
    unit: str
    parameters: tuple[tuple[str, Sort], ...]
    takes: str
    tree: lark.Tree[Any]
    names: Names
    node: Any = None  # the expression of its parameters

    def call(self, arguments: list[Part]) -> Part:
        """Return the expression with arguments in the place of parameters.

        Raises
        ------
        FaultyText
            With code `unit_mismatch` or `unknown_function`, if the arguments do not fit.
        """
        if len(arguments) != len(self.parameters):
            detail = f"{self.name} takes {self.takes}, not {len(arguments)} values"
            raise FaultyText("unknown_function", detail)
        for (node, got), (own, wanted) in zip(arguments, self.parameters, strict=True):
            if got.truth or not compatible(got.kind.base, wanted.kind.base):
                given = "a condition" if got.truth else in_words(got.kind)
                raise FaultyText("unit_mismatch", f"{self.name} takes {self.takes}, not {given}")
            if wanted.weight and not is_temperature(node, got):
                raise FaultyText("unit_mismatch", no_temperature(f"{own} of {self.name}"))
            if wanted.axis and not got.axis:
                raise FaultyText("axis_mismatch", f"{self.name} takes {self.takes}, not a single value")
        names = (name for name, _ in self.parameters)
        return self._written_out(dict(zip(names, arguments, strict=True)))

    def _written_out(self, parameters: dict[str, Part]) -> Part:
        before, self.names.parameters = self.names.parameters, parameters
        try:
            return checked(self.tree, self.names)
        except FaultyPlace as error:
            raise FaultyText(error.code, str(error)) from None  # its place is that of the call
        finally:
            self.names.parameters = before


def function_of(statement: Parsed, reader: Reader) -> Function:
    """The function that a statement declares, its formula checked by what its parameters are declared in.

    Raises
    ------
    Refusal
        Where it is wrong.
    """
    called, *parameters, unit_text, tree = statement.parts
    name, unit_name = str(called)[:-1], reader.declared_unit(statement, unit_text)
    sorts = {}
    for parameter in parameters:
        own, text, axis = parameter.children
        if str(own) in sorts:
            raise statement.refuse("name", f"{own} stands twice", own, "name the parameters differently")
        sorts[str(own)] = replace(sort_of(reader.declared_unit(statement, text)), axis=str(axis or ""))
    takes = ", ".join(map(_taken, parameters))
    names, before = reader.names, reader.names.parameters
    names.parameters = {own: (Name(own), sort) for own, sort in sorts.items()}
    try:
        node = reader.fitting(statement, reader.part(statement, tree), unit_name, name, tree)
    finally:
        names.parameters = before
    return Function(name, unit_name, tuple(sorts.items()), takes, tree, names, node)


def _taken(parameter: lark.Tree[Any]) -> str:
    """Return a parameter in words: `x in mm`, `g in bar over cycle`."""
    name, unit_text, axis = parameter.children
    return f"{name} in {str(unit_text)[1:-1]}" + (f" over {axis}" if axis else "")
