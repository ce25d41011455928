"""Definitions and results of a sheet as statements: names, units, lists, functions, choices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from app.worksheets.importing.errors import Unnamed, Untranslatable
from app.worksheets.importing.expressions import Expressions
from app.worksheets.importing.judge import Judge, sort_of, unit_for
from app.worksheets.importing.names import Names, key_of, legal, look, symbol
from app.worksheets.importing.outcome import Outcome, one_line
from app.worksheets.importing.quantities import Scaled, is_infinite, result_of, scaled, unit_named
from app.worksheets.importing.regions import Original, OriginalSheet
from app.worksheets.importing.said import LOOSE, Axis, Said, listed, number
from app.worksheets.importing.scope import Choice, Failed, Function, Range, Scope, Value, Written
from app.worksheets.importing.trees import Node
from app.worksheets.importing.writer import MOST_ITEMS
from templates.core.language.template import Template
from templates.core.units.expressions import Sort
from templates.core.units.units import registry

RESERVED = frozenset(
    "if then else and or not is to so that over from within gives given choice curve solve require check test"
    " level ledger held published example source symbol remedy also with pi abs sqrt min max sin cos tan asin acos"
    " atan exp log log10 sinh cosh tanh atan2 floor ceil sum mean count index linear interpolated".split()
) | frozenset(name for name in dir(Template))


class Definitions:
    """The worksheet while it is written."""

    def __init__(self, sheet: OriginalSheet) -> None:
        self.sheet = sheet
        self.origin, self.is_labelled = sheet.origin, sheet.is_labelled
        self.scope: Scope = {}
        self.judge = Judge()
        self.names = Names(RESERVED)
        self.outcomes: dict[int, Outcome] = {}
        self._words = set[str]()
        self._owners: dict[str, Outcome] = {}  # outcomes of functions and curves, by region
        self._functions: list[Function] = []
        self._has_tags = any(region.tag for region in sheet.regions)
        self._fixed = frozenset(_structural(sheet))
        self._now: Outcome | None = None

    # What translation asks for

    def take(self, outcome: Outcome, math: Node) -> None:
        """Write the lines of a region that calculates.

        Raises
        ------
        Untranslatable, Unnamed
            It has no lines; the reason.
        """
        self._now = outcome
        self._owners[outcome.original.number] = outcome
        if not self.is_labelled:
            _label_units(math, self.scope)
        self._expect(outcome, math.parts[1] if math.tag == "define" and len(math.parts) > 1 else math)
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
            raise Untranslatable("region in which Mathcad reports an error", "correct or remove it")

    def fail(self, math: Node, number: str) -> None:
        """Note that the names which a region defines have no meaning."""
        if math.tag in ("define", "globalDefine") and math.parts:
            for key in _defined(math.parts[0]):
                self.scope[key] = Failed(number)

    def in_block(self, region: Original) -> list[Outcome]:
        """The regions of the same solve block."""
        return [o for o in self.outcomes.values() if o.original.block == region.block]

    def equation(self, region: Original) -> str:
        """A constraint as far as it can be written, for a remedy."""
        try:
            return Expressions(self, self.scope).condition(region.math).text if region.math else ""
        except (Untranslatable, Unnamed):
            return "left == right"

    def finish(self) -> None:
        """Write the functions that nothing calls, of plain numbers where that fits their units."""
        for function in self._functions:
            outcome = self._owners[function.region]
            if function.names or outcome.state != "unverified":
                continue
            try:
                plain = [Said("1", number=1.0) for _ in function.parameters]
                if self.function(function, plain) is not None:
                    outcome.notes.append("nothing calls it: its parameters are taken as pure numbers")
                    continue
            except (Untranslatable, Unnamed):
                pass
            if not outcome.lines:
                what = f"function {look(function.key)} whose units no call tells"
                outcome.refuse(
                    one_line(what), f"write it with its units: {legal(function.key)}(x [mm]) [1] = …"
                )

    # Sheets, which expressions ask

    def axis(self, length: int) -> Axis:
        """The axis of the vectors of a length."""
        return Axis(f"items_{length}", length, self.origin)

    def function(self, function: Function, arguments: Sequence[Said]) -> str | None:
        """The name of the statement of a function for arguments of these units; written at its first call."""
        sorts = [self.judge.sort(part.text, self.judge.bound) for part in arguments]
        units = tuple(
            "1" if part.is_truth else _parameter_unit(sort)
            for part, sort in zip(arguments, sorts, strict=True)
        )
        if units in function.names:
            return function.names[units] or None
        keys = function.parameters
        inner: Scope = dict(function.scope)
        own, parameters = Names(RESERVED | self.judge.sorts.keys() | self.judge.functions.keys()), list[str]()
        for key in keys:
            parameters.append(own.take(key))
            inner[key] = Written(Said(parameters[-1]))
        function.names[units] = ""  # a function that calls itself is written out, and refused as too deep
        bound = {name: sort_of(unit) for name, unit in zip(parameters, units, strict=True)}
        before, self.judge.bound = self.judge.bound, bound
        caller, self._now = self._now, self._owners[function.region]
        try:
            body = Expressions(self, inner).value(function.body)
            if body.axis is not None or not parameters:
                return None
            sort = self.judge.sort(body.text, bound)
            unit = unit_for(sort, self._asked(function.body))
        finally:
            self.judge.bound, self._now = before, caller
        name = self.names.take(function.key)
        function.names[units] = name
        self.judge.functions[name] = len(parameters), sort_of(unit)
        takes = ", ".join(f"{own} [{unit}]" for own, unit in zip(parameters, units, strict=True))
        self._owners[function.region].lines.append(f"{name}({takes}) [{unit}] = {body.text}")
        return name

    def curve(self, across: Said, up: Said) -> str:
        """The name of a curve through the points of two lists that are written out."""
        assert self._now is not None
        points = list(zip(_items(across), _items(up), strict=False))
        if len(points) < 2 or across.axis is None or up.axis is None or across.axis.length != up.axis.length:
            raise Untranslatable("interpolation in calculated lists", "write the points as a curve")
        x_unit = unit_for(self.judge.sort(_items(across)[0], self.judge.bound), [])
        y_unit = unit_for(self.judge.sort(_items(up)[0], self.judge.bound), [])
        name = self.names.take("interpolation")
        rows = [f"  {_in(x, x_unit)} -> {_in(y, y_unit)}" for x, y in points]
        heights = [row.rpartition(" ")[2] for row in rows]
        is_flat = heights[0] == heights[1] and heights[-1] == heights[-2]
        held = " (held)" if is_flat else ""  # where the ends are level, Mathcad's straight lines are so too
        head = f'curve {name}(x [{x_unit}]) [{y_unit}] "{self._said(name)}"{held}:'
        self._now.lines.append("\n".join([head, *rows]))
        if not is_flat:
            self._now.notes.append(
                "outside its points the curve has no value; Mathcad goes on along its ends"
            )
        self.judge.functions[name] = 1, sort_of(y_unit)
        return name

    # Definitions

    def _define(self, outcome: Outcome, target: Node, value: Node) -> None:
        match target.tag:
            case "id":
                self._single(outcome, target, value)
            case "function" if target.parts and target.parts[0].tag == "id":
                self._new_function(outcome, target, value)
            case "apply" if target.parts and target.parts[0].tag == "indexer":
                self._items_of(outcome, target, value)
            case "matrix":
                self._several(outcome, target, value)
            case _:
                raise Untranslatable("definition of what is no name", "give the result a name")

    def _single(self, outcome: Outcome, target: Node, value: Node) -> None:
        inner = _without_result(value)
        if inner.tag == "range":
            self._range(outcome, target, inner)
        elif inner.tag == "ComboBoxControl":
            self._choose(outcome, [target], inner)
        else:
            self._quantity(outcome, key_of(target), value)

    def _quantity(self, outcome: Outcome, key: str, value: Node) -> None:
        inner = _without_result(value)
        literal = scaled(inner)
        is_given = literal is not None and self._is_input(outcome.original, key)
        said = self._expression(inner)
        self._declare(outcome, key, said, self._asked(value, literal), is_given=is_given)

    def _is_input(self, region: Original, key: str) -> bool:
        return region.tag == "input" if self._has_tags else key not in self._fixed and not region.tag

    def _expression(self, node: Node) -> Said:
        at = Expressions(self, self.scope)
        if node.tag in ("matrix", "parens", "transpose"):
            return at.value(node)
        at.keep = self._keep
        return at.quantity(node) or at.value(node)

    def _keep(self, said: Said) -> Said:
        """A list within a formula gets a line of its own: only lists over one axis meet."""
        assert self._now is not None
        sort = self.judge.sort(said.text, None)
        unit, name = unit_for(sort, []), self.names.take("items")
        assert said.axis is not None
        self._now.lines.append(f'{name} [{unit}] over {said.axis.name} = {said.text} "{self._said(name)}"')
        self.judge.sorts[name] = sort_of(unit, said.axis.name)
        return replace(said, text=name)

    def _declare(
        self,
        outcome: Outcome,
        key: str,
        said: Said,
        wanted: Sequence[str],
        *,
        is_given: bool = False,
        words: str = "",
    ) -> Value:
        """Write the line of a value, and let the name mean it from here on."""
        sort = self.judge.sort(said.text, None)
        unit = unit_for(sort, wanted)
        name = self.names.take(key)
        if key in self.scope:
            outcome.notes.append(f"{look(key)} is defined again here: from here on it is {name}")
        axis = said.axis
        over = f" over {axis.name}" if axis else ""
        kind = "given " if is_given else ""
        clause = self._symbol(key, name)
        line = f'{kind}{name} [{unit}]{over} = {said.text} "{self._said(words or name)}"{clause}'
        outcome.lines.append(line)
        outcome.name = name
        self.judge.sorts[name] = sort_of(unit, axis.name if axis else "")
        known = None if is_given else said.number
        value = Value(
            name, axis, said.is_vector or axis is not None, said.is_row, known, outcome.original.number
        )
        self.scope[key] = value
        return value

    def _symbol(self, key: str, name: str) -> str:
        """A clause where the name has lost the look that it had."""
        made = symbol(key)
        return f' (symbol "{made}")' if made and (name != look(key)) else ""

    def _said(self, name: str) -> str:
        """Words that no other quantity has; they make its name in the interface."""
        words, count = name, 1
        while words.casefold() in self._words:
            count += 1
            words = f"{name} no {count}"
        self._words.add(words.casefold())
        return words

    def _asked(self, value: Node, literal: Scaled | None = None) -> list[str]:
        """Units to declare a value in: that which the region asks for, that in which it is typed."""
        asked = value.first("unitOverride") if value.tag == "eval" else None
        found = [scaled(asked.parts[0], is_unit=True)] if asked is not None and asked.parts else []
        units = []
        for made in (*found, literal):
            if made is not None and made.powers:
                try:
                    units.append(made.unit)
                except Untranslatable:
                    continue
        return units

    def _expect(self, outcome: Outcome, value: Node) -> None:
        """Keep Mathcad's own result, to be held against the value here.

        Raises
        ------
        Untranslatable
            It is a complex number, or infinity.
        """
        cached = outcome.original.cached
        if cached is None:
            return
        if any(part.tag in ("complex", "imag") for part in cached.parts):
            raise Untranslatable("complex number", "calculate with real and imaginary part")
        if any(part.tag == "real" and is_infinite(part.text) for part in cached.parts):
            raise Untranslatable("infinity", "give a number")
        asked = value.first("unitOverride") if value.tag == "eval" else None
        unit = asked.parts[0] if asked is not None and asked.parts else None
        outcome.cached = result_of(cached, unit, self.sheet.results_carry_units)

    def _new_function(self, outcome: Outcome, target: Node, value: Node) -> None:
        key = key_of(target.parts[0])
        bound = next((part for part in target.parts if part.tag == "boundVars"), None)
        parameters = tuple(key_of(part) for part in bound.parts) if bound else ()
        if len(set(parameters)) != len(parameters) or not all(parameters):
            raise Untranslatable("function without parameters", "write a formula")
        function = Function(
            key, parameters, _without_result(value), dict(self.scope), outcome.original.number
        )
        self._refuse_if_hopeless(function)
        self.scope[key] = function
        self._functions.append(function)

    def _refuse_if_hopeless(self, function: Function) -> None:
        """Name what a body has that no call can make good: a matrix, a loop, a name without meaning."""
        inner: Scope = dict(function.scope)
        for key in function.parameters:
            inner[key] = Written(Said("1", axis=None))
        before = self._now
        trial = _Trial(self)
        try:
            Expressions(trial, inner).value(function.body)
        except Untranslatable as error:
            if error.construct in _HOPELESS:
                raise
        finally:
            self._now = before

    def _range(self, outcome: Outcome, target: Node, node: Node) -> None:
        key = key_of(target)
        numbers = self._numbers(node)
        axis = replace(self.axis(len(numbers)), start=int(numbers[0]), numbers=numbers)
        said = Said(f"[{', '.join(number(n).text for n in numbers)}]", axis=axis)
        value = self._declare(outcome, key, said, ["1"])
        self.scope[key] = Range(value.name, axis)

    def _numbers(self, node: Node) -> tuple[float, ...]:
        if len(node.parts) != 2:
            raise Untranslatable("range without an end", "give its values as a list")
        first, last = node.parts
        ends = list(first.parts) if first.tag == "sequence" else [first]
        at = Expressions(self, self.scope)
        known = [at.said(end).number for end in (*ends, last)]
        numbers = [n for n in known if n is not None]
        if len(numbers) != len(known):
            raise Untranslatable("range with calculated ends", "give its values as a list")
        start, end = numbers[0], numbers[-1]
        step = numbers[1] - start if len(numbers) == 3 else 1.0 if end >= start else -1.0
        count = int((end - start) / step + 1e-9) + 1 if step else 0
        if not 1 <= count <= MOST_ITEMS:
            raise Untranslatable(f"range of more than {MOST_ITEMS} values", "give fewer values")
        return tuple(start + n * step for n in range(count))

    def _items_of(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Items of a list along a range: all of them at once."""
        if len(target.parts) == 3 and target.parts[1].tag == "id" and target.parts[2].tag == "real":
            self._one_item(outcome, target, value)
            return
        if len(target.parts) != 3 or target.parts[1].tag != "id" or target.parts[2].tag != "id":
            raise Untranslatable("single items defined one by one", "write the list with all its items")
        key, along = key_of(target.parts[1]), self.scope.get(key_of(target.parts[2]))
        if isinstance(along, Failed):
            raise Unnamed(key_of(target.parts[2]), along.region)
        if not isinstance(along, Range):
            raise Untranslatable("single items defined one by one", "write the list with all its items")
        steps = {b - a for a, b in zip(along.axis.numbers, along.axis.numbers[1:], strict=False)}
        if steps - {1.0} or along.axis.start < self.origin:
            raise Untranslatable("list with gaps", "write the list with all its items")
        if any(key_of(node) == key for node in value.all("id")):
            raise Untranslatable("recurrence", "write its closed form")
        said = self._expression(_without_result(value))
        if said.is_vector:
            raise Untranslatable("list of lists", "write each as a list of its own")
        if said.axis is None:
            said = listed((said,) * along.axis.length, along.axis)
        axis = replace(along.axis, numbers=())
        self._declare(outcome, key, replace(said, axis=axis, is_vector=True), self._asked(value))

    def _one_item(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Another value for one item of a list that is there: the list is written anew, and so is its name."""
        key = key_of(target.parts[1])
        whole = self.scope.get(key)
        if isinstance(whole, Failed):
            raise Unnamed(key, whole.region)
        at = Expressions(self, self.scope).said(target.parts[2]).number
        if not isinstance(whole, Value) or whole.axis is None or at is None or whole.axis.length > 100:
            raise Untranslatable("single items defined one by one", "write the list with all its items")
        place = int(at) - whole.axis.start
        if not 0 <= place < whole.axis.length:
            raise Untranslatable("list that grows", "write the list with all its items")
        items = [Said(f"{whole.name}[{n}]") for n in range(1, whole.axis.length + 1)]
        items[place] = self._expression(_without_result(value))
        self._declare(outcome, key, listed(tuple(items), whole.axis), self._asked(value))
        outcome.name = ""

    def _several(self, outcome: Outcome, target: Node, value: Node) -> None:
        """Several names at once: of the items of a list, or of the columns of a combo box."""
        targets = target.parts
        if not all(part.tag == "id" for part in targets):
            raise Untranslatable("items defined one by one", "write the list with all its items")
        inner = _without_result(value)
        if inner.tag == "ComboBoxControl":
            self._choose(outcome, targets, inner)
            return
        said = self._expression(inner)
        if said.axis is None or said.axis.length != len(targets):
            raise Untranslatable("names for the items of what is no list of as many", "define each by itself")
        if not said.text.isidentifier() and not said.text.startswith("["):
            said = self._declare(outcome, "items", said, self._asked(value)).said()
        for place, part in enumerate(targets, 1):
            text = said.text if said.text.isidentifier() else f"({said.text})"
            item = (
                Said(f"{text}[{place}]") if said.text.isidentifier() else Said(_items(said)[place - 1], LOOSE)
            )
            self._declare(outcome, key_of(part), item, self._asked(value))
        outcome.name = ""

    def _choose(self, outcome: Outcome, targets: Sequence[Node], control: Node) -> None:
        """A combo box: a choice among its rows, and the values of the chosen row."""
        rows, columns, chosen = (_count(control, key) for key in ("rows", "cols", "SelectedRow"))
        holder = control.first("ComboBoxValues")
        cells = list(holder.parts) if holder else []
        if not 1 < rows <= 50 or columns != len(targets) or len(cells) != rows * columns or chosen >= rows:
            raise Untranslatable("combo box without rows", "write a choice")
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
        outcome.lines.append(f'choice {name} = {words[chosen]} "{self._said(name)}" ({" | ".join(words)})')
        self.judge.sorts[name] = Sort(words=tuple(words))
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
            self._declare(outcome, key_of(target), Said(text + values[-1].text, LOOSE), [])
        outcome.name = ""

    # Results

    def _result(self, outcome: Outcome, math: Node) -> None:
        """A region that shows a result: of a name, or of a formula, which gets a line."""
        inner = math.parts[0]
        at = Expressions(self, self.scope)
        while inner.tag == "parens" and inner.parts:
            inner = inner.parts[0]
        if inner.tag == "id" and isinstance(value := self.scope.get(key_of(inner)), Value):
            if inner.attributes.get("labels") not in ("CONSTANT", "UNIT"):
                outcome.name = value.name
                return
        said = at.quantity(inner) or at.value(inner)
        self._declare(outcome, f"result_{outcome.original.number}", said, self._asked(math))
        del self.scope[f"result_{outcome.original.number}"]


class _Trial:
    """Answers what an expression asks of a sheet, and writes nothing."""

    def __init__(self, sheet: Definitions) -> None:
        self.origin, self.is_labelled = sheet.origin, sheet.is_labelled
        self.axis = sheet.axis

    def function(self, function: Function, arguments: Sequence[Said]) -> str | None:
        """A name that nothing has."""
        return "call"

    def curve(self, across: Said, up: Said) -> str:
        """A name that nothing has."""
        return "curve"


_HOPELESS = frozenset({
    "integral", "derivative", "limit", "loop", "symbolic calculation", "text", "complex number", "try and catch",
    "matrix", "matrix product", "matrix function", "solve block", "condition without otherwise", "spline", "file",
    "random numbers", "statistical function", "item of a matrix", "column of a matrix", "row of a matrix",
})  # fmt: skip


def _label_units(math: Node, scope: Scope) -> None:
    """Say which names are units, as Mathcad Prime does: those that nothing defines, above or in the region."""
    own = set(_defined(math.parts[0])) if math.tag == "define" and math.parts else set[str]()
    for tag in ("boundVars", "localDefine"):
        own.update(key_of(name) for node in math.all(tag) for name in node.parts if name.tag == "id")
    for node in math.all("id"):
        key = key_of(node)
        if key not in scope and key not in own and unit_named(key) is not None:
            node.attributes.setdefault("labels", "UNIT")


def _without_result(node: Node) -> Node:
    return node.parts[0] if node.tag == "eval" and node.parts else node


def _defined(target: Node) -> Iterator[str]:
    """The names that a definition gives a meaning."""
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


def _structural(sheet: OriginalSheet) -> Iterator[str]:
    """Names that say how long lists are: their values are fixed when the sheet is imported."""
    for region in sheet.regions:
        if region.math is None:
            continue
        for tag in ("range", "lowerBound", "upperBound"):
            for node in region.math.all(tag):
                yield from (key_of(name) for name in node.all("id"))
        for node in region.math.all("apply"):
            if len(node.parts) == 3 and node.parts[0].tag == "indexer":
                yield from (key_of(name) for name in node.parts[2].all("id"))


def _count(node: Node, key: str) -> int:
    text = node.attributes.get(key, "")
    return int(text) if text.isdecimal() and text.isascii() and len(text) < 7 else 0


def _parameter_unit(sort: Sort) -> str:
    unit = unit_for(sort, [])
    return "1" if sort.kind.base == registry.Unit("") else unit


def _items(said: Said) -> list[str]:
    """The items of a list that is written out; none of another."""
    if not said.text.startswith("["):
        return []
    items, depth, start = [], 0, 1
    for place, sign in enumerate(said.text):
        depth += (sign in "[(") - (sign in "])")
        if (sign == "," and depth == 1) or place == len(said.text) - 1:
            items.append(said.text[start:place].strip())
            start = place + 1
    return items


def _in(text: str, unit_text: str) -> str:
    from templates.core.units.expressions import constant
    from templates.core.units.units import unit

    try:
        value = float(unit(unit_text).from_si(constant(text).value))
    except ValueError:
        raise Untranslatable("interpolation in calculated lists", "write the points as a curve") from None
    return number(value).text


def _word(text: str) -> str:
    return f"row_{text}" if text[:1].isdigit() or not text else text.lower()
