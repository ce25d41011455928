"""From the statements of a worksheet to the declarations of a class; every fault is collected."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field
from typing import Any

import lark

from templates.core.errors import FaultyText
from templates.core.language.meaning import Meaning
from templates.core.language.spec import Choice, Declaration, Derived, Formula, Given, Requirement
from templates.core.sheets.body import RuleBody, TreeBody
from templates.core.sheets.clauses import meaning_of, said_in, words_of
from templates.core.sheets.criteria import criterion_of
from templates.core.sheets.expecting import test_of
from templates.core.sheets.expressions import Reader
from templates.core.sheets.faults import FollowsFromFault, Refusal, SheetFault
from templates.core.sheets.functions import function_of
from templates.core.sheets.grammar import Parsed, name_of, parsed
from templates.core.sheets.lines import Chunk
from templates.core.sheets.names import Named, Names, sort_of
from templates.core.sheets.testing import SheetTest
from templates.core.sheets.typed import default_of

Made = Declaration | Requirement
UNNAMED = "line"  # a rule stands in the class under its line: `line 14`, which no user can write


@dataclass
class Built:
    """What the statements of a worksheet make; `faults` are all that is wrong with them.

    Attributes
    ----------
    made
        Declarations and rules by attribute.
    criteria
        As a template declares them, by name.
    example
        By API name, as typed.
    """

    statements: list[Parsed] = field(default_factory=list)
    faults: list[SheetFault] = field(default_factory=list)
    made: dict[str, Made] = field(default_factory=dict)
    criteria: dict[str, dict[str, str]] = field(default_factory=dict)
    called: dict[int, str] = field(default_factory=dict)  # names of declarations by line, rules included
    example: dict[str, Any] = field(default_factory=dict)
    tests: list[SheetTest] = field(default_factory=list)
    named: dict[str, Named] = field(default_factory=dict)
    trees: dict[int, Any] = field(default_factory=dict)  # what is written on paper, by line
    said: dict[int, str] = field(default_factory=dict)  # words and sentences, by line

    def declarations(self) -> dict[str, Made]:
        """Declarations and rules for another class: a class keeps names in those that it is made of."""
        return {name: copy(made) for name, made in self.made.items()}


class Builder:
    """Reads statement after statement; what one refuses does not hide what is wrong with the next."""

    def __init__(self, chunks: list[Chunk]) -> None:
        self.built, self.names = Built(), Names()
        self.reader = Reader(self.names)
        self.lines: dict[str, int] = {}  # of API names
        for chunk in chunks:
            self._try(self._parse, chunk)
        for statement in self.built.statements:
            self._try(self._announce, statement)
        for kinds in (("function",), ("given", "formula"), ("require", "check"), ("test",)):
            for statement in self.built.statements:
                if statement.kind in kinds and self.names.fuel >= 0:
                    self._try(getattr(self, f"_{statement.kind}"), statement)

    def _try(self, step: Callable[[Any], None], statement: Parsed | Chunk) -> None:
        """Take a step, and note the fault that it meets."""
        try:
            step(statement)
        except Refusal as refusal:
            self.built.faults.append(refusal.fault)
        except FollowsFromFault:
            pass
        else:
            return
        name = name_of(statement.chunk if isinstance(statement, Parsed) else statement)
        self.names.broken.add(name)

    def _parse(self, chunk: Chunk) -> None:
        self.built.statements.append(parsed(chunk))

    def _announce(self, statement: Parsed) -> None:
        """Let other statements use a name before the formula behind it is read."""
        if statement.kind not in ("given", "formula"):
            return
        name, unit_text = statement.declared
        try:
            self.names.check_new(str(name))
        except FaultyText as error:
            remedy = "choose another name, as in p_max"
            raise statement.refuse(error.code, str(error), name, remedy) from None
        self.names.sorts[str(name)] = sort_of(self.reader.declared_unit(statement, unit_text))

    def _function(self, statement: Parsed) -> None:
        function = function_of(statement, self.reader)
        self.names.functions[function.name] = function.call
        self.built.trees[statement.chunk.line] = function.node
        self._note(statement, function.name, function.unit, "")

    def _given(self, statement: Parsed) -> None:
        name, unit_text, tree, words, clauses = statement.parts
        meant = self._meaning(statement, name, unit_text, words, clauses)
        if tree is None:
            self._make(statement, name, Given(meant))
            return
        part = self.reader.part(statement, tree)
        node = self.reader.fitting(statement, part, meant.unit, str(name), tree)
        body = TreeBody(node, statement.chunk.line)
        self.built.trees[statement.chunk.line] = node
        made = Derived(body, meant) if body.uses else Given(meant, default_of(node, meant, body))
        self._make(statement, name, made)

    def _formula(self, statement: Parsed) -> None:
        name, unit_text, tree, words, clauses = statement.parts
        meant = self._meaning(statement, name, unit_text, words, clauses)
        part = self.reader.part(statement, tree)
        node = self.reader.fitting(statement, part, meant.unit, str(name), tree)
        self.built.trees[statement.chunk.line] = node
        self._make(statement, name, Formula(TreeBody(node, statement.chunk.line), meant))

    def _require(self, statement: Parsed) -> None:
        tree, words, clauses = statement.parts
        node = self._condition(statement, tree)
        said = said_in(statement, clauses, self.reader)
        body = RuleBody(node, statement.chunk.line, words_of(statement, words).rstrip("."))
        blamed = self._inputs_beneath(body.uses)
        if not blamed:
            remedy = "compare a given with something"
            raise statement.refuse("no_truth", "the rule is about no input", tree, remedy)
        remedy = said.keywords.get("remedy") or "change one of them"
        rule = Requirement(body, blamed, remedy, False, "")
        self.built.made[f"{UNNAMED} {statement.chunk.line}"] = rule
        self.built.called[statement.chunk.line] = f"{UNNAMED} {statement.chunk.line}"
        self.built.said[statement.chunk.line] = rule.sentence

    def _check(self, statement: Parsed) -> None:
        tree, words, clauses = statement.parts
        node = self._condition(statement, tree)
        said = said_in(statement, clauses, self.reader)
        text = words_of(statement, words)
        name, criterion = criterion_of(statement, node, text, said, self.built.made)
        if name in self.built.criteria:
            raise statement.refuse("name", f"another check is named {name}", words, "say it in other words")
        self.built.criteria[name] = criterion
        self.built.called[statement.chunk.line] = name
        self.built.said[statement.chunk.line] = text

    def _test(self, statement: Parsed) -> None:
        test = test_of(statement, self.reader, self.built.made)
        self.built.tests.append(test)
        self.built.said[statement.chunk.line] = test.words

    def _condition(self, statement: Parsed, tree: lark.Tree[Any]) -> Any:
        node, sort = self.reader.part(statement, tree)
        if not sort.truth:
            remedy = "write it as in p <= 30 MPa"
            raise statement.refuse("no_truth", "this is a quantity, not a condition", tree, remedy)
        self.built.trees[statement.chunk.line] = node
        return node

    def _meaning(
        self, statement: Parsed, name: lark.Token, unit_text: lark.Token, words: lark.Token, clauses: Any
    ) -> Meaning:
        """The meaning of a declaration whose API name is no other's."""
        if str(name) not in self.names.sorts:
            raise FollowsFromFault(str(name))
        unit_name = self.reader.declared_unit(statement, unit_text)
        meant, said = meaning_of(statement, unit_name, words, clauses, self.reader)
        self._check_words(statement, meant.name, words)
        if said.example is not None and statement.kind == "given":
            self.built.example[meant.name] = said.example
        self._note(statement, str(name), meant.unit, meant.words)
        return meant

    def _check_words(self, statement: Parsed, name: str, words: lark.Token) -> None:
        """Refuse words that make the API name of another declaration."""
        other = self.lines.setdefault(name, statement.chunk.line)
        if other != statement.chunk.line:
            message = f"line {other} has the same words, or the name {name}"
            raise statement.refuse("name", message, words, "say it in other words")

    def _note(self, statement: Parsed, name: str, unit_text: str, words: str) -> None:
        self.built.named[name] = Named(name, unit_text, words, statement.kind)
        self.built.called[statement.chunk.line] = name
        self.built.said[statement.chunk.line] = words

    def _make(self, statement: Parsed, name: lark.Token, made: Declaration) -> None:
        self.built.made[str(name)] = made

    def _inputs_beneath(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """The API names of inputs from which names follow, those nearest first."""
        found: dict[str, None] = {}
        waiting, seen = list(names), set(names)
        for name in waiting:
            made = self.built.made.get(name)
            if isinstance(made, (Given, Choice, Derived)):
                found[made.name] = None
            elif isinstance(made, Formula):
                new = [used for used in made.uses if used not in seen]
                seen.update(new)
                waiting += new
        return tuple(found)
