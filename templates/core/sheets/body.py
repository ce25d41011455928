"""A checked tree in the place of a formula's function: called with a template, it gives the value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from templates.core.language.body import Body
from templates.core.sheets._expressions import closure, latex
from templates.core.units.operations import Name


class TreeBody(Body):
    """A tree whose units were checked; `sentence` is what a rule says."""

    def __init__(self, node: Any, line: int, sentence: str | None = None) -> None:
        self.node, self.line = node, line
        self.uses = tuple(dict.fromkeys(names_in(node)))
        self.__doc__ = sentence
        self.__qualname__ = f"line {line}"
        self._run = closure(node)

    def __call__(self, template: Any) -> Any:
        """The SI value for the values of a template."""
        return self._run(template)

    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """How it is written, with symbols or numbers in the place of attributes."""
        return latex(self.node, symbols, times)


def names_in(node: Any) -> Iterator[str]:
    """The names that a tree reads, in order of appearance."""
    waiting = [node]
    while waiting:
        match waiting.pop():
            case Name(name=name):
                yield name
            case other:
                waiting += reversed(getattr(other, "arguments", ()))
