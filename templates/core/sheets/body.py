"""Checked expression trees that replace a formula's function; a call with a template returns its value."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, reduce
from typing import Any

import numpy as np

from templates.core.errors import Fault, InvalidInputs
from templates.core.language.body import Body
from templates.core.paper.expressions import latex
from templates.core.paper.mathml import named_symbol
from templates.core.sheets.partial import explain, explained_in
from templates.core.units.closures import closure
from templates.core.units.evaluation import nodes_of
from templates.core.units.operations import Apply, Name

_SIGNS = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq,
    "!=": operator.ne,
}  # fmt: skip
_JOINED = {"and": np.logical_and, "or": np.logical_or}


PER_OPERATION, PER_PLACE = 1e-6, 5e-9  # time per operation, and additional time per point [s]


def operations_seconds(operations: int, points: int) -> float:
    """Return the order of magnitude of the time of operations at a number of points [s]."""
    return operations * (PER_OPERATION + PER_PLACE * points)


def unequal_lengths(body: Body, template: Any) -> InvalidInputs:
    """Return the error for lists of different lengths in one expression.

    The error names the result, or the inputs of a rule.
    """
    declared = getattr(template, "declarations", {}).get(body.name)
    names = body.inputs or (declared.name if declared else f"line {body.line}",)
    detail = "lists of different lengths meet here; give lists of one length"
    return InvalidInputs([Fault(names[0], "shape", detail, names[1:])])


class TreeBody(Body):
    """A tree with checked units; `name` is the attribute that it calculates."""

    def __init__(self, node: Any, line: int, name: str = "") -> None:
        self.node, self.line, self.name = node, line, name
        self.uses = tuple(dict.fromkeys(names_in(node)))
        self.__doc__: str | None = None
        self.__qualname__ = f"line {line}"
        self._run = closure(node)
        self._explained = explained_in(node)
        self.first: tuple[str, ...] = ()  # upstream formulas of a long chain, the deepest first

    def __call__(self, template: Any) -> Any:
        """Return the SI value for the values of a template.

        Raises
        ------
        InvalidInputs
            If lists of different lengths meet.
        """
        for name in self.first:
            getattr(template, name)
        try:
            value = self._run(template)
        except ValueError:
            raise unequal_lengths(self, template) from None
        if self._explained and np.isnan(value).any() and hasattr(template, "ledger"):
            explain(template, self.name, self._explained)
        return value

    def seconds(self, points: int) -> float:
        """Return the approximate time of its operations at a number of points [s]."""
        return operations_seconds(self._operations, points)

    @cached_property
    def _operations(self) -> int:
        return sum(1 for _ in nodes_of(self.node))

    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """Return the expression in LaTeX, with the given symbols or numbers in place of attributes."""
        return latex(self.node, {**self._letters, **symbols}, times)

    @cached_property
    def _letters(self) -> dict[str, str]:
        """Return the symbols of curves, which expressions call by name."""
        return {one.sign: named_symbol(one.sign) for one, _ in self._explained}


class RuleBody(TreeBody):
    """A condition whose comparisons a report can record; `sentence` states the rule.

    A condition on the items of a list (`of_items`) must be true for all of them.
    """

    def __init__(self, node: Any, line: int, sentence: str, *, of_items: bool) -> None:
        super().__init__(node, line)
        self.__doc__ = sentence
        self._run = _everywhere(_truth(node)) if of_items else _truth(node)
        self._explained = []


def _everywhere(run: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Convert a condition on a list to a condition that is true if it is true at all places."""
    return lambda template: np.all(run(template), axis=-1)


def _truth(node: Any) -> Callable[[Any], Any]:
    """Return a condition as a function with Python's comparison operators, which can be recorded."""
    sign = node.operation.sign if isinstance(node, Apply) else ""
    if sign in _SIGNS:
        compare, left, right = _SIGNS[sign], *map(closure, node.arguments)
        return lambda template: compare(left(template), right(template))
    if sign in _JOINED:
        join, parts = _JOINED[sign], [_truth(part) for part in node.arguments]
        return lambda template: reduce(join, (part(template) for part in parts))
    return closure(node)


def names_in(node: Any) -> Iterator[str]:
    """Return the names that a tree reads, in order of appearance."""
    return (part.name for part in nodes_of(node) if isinstance(part, Name))
