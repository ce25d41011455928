"""Mathcad's lists: vectors, their items, values along a range, and sums over an index."""

from __future__ import annotations

from dataclasses import replace

from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.names import key_of
from app.worksheets.imports.scope import InlineTerm, Scope
from app.worksheets.imports.terms import PRODUCT, Term, binary, listed, number, reduced
from app.worksheets.imports.trees import Node
from app.worksheets.imports.writer import MOST_ITEMS, Writer


class Lists(Writer):
    """Writes lists and sums."""

    def matrix(self, node: Node) -> Term:
        """Return a vector as a list; refuse other matrices."""
        parts = [part for part in node.parts if part.tag != "display"]
        rows, columns = node.attributes.get("rows"), node.attributes.get("cols")
        if "1" not in (rows, columns) or not parts:
            raise Untranslatable("matrix", "write its rows or columns as lists")
        if len(parts) == 1:
            return self.term(parts[0])
        if len(parts) > MOST_ITEMS:
            raise Untranslatable(
                f"the list has more than {MOST_ITEMS} items", "give it as an input over an axis"
            )
        items = tuple(self.quantity(part) or self.term(part) for part in parts)
        if any(item.axis for item in items):
            raise Untranslatable("list of lists", "write each of them as a separate list")
        term = listed(items, self.sheet.axis(len(items)))
        term = replace(term, is_row=columns != "1")
        return term if self.keep is None else self.keep(term)

    def transposed(self, part: Term) -> Term:
        """Return a vector as a row, or a row as a vector."""
        if not part.is_vector:
            raise Untranslatable("matrix", "write its items as lists")
        return replace(part, is_row=not part.is_row)

    def item(self, whole: Node, index: Node) -> Term:
        """Return an item of a list, or its items along a range."""
        if index.tag == "sequence":
            raise Untranslatable("the formula uses an item of a matrix", "write its rows or columns as lists")
        term, at = self.term(whole), self.term(index)
        if term.axis is None:
            raise Untranslatable("the indexed value is not a list", "define the list above")
        if at.axis is not None:
            return self._along(term, at)
        if at.number is None or at.number != int(at.number):
            raise Untranslatable("the index is calculated", "write the index as a number")
        place = int(at.number) + 1 - term.axis.start
        if not 1 <= place <= term.axis.length:
            raise Untranslatable("the index exceeds the length of the list", "write an index within the list")
        if not term.text.replace("_", "").isalnum() and not term.text.startswith("["):
            raise Untranslatable("the formula indexes an expression", "define the list by a name first")
        return Term(f"{term.text}[{place}]")

    def _along(self, term: Term, at: Term) -> Term:
        """Return the items of a list whose indices are the values of a range."""
        assert term.axis is not None
        assert at.axis is not None
        numbers = at.axis.numbers
        wanted = tuple(float(term.axis.start + n) for n in range(term.axis.length))
        is_index = self.is_counting or at.text.replace("_", "").isalnum()
        if not is_index or numbers != wanted:
            raise Untranslatable("the formula uses a part of a list", "write the part as a separate list")
        return replace(term, is_vector=False, is_row=False, axis=replace(at.axis, start=term.axis.start))

    def summed(self, parts: list[Node]) -> Term:
        """Return a sum over an index, or the sum of a list."""
        function = next((part for part in parts if part.tag == "lambda"), None)
        bounds = {part.tag: part.parts[0] for part in parts if part.parts and part.tag.endswith("Bound")}
        if function is None or len(function.parts) != 2:
            raise Untranslatable("the sum has no term", "write it out")
        variable, body = function.parts[0].parts[0], function.parts[1]
        if variable.tag != "id":
            term = self.value(body)
            if not term.is_vector:
                raise Untranslatable("the sum needs a list", "write it out")
            return reduced("sum", term)
        if "lowerBound" not in bounds or "upperBound" not in bounds:
            raise Untranslatable("the sum runs over a range variable", "give its bounds, or sum the list")
        numbers = self._counted(self.term(bounds["lowerBound"]), self.term(bounds["upperBound"]))
        axis = replace(self.sheet.axis(len(numbers)), numbers=numbers)
        literal = f"[{', '.join(number(n).text for n in numbers)}]"
        inner: Scope = {**self.scope, key_of(variable): InlineTerm(Term("index", axis=axis))}
        term = self.within(inner).value(body)
        if "index" in term.text.replace("(", " ").replace(")", " ").split():
            inner[key_of(variable)] = InlineTerm(Term(literal, axis=axis))
            term = replace(self, scope=inner, is_counting=True).value(body)
        if term.axis is None:
            return binary(number(len(numbers)), "*", term, PRODUCT)
        return reduced("sum", term)

    def _counted(self, first: Term, last: Term) -> tuple[float, ...]:
        if first.number is None or last.number is None:
            raise Untranslatable("the range of the sum is calculated", "write its bounds as numbers")
        count = int(last.number - first.number) + 1
        if not 1 <= count <= MOST_ITEMS or first.number != int(first.number):
            raise Untranslatable(f"the sum has more than {MOST_ITEMS} terms", "write its closed form")
        return tuple(first.number + n for n in range(count))
