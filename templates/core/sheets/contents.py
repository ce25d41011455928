"""The contents of a worksheet's statements before they become a class."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field
from typing import Any

from templates.core.language.spec import Choice, Declaration, Derived, Formula, Given, Requirement
from templates.core.sheets.design_lines import Plot
from templates.core.sheets.faults import SheetFault
from templates.core.sheets.grammar import UNNAMED, ParsedStatement
from templates.core.sheets.names import KnownName
from templates.core.sheets.worksheet_tests import SheetTest

Part = Declaration | Requirement
RULE = "line"
"""The attribute of a rule is its line, such as `line 14`, a name that no user can write."""


@dataclass(frozen=True)
class Built:
    """The contents of a worksheet's statements; `faults` are all that were found in them.

    Attributes
    ----------
    parts
        Declarations and rules, by attribute.
    criteria
        Criteria in the form in which a template declares them, by name.
    example
        The example as typed, by API name.
    lines
        The line of each API name.
    places
        The line of each name; a statement that solves for several unknowns has several.
    called, said, trees
        By line: the name that a statement declares, its words, and the tree to print.
    """

    statements: list[ParsedStatement] = field(default_factory=list)
    faults: list[SheetFault] = field(default_factory=list)
    parts: dict[str, Part] = field(default_factory=dict)
    criteria: dict[str, dict[str, str]] = field(default_factory=dict)
    example: dict[str, Any] = field(default_factory=dict)
    tests: list[SheetTest] = field(default_factory=list)
    plots: list[Plot] = field(default_factory=list)
    named: dict[str, KnownName] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    called: dict[int, str] = field(default_factory=dict)
    places: dict[str, int] = field(default_factory=dict)
    said: dict[int, str] = field(default_factory=dict)
    trees: dict[int, Any] = field(default_factory=dict)

    def note(self, statement: ParsedStatement, name: str, unit: str, words: str, node: Any = None) -> None:
        """Store what a statement declares, for the editor."""
        line = statement.chunk.line
        self.called[line], self.said[line] = name, words
        self.places[name] = line
        if node is not None:
            self.trees[line] = node
        if statement.kind not in UNNAMED:
            self.named[name] = KnownName(name, unit, words, statement.kind)

    def declarations(self) -> dict[str, Part]:
        """Return copies of the declarations and rules for another class.

        Each copy gets its attribute from that class.
        """
        return {name: copy(part) for name, part in self.parts.items()}

    def inputs_beneath(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return the API names of the inputs on which the names depend, the nearest first."""
        inputs: dict[str, None] = {}
        waiting, seen = list(names), set(names)
        for name in waiting:
            part = self.parts.get(name)
            if isinstance(part, (Given, Choice, Derived)):
                inputs[part.name] = None
            elif isinstance(part, Formula):
                new = [used for used in part.uses if used not in seen]
                seen.update(new)
                waiting += new
        return tuple(inputs)
