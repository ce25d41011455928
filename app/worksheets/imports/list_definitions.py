"""Definitions of ranges, of lists and their items, of several names at once, and combo boxes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.worksheets.imports.errors import Unnamed, Untranslatable
from app.worksheets.imports.expressions import Expressions
from app.worksheets.imports.names import Names, key_of
from app.worksheets.imports.outcome import Outcome
from app.worksheets.imports.scope import Choice, FailedName, Range, Value
from app.worksheets.imports.statements import RESERVED, Statements, items_in, without_result
from app.worksheets.imports.terms import LOOSE, Term, listed, number
from app.worksheets.imports.trees import Node
from app.worksheets.imports.writer import MOST_ITEMS
from templates.core.units.expressions import Sort


class ListDefinitions(Statements):
    """Translates definitions of lists and choices."""

    def range_of(self, outcome: Outcome, target: Node, node: Node) -> None:
        """Translate a range variable into a list."""
        key = key_of(target)
        numbers = self._numbers(node)
        axis = replace(self.axis(len(numbers)), start=int(numbers[0]), numbers=numbers)
        term = Term(f"[{', '.join(number(n).text for n in numbers)}]", axis=axis)
        value = self.declare(outcome, key, term, ["1"])
        self.scope[key] = Range(value.name, axis)

    def _numbers(self, node: Node) -> tuple[float, ...]:
        if len(node.parts) != 2:
            raise Untranslatable("the range has no end", "write its values as a list")
        first, last = node.parts
        ends = list(first.parts) if first.tag == "sequence" else [first]
        at = Expressions(self, self.scope)
        constants = [at.term(end).number for end in (*ends, last)]
        numbers = [n for n in constants if n is not None]
        if len(numbers) != len(constants):
            raise Untranslatable("the ends of the range are calculated", "write its values as a list")
        start, end = numbers[0], numbers[-1]
        step = numbers[1] - start if len(numbers) == 3 else 1.0 if end >= start else -1.0
        count = int((end - start) / step + 1e-9) + 1 if step else 0
        if not 1 <= count <= MOST_ITEMS:
            raise Untranslatable(f"the range has more than {MOST_ITEMS} values", "give fewer values")
        return tuple(start + n * step for n in range(count))

    def items_of(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Translate the definition of all items of a list along a range."""
        if len(target.parts) == 3 and target.parts[1].tag == "id" and target.parts[2].tag == "real":
            self._one_item(outcome, target, value)
            return
        if len(target.parts) != 3 or target.parts[1].tag != "id" or target.parts[2].tag != "id":
            raise Untranslatable("the list is defined item by item", "write the list with all its items")
        key, along = key_of(target.parts[1]), self.scope.get(key_of(target.parts[2]))
        if isinstance(along, FailedName):
            raise Unnamed(key_of(target.parts[2]), along.region)
        if not isinstance(along, Range):
            raise Untranslatable("the list is defined item by item", "write the list with all its items")
        steps = {b - a for a, b in zip(along.axis.numbers, along.axis.numbers[1:], strict=False)}
        if steps - {1.0} or along.axis.start < self.origin:
            raise Untranslatable("the list has gaps", "write the list with all its items")
        if any(key_of(node) == key for node in value.all("id")):
            raise Untranslatable("recurrence", "write its closed form")
        term = self.expression(without_result(value))
        if term.is_vector:
            raise Untranslatable("list of lists", "write each of them as a separate list")
        if term.axis is None:
            term = listed((term,) * along.axis.length, along.axis)
        axis = replace(along.axis, numbers=())
        self.declare(outcome, key, replace(term, axis=axis, is_vector=True), self.asked(value))

    def _one_item(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Translate the assignment of one item of a list, which gives a new list."""
        key = key_of(target.parts[1])
        whole = self.scope.get(key)
        if isinstance(whole, FailedName):
            raise Unnamed(key, whole.region)
        at = Expressions(self, self.scope).term(target.parts[2]).number
        if not isinstance(whole, Value) or whole.axis is None or at is None or whole.axis.length > 100:
            raise Untranslatable("the list is defined item by item", "write the list with all its items")
        place = int(at) - whole.axis.start
        if not 0 <= place < whole.axis.length:
            raise Untranslatable("the list grows", "write the list with all its items")
        items = [Term(f"{whole.name}[{n}]") for n in range(1, whole.axis.length + 1)]
        items[place] = self.expression(without_result(value))
        self.declare(outcome, key, listed(tuple(items), whole.axis), self.asked(value))
        outcome.name = ""

    def several(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Translate a definition of several names by the items of a list, or the columns of a combo box."""
        targets = target.parts
        if not all(part.tag == "id" for part in targets):
            raise Untranslatable("the list is defined item by item", "write the list with all its items")
        inner = without_result(value)
        if inner.tag == "ComboBoxControl":
            self.choose(outcome, targets, inner)
            return
        term = self.expression(inner)
        if term.axis is None or term.axis.length != len(targets):
            raise Untranslatable(
                "the number of names differs from the length of the list", "define each name separately"
            )
        if not term.text.isidentifier() and not term.text.startswith("["):
            term = self.declare(outcome, "items", term, self.asked(value)).term()
        for place, part in enumerate(targets, 1):
            text = term.text if term.text.isidentifier() else f"({term.text})"
            item = (
                Term(f"{text}[{place}]")
                if term.text.isidentifier()
                else Term(items_in(term)[place - 1], LOOSE)
            )
            self.declare(outcome, key_of(part), item, self.asked(value))
        outcome.name = ""

    def choose(self, outcome: Outcome, targets: Sequence[Node], control: Node) -> None:
        """Translate a combo box into a choice among its rows, and the values of the chosen row."""
        rows, columns, chosen = (_count(control, key) for key in ("rows", "cols", "SelectedRow"))
        holder = control.first("ComboBoxValues")
        cells = list(holder.parts) if holder else []
        if not 1 < rows <= 50 or columns != len(targets) or len(cells) != rows * columns or chosen >= rows:
            raise Untranslatable("the combo box has no rows", "write a choice")
        names = control.first("ComboBoxRowNames")
        given = [part.whole_text.strip() for part in names.parts] if names else []
        texts = [
            given[row] if row < len(given) and given[row] else cells[row * columns].text
            for row in range(rows)
        ]
        own = Names(frozenset(RESERVED))
        words = [own.take(_word(text)) for text in texts]
        key = "_".join(key_of(part) for part in targets)
        is_text = columns == 1 and all(cell.tag == "str" for cell in cells)
        name = self.names.take(key if is_text else f"{key}_row")
        outcome.lines.append(
            f'choice {name} = {words[chosen]} "{self.words_for(name)}" ({" | ".join(words)})'
        )
        self.declared.sorts[name] = Sort(words=tuple(words))
        if is_text:
            self.scope[key] = Choice(name, dict(zip((c.text for c in cells), words, strict=True)))
            return
        at = Expressions(self, self.scope)
        for column, target in enumerate(targets):
            values = [at.quantity(c) or at.value(c) for c in cells[column::columns]]
            text = "".join(
                f"if {name} is {word} then {value.text} else "
                for word, value in zip(words[:-1], values[:-1], strict=True)
            )
            self.declare(outcome, key_of(target), Term(text + values[-1].text, LOOSE), [])
        outcome.name = ""


def _count(node: Node, key: str) -> int:
    text = node.attributes.get(key, "")
    return int(text) if text.isdecimal() and text.isascii() and len(text) < 7 else 0


def _word(text: str) -> str:
    return f"row_{text}" if text[:1].isdigit() or not text else text.lower()
