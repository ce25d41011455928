"""Translate definitions and results of a sheet into statements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from app.worksheets.imports.errors import Unnamed, Untranslatable
from app.worksheets.imports.expressions import Expressions
from app.worksheets.imports.list_definitions import ListDefinitions
from app.worksheets.imports.names import key_of, legal, look
from app.worksheets.imports.outcome import Outcome, one_line
from app.worksheets.imports.quantities import scaled
from app.worksheets.imports.regions import Original
from app.worksheets.imports.scope import FailedName, Function, InlineTerm, Scope, Value
from app.worksheets.imports.statements import without_result
from app.worksheets.imports.terms import Term
from app.worksheets.imports.trees import Node
from app.worksheets.imports.unit_names import label_units


class Definitions(ListDefinitions):
    """Translates the regions that define or show values."""

    def take(self, outcome: Outcome, math: Node) -> None:
        """Write the lines for a region that calculates.

        Raises
        ------
        Untranslatable, Unnamed
            If it cannot be written as lines; the error gives the reason.
        """
        self.now = outcome
        self.owners[outcome.original.number] = outcome
        label_units(math, self.scope.keys() | _own_names(math), self.letters)
        self.expect(outcome, math.parts[1] if math.tag == "define" and len(math.parts) > 1 else math)
        match math.tag, math.parts:
            case "define" | "globalDefine", [target, value]:
                self._define(outcome, target, value)
            case "eval", [*_]:
                self._result(outcome, math)
            case "apply", [operator, *_] if operator.tag == "equal":
                outcome.show("equation that calculates nothing")
            case "symEval", _:
                raise Untranslatable("symbolic calculation", "write its result as a formula")
            case tag, _ if tag.endswith("Control"):
                outcome.show("control that defines nothing")
            case _:
                outcome.show("expression without a result")
        if outcome.original.failed and outcome.state != "shown":
            raise Untranslatable("Mathcad reports an error in this region", "correct or remove it")

    def fail(self, math: Node, number: str) -> None:
        """Record that the names defined by a region have no meaning."""
        if math.tag in ("define", "globalDefine") and math.parts:
            for key in _defined(math.parts[0]):
                self.scope[key] = FailedName(number)

    def in_block(self, region: Original) -> list[Outcome]:
        """Return the outcomes of the regions in the same solve block."""
        return [o for o in self.outcomes.values() if o.original.block == region.block]

    def equation(self, region: Original) -> str:
        """Return a constraint as text for a remedy, or a placeholder if it cannot be written."""
        try:
            return Expressions(self, self.scope).condition(region.math).text if region.math else ""
        except (Untranslatable, Unnamed):
            return "left == right"

    def finish(self) -> None:
        """Write the functions that are never called, with pure numbers as parameters if that is possible."""
        for function in self.functions:
            outcome = self.owners[function.region]
            if function.names or outcome.state != "unverified":
                continue
            try:
                plain = [Term("1", number=1.0) for _ in function.parameters]
                if self.function(function, plain) is not None:
                    outcome.notes.append(
                        "it is never called, so its parameters are assumed to be pure numbers"
                    )
                    continue
            except (Untranslatable, Unnamed):
                pass
            if not outcome.lines:
                what = f"function {look(function.key)} that is never called, so that its units are unknown"
                outcome.refuse(
                    one_line(what), f"write it with its units: {legal(function.key)}(x [mm]) [1] = …"
                )

    def _define(self, outcome: Outcome, target: Node, value: Node) -> None:
        match target.tag:
            case "id":
                self._single(outcome, target, value)
            case "function" if target.parts and target.parts[0].tag == "id":
                self._new_function(outcome, target, value)
            case "apply" if target.parts and target.parts[0].tag == "indexer":
                self.items_of(outcome, target, value)
            case "matrix":
                self.several(outcome, target, value)
            case _:
                raise Untranslatable(
                    "the left side of the definition is not a name", "give the result a name"
                )

    def _single(self, outcome: Outcome, target: Node, value: Node) -> None:
        inner = without_result(value)
        if inner.tag == "range":
            self.range_of(outcome, target, inner)
        elif inner.tag == "ComboBoxControl":
            self.choose(outcome, [target], inner)
        else:
            self._quantity(outcome, key_of(target), value)

    def _quantity(self, outcome: Outcome, key: str, value: Node) -> None:
        inner = without_result(value)
        literal = scaled(inner)
        is_given = literal is not None and self._is_input(outcome.original, key)
        term = self.expression(inner)
        self.declare(outcome, key, term, self.asked(value, literal), is_given=is_given)

    def _is_input(self, region: Original, key: str) -> bool:
        return region.tag == "input" if self.has_tags else key not in self.fixed and not region.tag

    def _new_function(self, outcome: Outcome, target: Node, value: Node) -> None:
        key = key_of(target.parts[0])
        bound = next((part for part in target.parts if part.tag == "boundVars"), None)
        parameters = tuple(key_of(part) for part in bound.parts) if bound else ()
        if len(set(parameters)) != len(parameters) or not all(parameters):
            raise Untranslatable("the function has no parameters", "write a formula")
        function = Function(key, parameters, without_result(value), dict(self.scope), outcome.original.number)
        self._refuse_if_hopeless(function)
        self.scope[key] = function
        self.functions.append(function)

    def _refuse_if_hopeless(self, function: Function) -> None:
        """Refuse a function whose body has a construct that no call can make valid, such as a matrix."""
        inner: Scope = dict(function.scope)
        for key in function.parameters:
            inner[key] = InlineTerm(Term("1", axis=None))
        before = self.now
        trial = _Trial(self)
        try:
            Expressions(trial, inner).value(function.body)
        except Untranslatable as error:
            if error.construct in _HOPELESS:
                raise
        finally:
            self.now = before

    def _result(self, outcome: Outcome, math: Node) -> None:
        """Translate a region that shows the result of a name, or of a formula, which gets its own line."""
        inner = math.parts[0]
        at = Expressions(self, self.scope)
        while inner.tag == "parens" and inner.parts:
            inner = inner.parts[0]
        if inner.tag == "id" and isinstance(value := self.scope.get(key_of(inner)), Value):
            if inner.attributes.get("labels") not in ("CONSTANT", "UNIT"):
                outcome.name = value.name
                return
        term = at.quantity(inner) or at.value(inner)
        self.declare(outcome, f"result_{outcome.original.number}", term, self.asked(math))
        del self.scope[f"result_{outcome.original.number}"]


class _Trial:
    """Stands in for a sheet while an expression is tried, without writing any line."""

    def __init__(self, sheet: Definitions) -> None:
        self.origin = sheet.origin
        self.axis = sheet.axis

    def function(self, function: Function, arguments: Sequence[Term]) -> str | None:
        """Return a placeholder name."""
        return "call"

    def curve(self, across: Term, up: Term) -> str:
        """Return a placeholder name."""
        return "curve"


_HOPELESS = frozenset({
    "integral", "derivative", "limit", "loop", "symbolic calculation", "text", "complex number",
    "try and catch",
    "matrix", "matrix product", "matrix function", "solve block", "the condition has no `otherwise` branch",
    "spline",
    "file",
    "random numbers", "statistical function", "the formula uses an item of a matrix",
    "the formula uses a column of a matrix", "the formula uses a row of a matrix",
})  # fmt: skip


def _own_names(math: Node) -> set[str]:
    """Return the names that a region itself defines: definitions, parameters, local names."""
    own = (
        set(_defined(math.parts[0])) if math.tag in ("define", "globalDefine") and math.parts else set[str]()
    )
    for tag in ("boundVars", "localDefine"):
        own.update(key_of(name) for node in math.all(tag) for name in node.parts if name.tag == "id")
    return own


def _defined(target: Node) -> Iterator[str]:
    """Yield the names that the left side of a definition defines."""
    match target.tag, target.parts:
        case "id", _:
            yield key_of(target)
        case "function", [name, *_]:
            yield key_of(name)
        case "apply", [_, name, *_]:
            yield from _defined(name)
        case "matrix", parts:
            for part in parts:
                yield from _defined(part)
