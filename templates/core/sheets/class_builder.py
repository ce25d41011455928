"""Build the parts of a worksheet's class from its statements, and collect every fault."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import lark

from templates.core.errors import FaultyText
from templates.core.language.meaning import Meaning, api_name
from templates.core.language.spec import (
    Choice,
    Curve,
    Declaration,
    Derived,
    Formula,
    Given,
    Profile,
    Requirement,
)
from templates.core.sheets.body import RuleBody, TreeBody
from templates.core.sheets.clauses import meaning_of, said_in, words_of
from templates.core.sheets.contents import RULE, Built
from templates.core.sheets.criteria import criterion_of
from templates.core.sheets.curves import curve_of, points_of
from templates.core.sheets.design_lines import plot_of, require_line
from templates.core.sheets.design_names import DesignName
from templates.core.sheets.expectations import test_of
from templates.core.sheets.expressions import Reader
from templates.core.sheets.faults import FollowsFromFault, Refusal
from templates.core.sheets.functions import function_of
from templates.core.sheets.grammar import ParsedStatement, declared_by, name_of, parsed
from templates.core.sheets.linear import MOST_UNKNOWNS, LinearBody, system_of
from templates.core.sheets.lines import Chunk
from templates.core.sheets.names import FUEL, Names, sort_of
from templates.core.sheets.single_equation import SolveBody, equation_of
from templates.core.units.conformity import declared_kind, leaves_rate_open, turns_remark
from templates.core.units.nodes import EITHER, Kind, kind_of
from templates.core.units.sorts import Sort
from templates.core.units.units import compatible, difference_in, unit

_ORDER = (
    ("function", "curve"),
    ("choice", "given", "formula", "solve", "system"),
    ("require", "check"),
    ("test", "plot"),
)
"""The order in which statements are read: functions first, then quantities, rules and tests."""


class Builder:
    """Reads the statements one by one; a fault in one statement does not hide those in the next."""

    def __init__(self, chunks: list[Chunk], design: tuple[DesignName, ...] | None = None) -> None:
        self.built, self.names = Built(), Names()
        if design is not None:
            self.names.use(design)
        self.reader = Reader(self.names)
        self.refused: set[int] = set()  # lines of statements with a fault
        for chunk in chunks:
            self._try(self._parse, chunk)
        for statement in self.built.statements:
            self._try(self._announce, statement)
        for kinds in _ORDER:
            if "check" in kinds:
                self._declare_design()
            for statement in self.built.statements:
                if statement.kind in kinds and self._goes_on(statement):
                    self._try(getattr(self, f"_{statement.kind}"), statement)
            if "function" in kinds:
                self._find_kinds()
        self._forget_unused()

    def _declare_design(self) -> None:
        """Declare the values of the design as inputs, once the names of all results are known."""
        for one in (self.names.design or {}).values():
            name = api_name(one.name)
            while name in self.built.lines:
                name += "_of_design"
            self.built.lines[name] = 0
            self.built.parts[one.attribute] = one.declared(name)

    def _forget_unused(self) -> None:
        """Remove the inputs that no line uses."""
        for one in (self.names.design or {}).values():
            if one.name not in self.names.used:
                del self.built.parts[one.attribute]

    def _find_kinds(self) -> None:
        """Determine from formulas, in any order, the kinds of names in K and in 1/s."""
        open_kinds = [s for s in self.built.statements if s.kind in ("formula", "given") and self._is_open(s)]
        fuel, self.names.fuel = self.names.fuel, FUEL
        for _ in open_kinds:  # each round determines one or more, if any
            found = [statement for statement in open_kinds if self._finds_kind(statement)]
            if not found:
                break
        self.names.fuel = fuel

    def _is_open(self, statement: ParsedStatement) -> bool:
        """Return whether the unit of a name leaves open of which kind it is."""
        if statement.parts[3] is None:
            return False
        sort = self.names.sorts.get(str(statement.parts[0]))
        if sort is None:
            return False
        is_formula = statement.kind == "formula"
        return sort.kind.temperatures == EITHER or (is_formula and leaves_rate_open(sort.kind))

    def _finds_kind(self, statement: ParsedStatement) -> bool:
        """Return whether the formula of a name in K or 1/s determines its kind."""
        name = str(statement.parts[0])
        try:
            _, got = self.reader.part(statement, statement.parts[3])
        except (Refusal, FollowsFromFault):
            return False
        own = self.names.sorts[name]
        if got.kind.literal or not compatible(got.kind, own.kind):
            return False
        self.names.sorts[name] = replace(own, kind=declared_kind(got.kind, own.kind))
        return self.names.sorts[name].kind != own.kind

    def _goes_on(self, statement: ParsedStatement) -> bool:
        """Return whether to continue with a statement: without faults, and in a small enough sheet."""
        return statement.chunk.line not in self.refused and self.names.fuel >= 0

    def _try(self, step: Callable[[Any], None], statement: ParsedStatement | Chunk) -> None:
        """Run a step, and note the fault that it raises."""
        try:
            step(statement)
        except Refusal as refusal:
            self.built.faults.append(refusal.fault)
        except FollowsFromFault:
            pass
        else:
            return
        chunk = statement.chunk if isinstance(statement, ParsedStatement) else statement
        if isinstance(statement, ParsedStatement):
            self.names.broken.update(declared_by(statement))
        else:
            self.names.broken.add(name_of(chunk))
        self.refused.add(chunk.line)

    def _parse(self, chunk: Chunk) -> None:
        statement = parsed(chunk)
        self.built.statements.append(statement)
        if self.names.design is not None:
            require_line(statement)

    def _announce(self, statement: ParsedStatement) -> None:
        """Declare a name, so that other statements can use it before its formula is read."""
        match statement.kind:
            case "given" | "formula":
                name, unit_text, axis = statement.parts[:3]
                self._name(statement, name, self._sort(statement, name, unit_text, str(axis or "")))
            case "solve":
                name, unit_text = statement.parts[:2]
                self._name(statement, name, self._sort(statement, name, unit_text, ""))
            case "system":
                for name, unit_text in (unknown.children[:2] for unknown in statement.parts[:-1]):
                    self._name(statement, name, self._sort(statement, name, unit_text, ""))
            case "choice":
                name, options = statement.parts[0], statement.parts[3].children
                self._name(statement, name, Sort(words=tuple(map(str, options))))

    def _name(self, statement: ParsedStatement, name: lark.Token, sort: Sort) -> None:
        self._check_new(statement, name, str(name))
        self.names.sorts[str(name)] = sort

    def _sort(self, statement: ParsedStatement, name: lark.Token, unit_text: lark.Token, axis: str) -> Sort:
        text = self.reader.declared_unit(statement, unit_text)
        self.names.units.setdefault(str(name), text)
        return replace(sort_of(text, str(name)), axis=axis)

    def _check_new(self, statement: ParsedStatement, at: lark.Token, name: str) -> None:
        try:
            self.names.check_new(name)
        except FaultyText as error:
            remedy = "choose another name, such as `p_max`"
            raise statement.refuse(error.code, str(error), at, remedy) from None

    def _function(self, statement: ParsedStatement) -> None:
        self._check_new(statement, statement.parts[0], statement.parts[0][:-1])
        function = function_of(statement, self.reader)
        self.names.functions[function.name] = function.call
        self.built.note(statement, function.name, function.unit, "", function.node)

    def _curve(self, statement: ParsedStatement) -> None:
        called, parameter, unit_text, words, clauses, *rest = statement.parts
        name = str(called)[:-1]
        self._check_new(statement, called, name)
        if axis := parameter.children[2]:
            remedy = "omit `over` and the name after it"
            raise statement.refuse("curve", "the parameter of a curve cannot be a list", axis, remedy)
        texts = (parameter.children[1], unit_text)
        along, of = (self.reader.declared_unit(statement, text) for text in texts)
        said = said_in(statement, clauses, self.reader)
        call = curve_of(statement, self.reader, name, (along, of), points_of(rest), said)
        self.names.functions[name] = call
        self.built.note(statement, name, of, words_of(statement, words))

    def _choice(self, statement: ParsedStatement) -> None:
        name, default, words, options, *clauses = statement.parts
        names = tuple(map(str, options.children))
        if len(set(names)) < len(names) or any("." in option for option in names):
            remedy = "write different words, for example `(walther | vogel)`"
            raise statement.refuse(
                "choice", "each option must be a single word and occur only once", options, remedy
            )
        if default is not None and str(default) not in names:
            message = f"the default {default} is not an option"
            raise statement.refuse("choice", message, default, f"write one of {', '.join(names)}")
        keywords: dict[str, Any] = {}
        for clause in clauses:
            self._choose(statement, clause, names, keywords)
        meant = self._meant(statement, "1", words, lark.Tree("clauses", keywords.pop("said", [])))
        if "example" in keywords:
            self.built.example[meant.name] = keywords["example"]
        self._make(statement, str(name), Choice(meant, names, str(default) if default else None), None)

    def _choose(
        self, statement: ParsedStatement, clause: Any, options: tuple[str, ...], parts: dict[str, Any]
    ) -> None:
        """Read a clause of a choice: an option that is its example, or words."""
        if clause.data != "example":
            parts.setdefault("said", []).append(clause)
            return
        tree = clause.children[0]
        word = str(tree.children[0]) if tree.data == "name" else ""
        if word not in options:
            raise statement.refuse(
                "choice", "the example is not one of the options", tree, f"write one of {', '.join(options)}"
            )
        parts["example"] = word

    def _given(self, statement: ParsedStatement) -> None:
        name, unit_text, axis, tree, words, clauses = statement.parts
        meant = self._meant(statement, self.reader.declared_unit(statement, unit_text), words, clauses)
        node, default = None, None
        if tree is not None:
            node, kind = self._node(statement, str(name), meant, str(axis or ""), tree)
            body = TreeBody(node, statement.chunk.line, str(name))
            if body.uses and axis is None:
                body.remark = turns_remark(kind, meant.scale, statement.text_of(tree))
                self._make(statement, str(name), Derived(body, meant), node)
                return
            default = self.reader.number(statement, node, tree, meant.unit, f"the default of {name}")
        declaration = Given(meant, default) if axis is None else Curve(meant, default, along=str(axis))
        self._make(statement, str(name), declaration, node)

    def _formula(self, statement: ParsedStatement) -> None:
        name, unit_text, axis, tree, words, clauses = statement.parts
        meant = self._meant(statement, self.reader.declared_unit(statement, unit_text), words, clauses)
        node, kind = self._node(statement, str(name), meant, str(axis or ""), tree)
        body = TreeBody(node, statement.chunk.line, str(name))
        body.remark = turns_remark(kind, meant.scale, statement.text_of(tree))
        declaration = Formula(body, meant) if axis is None else Profile(body, meant, None, str(axis), 1)
        self._make(statement, str(name), declaration, node)

    def _solve(self, statement: ParsedStatement) -> None:
        name, unit_text, low, high, tree, words, clauses = statement.parts
        meant = self._meant(statement, self.reader.declared_unit(statement, unit_text), words, clauses)
        bounds = tuple(self._node(statement, f"a bound of {name}", meant, "", end)[0] for end in (low, high))
        equation = equation_of(statement, self.reader, tree, str(name))
        lists = frozenset(n for n, sort in self.names.sorts.items() if sort.axis)
        body = SolveBody(str(name), equation, bounds, statement.chunk.line, meant.words, lists)
        self._make(statement, str(name), Formula(body, meant), equation)

    def _system(self, statement: ParsedStatement) -> None:
        *parts, tree = statement.parts
        unknowns = [str(unknown.children[0]) for unknown in parts]
        if len(unknowns) > MOST_UNKNOWNS:
            message = f"a system may have at most {MOST_UNKNOWNS} unknowns"
            raise statement.refuse(
                "too_large", message, parts[MOST_UNKNOWNS], "solve some unknowns in separate formulas"
            )
        meanings: dict[str, Meaning] = {}
        for unknown in parts:
            name, unit_text, words, clauses = unknown.children
            meant = self._meant(statement, self.reader.declared_unit(statement, unit_text), words, clauses)
            if meant.name in meanings:
                message = f"two unknowns have the name {meant.name}"
                raise statement.refuse("name", message, words, "use other words")
            meanings[meant.name] = meant
        system = system_of(statement, self.reader, tree, unknowns)
        for name, meant in zip(unknowns, meanings.values(), strict=True):
            body = LinearBody(name, system, statement.chunk.line)
            self._make(statement, name, Formula(body, meant), system.tree)
        first = next(iter(meanings.values()))  # the line is named after it
        self.built.note(statement, unknowns[0], first.unit, first.words, system.tree)

    def _require(self, statement: ParsedStatement) -> None:
        tree, words, clauses = statement.parts
        node, of_items = self._condition(statement, tree)
        remedy = said_in(statement, clauses, self.reader).keywords.get("remedy")
        body = RuleBody(node, statement.chunk.line, words_of(statement, words).rstrip("."), of_items=of_items)
        blamed = body.inputs = self.built.inputs_beneath(body.uses)
        if not blamed:
            advice = "use at least one `given` quantity in it"
            raise statement.refuse("no_truth", "the rule depends on no input", tree, advice)
        rule = Requirement(body, blamed, remedy or f"change {' or '.join(blamed)}", False, "")
        self.built.parts[f"{RULE} {statement.chunk.line}"] = rule
        self.built.note(statement, f"{RULE} {statement.chunk.line}", "", rule.sentence, node)

    def _check(self, statement: ParsedStatement) -> None:
        tree, words, clauses = statement.parts
        node, _ = self._condition(statement, tree)
        said, text = said_in(statement, clauses, self.reader), words_of(statement, words)
        name, criterion = criterion_of(statement, node, text, said, self.built.parts)
        if name in self.built.criteria:
            raise statement.refuse(
                "name", f"another check already has the name {name}", words, "use other words"
            )
        self.built.criteria[name] = criterion
        self.built.note(statement, name, "", text, node)

    def _test(self, statement: ParsedStatement) -> None:
        test = test_of(statement, self.reader, self.built.parts)
        self.built.tests.append(test)
        self.built.note(statement, "", "", test.words)

    def _plot(self, statement: ParsedStatement) -> None:
        plot = plot_of(statement, self.reader)
        self.built.plots.append(plot)
        self.built.note(statement, "", "", plot.words)

    def _condition(self, statement: ParsedStatement, tree: lark.Tree[Any]) -> tuple[Any, bool]:
        node, sort = self.reader.part(statement, tree)
        if not sort.truth:
            remedy = "write it like `p <= 30 MPa`"
            raise statement.refuse("no_truth", "this is a quantity, not a condition", tree, remedy)
        return node, bool(sort.axis)

    def _node(
        self, statement: ParsedStatement, name: str, meant: Meaning, axis: str, tree: lark.Tree[Any]
    ) -> tuple[Any, Kind]:
        """Return the tree and kind of a value, which must be a list over an axis if and only if declared."""
        part = self.reader.part(statement, tree)
        return self.reader.fitting(statement, part, meant.unit, name, tree, axis), part[1].kind

    def _meant(self, statement: ParsedStatement, unit_text: str, words: lark.Token, clauses: Any) -> Meaning:
        """Return the meaning of a declaration, with a unique API name; store its example."""
        if missing := [name for name in declared_by(statement) if name not in self.names.sorts]:
            raise FollowsFromFault(missing[0])
        accepted = self._accepted(statement, unit_text)
        meant, said = meaning_of(statement, unit_text, words, clauses, self.reader, accepted)
        other = self.built.lines.setdefault(meant.name, statement.chunk.line)
        if other != statement.chunk.line:
            message = f"line {other} has the same words, or words that make the name {meant.name} as well"
            raise statement.refuse("name", message, words, "use other words")
        if said.example is not None and statement.kind == "given":
            self.built.example[meant.name] = said.example
        if accepted == unit_text:
            return meant
        return replace(meant, read_as=accepted) if unit(accepted).absolute else replace(meant, unit=accepted)

    def _accepted(self, statement: ParsedStatement, unit_text: str) -> str:
        """Return the declared unit, or for a declaration in K the unit whose kind its formula has."""
        if statement.kind not in ("formula", "given") or kind_of(unit_text).temperatures != EITHER:
            return unit_text
        found = self.names.sorts[str(statement.parts[0])].kind
        if found.is_difference:
            return difference_in(unit_text)
        return "degC" if found.unit == "degC" else unit_text

    def _make(self, statement: ParsedStatement, name: str, declaration: Declaration, node: Any) -> None:
        self.built.parts[name] = declaration
        self.built.note(statement, name, declaration.meaning.unit, declaration.meaning.words, node)
