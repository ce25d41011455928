"""Conditions, and Mathcad programs that only distinguish cases: `if … then … else …`."""

from __future__ import annotations

from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.names import key_of
from app.worksheets.imports.scope import Choice, InlineTerm, Scope
from app.worksheets.imports.terms import ATOM, LOOSE, SUM, Term
from app.worksheets.imports.trees import Node
from app.worksheets.imports.writer import Writer

COMPARED = {"lessThan": "<", "lessOrEqual": "<=", "greaterThan": ">", "greaterOrEqual": ">=",
            "equal": "==", "notEqual": "!="}  # fmt: skip

_JOINED = {
    "and": "{0} and {1}",
    "or": "{0} or {1}",
    "xor": "({0} and not {1}) or ({1} and not {0})",
    "not": "not {0}",
}


class Conditions(Writer):
    """Writes conditions and case distinctions."""

    def value(self, node: Node) -> Term:
        """Return a tree as a quantity; a condition becomes 1 if it holds and 0 otherwise."""
        term = self.term(node)
        if not term.is_truth:
            return term
        return Term(f"if {term.text} then 1 else 0", LOOSE).shaped(term)

    def condition(self, node: Node) -> Term:
        """Return a tree as a condition; a number becomes the condition that it is not 0."""
        if node.tag == "parens" and node.parts:
            return self.condition(node.parts[0])
        sign = node.parts[0].tag if node.tag == "apply" and node.parts else ""
        sides = node.parts[1:]
        if sign in COMPARED and len(sides) == 2:
            return self._compared(COMPARED[sign], *sides)
        if sign in _JOINED and len(sides) == (1 if sign == "not" else 2):
            parts = [self.condition(side) for side in sides]
            text = _JOINED[sign].format(*(part.bound(ATOM) for part in parts))
            return Term(text, LOOSE, is_truth=True).shaped(*parts)
        term = self.term(node)
        if term.is_truth:
            return term
        return Term(f"{term.bound(SUM)} != 0", LOOSE, is_truth=True).shaped(term)

    def _compared(self, sign: str, left: Node, right: Node) -> Term:
        if word := self._tested(left, right) or self._tested(right, left):
            return Term(f"not ({word})" if sign == "!=" else word, LOOSE, is_truth=True)
        one, other = self.term(left), self.value(right)
        start = one.text if one.is_truth else one.bound(SUM)  # continues a chain such as 1 < x <= 2
        return Term(f"{start} {sign} {other.bound(SUM)}", LOOSE, is_truth=True).shaped(one, other)

    def _tested(self, choice: Node, text: Node) -> str:
        meant = self.scope.get(key_of(choice)) if choice.tag == "id" else None
        if not isinstance(meant, Choice) or text.tag != "str" or text.text not in meant.words:
            return ""
        return f"{meant.name} is {meant.words[text.text]}"

    def either(self, test: Term, one: Node, other: Node) -> Term:
        """Return an expression that selects one of two values by a condition."""
        then, otherwise = self.value(one), self.value(other)
        text = f"if {test.text} then {then.bound(SUM)} else {otherwise.text}"
        return Term(text, LOOSE).shaped(test, then, otherwise)

    def program(self, parts: list[Node]) -> Term:
        """Return the value of a program; local names are replaced by their expressions."""
        parts = [part for part in parts if part.tag != "placeholder"]
        inner: Scope = dict(self.scope)
        for place, part in enumerate(parts):
            if part.tag == "localDefine" and len(part.parts) == 2 and part.parts[0].tag == "id":
                inner[key_of(part.parts[0])] = InlineTerm(self.within(inner).value(part.parts[1]))
                continue
            at = self.within(inner)
            if part.tag in ("if", "elseif", "alsoif", "else"):
                return at.chain(parts[place:])
            if part.tag == "return" and part.parts:
                return at.value(part.parts[0])
            if place == len(parts) - 1:
                return at.value(part)
            at.term(part)  # raises an error that names the refused construct
            raise Untranslatable("the program returns several values", "write one formula")
        raise Untranslatable("the program returns no value", "write one formula")

    def chain(self, parts: list[Node]) -> Term:
        """Return successive conditions as one expression; without a final `else` it may have no value."""
        branches: list[tuple[Node, Node]] = []
        waiting = list(parts)
        while waiting:
            part = waiting.pop(0)
            inner = {child.tag: child for child in part.parts}
            if part.tag in ("if", "elseif", "alsoif") and "test" in inner and "then" in inner:
                branches.append((inner["test"].parts[0], inner["then"].parts[0]))
                waiting = [
                    child for child in part.parts if child.tag in ("elseif", "alsoif", "else")
                ] + waiting
            elif part.tag == "else" and part.parts and not waiting:
                return self._cases(branches, part.parts[0])
            else:
                raise Untranslatable(
                    "the program returns several values", "write one formula with `if … then … else …`"
                )
        remedy = "add the otherwise case in Mathcad or in the line"
        raise Untranslatable("the condition has no `otherwise` branch", remedy)

    def _cases(self, branches: list[tuple[Node, Node]], last: Node) -> Term:
        otherwise = self.value(last)
        for test, then in reversed(branches):
            held, value = self.condition(test), self.value(then)
            text = f"if {held.text} then {value.bound(SUM)} else {otherwise.text}"
            otherwise = Term(text, LOOSE).shaped(held, value, otherwise)
        return otherwise
