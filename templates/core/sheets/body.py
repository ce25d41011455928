"""A checked tree in the place of a formula's function: called with a template, it gives the value."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping
from functools import reduce
from typing import Any

import numpy as np

from templates.core.language.body import Body
from templates.core.paper.expressions import latex
from templates.core.units.closures import closure
from templates.core.units.operations import Apply, Name
from templates.core.units.walking import nodes_of

_SIGNS = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq,
    "!=": operator.ne,
}  # fmt: skip
_JOINED = {"and": np.logical_and, "or": np.logical_or}


class TreeBody(Body):
    """A tree whose units were checked."""

    def __init__(self, node: Any, line: int) -> None:
        self.node, self.line = node, line
        self.uses = tuple(dict.fromkeys(names_in(node)))
        self.__doc__ = None
        self.__qualname__ = f"line {line}"
        self._run = closure(node)

    def __call__(self, template: Any) -> Any:
        """The SI value for the values of a template."""
        return self._run(template)

    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """How it is written, with symbols or numbers in the place of attributes."""
        return latex(self.node, symbols, times)


class RuleBody(TreeBody):
    """A condition, whose comparisons a report can record; `sentence` is what the rule says."""

    def __init__(self, node: Any, line: int, sentence: str) -> None:
        super().__init__(node, line)
        self.__doc__ = sentence
        self._run = _truth(node)


def _truth(node: Any) -> Callable[[Any], Any]:
    """A condition as a function, its comparisons made by Python's operators, which records follow."""
    sign = node.operation.sign if isinstance(node, Apply) else ""
    if sign in _SIGNS:
        compare, left, right = _SIGNS[sign], *map(closure, node.arguments)
        return lambda template: compare(left(template), right(template))
    if sign in _JOINED:
        join, parts = _JOINED[sign], [_truth(part) for part in node.arguments]
        return lambda template: reduce(join, (part(template) for part in parts))
    return closure(node)


def names_in(node: Any) -> Iterator[str]:
    """The names that a tree reads, in order of appearance."""
    return (part.name for part in nodes_of(node) if isinstance(part, Name))
