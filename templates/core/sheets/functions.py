"""Functions of a worksheet, expanded at each call; each function can use only those above it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import lark

from templates.core.errors import FaultyText
from templates.core.sheets.expressions import Reader
from templates.core.sheets.grammar import ParsedStatement
from templates.core.sheets.names import Names, sort_of
from templates.core.units.conformity import declared_kind, misfit
from templates.core.units.expressions import FaultyPlace, checked
from templates.core.units.nodes import Kind, kind_of
from templates.core.units.operations import Name
from templates.core.units.rules import in_words
from templates.core.units.sorts import Part, Sort
from templates.core.units.units import compatible, unit


@dataclass(frozen=True)
class Function:
    """A function: the units of its parameters, and its expression."""

    name: str
    unit: str
    parameters: tuple[tuple[str, Sort], ...]
    units: tuple[str, ...]  # of the parameters
    takes: str
    tree: lark.Tree[Any]
    names: Names
    node: Any = None  # the expression of its parameters

    def call(self, arguments: list[Part]) -> Part:
        """Return the expression with arguments in place of parameters.

        Raises
        ------
        FaultyText
            If the arguments do not fit; the code is `unit_mismatch` or `unknown_function`.
        """
        if len(arguments) != len(self.parameters):
            detail = f"{self.name} takes {self.takes}, not {len(arguments)} values"
            raise FaultyText("unknown_function", detail)
        parameters = {}
        for (node, got), (own, wanted), unit_text in zip(arguments, self.parameters, self.units, strict=True):
            kind = taken(f"{own} of {self.name}", unit_text, (node, got), f"{self.name} takes {self.takes}")
            if wanted.axis and not got.axis:
                raise FaultyText("axis_mismatch", f"{self.name} takes {self.takes}, not a single value")
            parameters[own] = node, replace(got, kind=kind)
        return self._written_out(parameters)

    def _written_out(self, parameters: dict[str, Part]) -> Part:
        before, self.names.parameters = self.names.parameters, parameters
        try:
            node, sort = checked(self.tree, self.names)
        except FaultyPlace as error:
            raise FaultyText(error.code, str(error)) from None  # report the fault at the call
        finally:
            self.names.parameters = before
        if sort.kind.turned:  # a remark is given at the call
            return node, sort
        return node, replace(sort, kind=declared_kind(sort.kind, kind_of(self.unit)))


def taken(parameter: str, unit_text: str, part: Part, takes: str) -> Kind:
    """Return the kind that an argument has when a parameter takes its value.

    Raises
    ------
    FaultyText
        If the argument does not fit the declared unit of the parameter; the code is `unit_mismatch`.
    """
    node, got = part
    scale, wanted = unit(unit_text), kind_of(unit_text, parameter)
    if got.truth:
        raise FaultyText("unit_mismatch", f"{takes}, not a condition")
    if not compatible(got.kind, wanted):
        raise FaultyText("unit_mismatch", f"{takes}, not {in_words(got.kind)}")
    if mismatch := misfit(got.kind, scale, getattr(node, "text", "")):
        why = f"{parameter} is declared in {unit_text}, and {mismatch[0]}"
        remedy = "give a temperature, or declare the parameter in K" if scale.absolute else mismatch[1]
        raise FaultyText("unit_mismatch", f"{why}; {remedy}")
    return declared_kind(got.kind, wanted)


def function_of(statement: ParsedStatement, reader: Reader) -> Function:
    """Return the function that a statement declares, after checking the units of its formula.

    Raises
    ------
    Refusal
        If the statement has a fault.
    """
    called, *parameters, unit_text, tree = statement.parts
    name, unit_name = str(called)[:-1], reader.declared_unit(statement, unit_text)
    sorts, units = {}, []
    for parameter in parameters:
        own, text, axis = parameter.children
        if str(own) in sorts:
            raise statement.refuse(
                "name", f"the parameter {own} occurs twice", own, "name the parameters differently"
            )
        units.append(reader.declared_unit(statement, text))
        sorts[str(own)] = replace(sort_of(units[-1], str(own)), axis=str(axis or ""))
    takes = ", ".join(map(_taken, parameters))
    names, before = reader.names, reader.names.parameters
    names.parameters = {own: (Name(own), sort) for own, sort in sorts.items()}
    try:
        node = reader.fitting(statement, reader.part(statement, tree), unit_name, name, tree)
    finally:
        names.parameters = before
    return Function(name, unit_name, tuple(sorts.items()), tuple(units), takes, tree, names, node)


def _taken(parameter: lark.Tree[Any]) -> str:
    """Return a parameter in words: `x in mm`, `g in bar over cycle`."""
    name, unit_text, axis = parameter.children
    return f"{name} in {str(unit_text)[1:-1]}" + (f" over {axis}" if axis else "")
