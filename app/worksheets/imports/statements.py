"""Write the lines of a worksheet: names, units, descriptions, functions, curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from app.worksheets.imports.declarations import Declarations, sort_of, unit_for
from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.expressions import Expressions
from app.worksheets.imports.names import Names, key_of, look, symbol
from app.worksheets.imports.outcome import Outcome
from app.worksheets.imports.quantities import ScaledNumber, is_infinite, result_of, scaled
from app.worksheets.imports.regions import OriginalSheet
from app.worksheets.imports.scope import Function, InlineTerm, Scope, Value
from app.worksheets.imports.terms import Axis, Term, number
from app.worksheets.imports.trees import Node
from app.worksheets.imports.unit_names import letters_of
from templates.core.language.template import Template
from templates.core.units.expressions import Sort, constant
from templates.core.units.units import is_rate, registry, unit

RESERVED = frozenset(
    "if then else and or not is to so that over from within gives given choice curve solve require check test"
    " level ledger held published example source symbol remedy also with pi abs sqrt min max"
    " sin cos tan asin acos atan exp log log10 sinh cosh tanh atan2 floor ceil sum mean"
    " count index linear interpolated".split()
) | frozenset(name for name in dir(Template))


class Statements:
    """A worksheet while it is being written."""

    def __init__(self, sheet: OriginalSheet) -> None:
        self.sheet = sheet
        self.origin = sheet.origin
        self.scope: Scope = {}
        self.letters = letters_of(sheet.regions)
        self.declared = Declarations()
        self.names = Names(RESERVED)
        self.outcomes: dict[int, Outcome] = {}
        self._words = set[str]()
        self.owners: dict[str, Outcome] = {}  # outcomes by the number of their region
        self.functions: list[Function] = []
        self.has_tags = any(region.tag for region in sheet.regions)
        self.fixed = frozenset(_structural(sheet))
        self.now: Outcome | None = None

    def axis(self, length: int) -> Axis:
        """Return the axis for vectors of the given length."""
        return Axis(f"items_{length}", length, self.origin)

    def function(self, function: Function, arguments: Sequence[Term]) -> str | None:
        """Return the name of a function's statement for arguments with these units.

        The statement is written at the first call. The name is None if the function must be inlined.
        """
        sorts = [self.declared.sort(part.text, self.declared.bound) for part in arguments]
        units = tuple(
            "1" if part.is_truth else _parameter_unit(sort)
            for part, sort in zip(arguments, sorts, strict=True)
        )
        if units in function.names:
            return function.names[units] or None
        keys = function.parameters
        inner: Scope = dict(function.scope)
        own = Names(RESERVED | self.declared.sorts.keys() | self.declared.functions.keys())
        parameters = [own.take(key) for key in keys]
        inner.update((key, InlineTerm(Term(name))) for key, name in zip(keys, parameters, strict=True))
        function.names[units] = ""  # a recursive call is inlined, and then refused as too deep
        bound = {name: sort_of(unit) for name, unit in zip(parameters, units, strict=True)}
        before, self.declared.bound = self.declared.bound, bound
        caller, self.now = self.now, self.owners[function.region]
        try:
            body = Expressions(self, inner).value(function.body)
            if body.axis is not None or not parameters:
                return None
            sort = self.declared.sort(body.text, bound)
            unit = unit_for(sort, self.asked(function.body))
        finally:
            self.declared.bound, self.now = before, caller
        name = self.names.take(function.key)
        function.names[units] = name
        self.declared.functions[name] = len(parameters), sort_of(unit)
        takes = ", ".join(f"{own} [{unit}]" for own, unit in zip(parameters, units, strict=True))
        self.owners[function.region].lines.append(f"{name}({takes}) [{unit}] = {body.text}")
        return name

    def curve(self, across: Term, up: Term) -> str:
        """Write a curve through the points of two literal lists, and return its name."""
        assert self.now is not None
        points = list(zip(items_in(across), items_in(up), strict=False))
        if len(points) < 2 or across.axis is None or up.axis is None or across.axis.length != up.axis.length:
            raise Untranslatable(
                "worksheets cannot interpolate in calculated lists", "write the points as a curve"
            )
        x_unit = unit_for(self.declared.sort(items_in(across)[0], self.declared.bound), [])
        y_unit = unit_for(self.declared.sort(items_in(up)[0], self.declared.bound), [])
        name = self.names.take("interpolation")
        rows = [f"  {_in(x, x_unit)} -> {_in(y, y_unit)}" for x, y in points]
        heights = [row.rpartition(" ")[2] for row in rows]
        is_flat = heights[0] == heights[1] and heights[-1] == heights[-2]
        held = " (held)" if is_flat else ""  # if the end segments are level, so is Mathcad's extrapolation
        head = f'curve {name}(x [{x_unit}]) [{y_unit}] "{self.words_for(name)}"{held}:'
        self.now.lines.append("\n".join([head, *rows]))
        if not is_flat:
            self.now.notes.append(
                "outside its points the curve has no value; Mathcad extrapolates its end segments"
            )
        self.declared.functions[name] = 1, sort_of(y_unit)
        return name

    def expression(self, node: Node) -> Term:
        """Return the expression of a tree; each list in it gets a line of its own."""
        at = Expressions(self, self.scope)
        if node.tag in ("matrix", "parens", "transpose"):
            return at.value(node)
        at.keep = self._keep
        return at.quantity(node) or at.value(node)

    def _keep(self, term: Term) -> Term:
        """Declare a list that occurs in a formula on a separate line, and return its name as a term."""
        assert self.now is not None
        sort = self.declared.sort(term.text, None)
        unit, name = unit_for(sort, []), self.names.take("items")
        assert term.axis is not None
        self.now.lines.append(f'{name} [{unit}] over {term.axis.name} = {term.text} "{self.words_for(name)}"')
        self.declared.sorts[name] = sort_of(unit, term.axis.name)
        return replace(term, text=name)

    def declare(
        self,
        outcome: Outcome,
        key: str,
        term: Term,
        wanted: Sequence[str],
        *,
        is_given: bool = False,
        words: str = "",
    ) -> Value:
        """Write the line of a value, and define its name from that line on."""
        sort = self.declared.sort(term.text, None)
        unit = unit_for(sort, [*wanted, *self._shown_in(key)] if is_rate(sort.kind.base) else wanted)
        name = self.names.take(key)
        if key in self.scope:
            outcome.notes.append(f"{look(key)} is defined again here: from here on it is {name}")
        axis = term.axis
        over = f" over {axis.name}" if axis else ""
        kind = "given " if is_given else ""
        clause = self._symbol(key, name)
        line = f'{kind}{name} [{unit}]{over} = {term.text} "{self.words_for(words or name)}"{clause}'
        outcome.lines.append(line)
        outcome.name = name
        self.declared.sorts[name] = sort_of(unit, axis.name if axis else "")
        constant = None if is_given else term.number
        value = Value(
            name, axis, term.is_vector or axis is not None, term.is_row, constant, outcome.original.number
        )
        self.scope[key] = value
        return value

    def _shown_in(self, key: str) -> list[str]:
        """Return the units in which single results are displayed; they reveal the kind of a rate."""
        maths = (region.math for region in self.sheet.regions)
        results = [math for math in maths if math is not None and math.tag == "eval" and math.parts]
        return [
            unit
            for math in results
            if math.parts[0].tag == "id" and key_of(math.parts[0]) == key
            for unit in self.asked(math)
        ]

    def _symbol(self, key: str, name: str) -> str:
        """Return a clause with the symbol of a name whose spelling had to change, else an empty text."""
        text = symbol(key)
        return f' (symbol "{text}")' if text and (name != look(key)) else ""

    def words_for(self, name: str) -> str:
        """Return a unique description of a quantity, from which its name in the interface follows."""
        words, count = name, 1
        while words.casefold() in self._words:
            count += 1
            words = f"{name} no {count}"
        self._words.add(words.casefold())
        return words

    def asked(self, value: Node, literal: ScaledNumber | None = None) -> list[str]:
        """Return preferred units for a declaration: the region's unit, then the unit of the typed value."""
        asked = value.first("unitOverride") if value.tag == "eval" else None
        scales = [scaled(asked.parts[0], is_unit=True)] if asked is not None and asked.parts else []
        units = []
        for scale in (*scales, literal):
            if scale is not None and scale.powers:
                try:
                    units.append(scale.unit)
                except Untranslatable:
                    continue
        return units

    def expect(self, outcome: Outcome, value: Node) -> None:
        """Store Mathcad's own result for comparison.

        Raises
        ------
        Untranslatable
            If it is a complex number, or infinite.
        """
        cached = outcome.original.cached
        if cached is None:
            return
        if any(part.tag in ("complex", "imag") for part in cached.parts):
            raise Untranslatable("complex number", "calculate with the real and imaginary parts")
        if any(part.tag == "real" and is_infinite(part.text) for part in cached.parts):
            raise Untranslatable("infinity", "give a number")
        asked = value.first("unitOverride") if value.tag == "eval" else None
        unit = asked.parts[0] if asked is not None and asked.parts else None
        outcome.cached = result_of(cached, unit, self.sheet.results_carry_units)


def without_result(node: Node) -> Node:
    """Return the calculation of a region without its displayed result."""
    return node.parts[0] if node.tag == "eval" and node.parts else node


def _structural(sheet: OriginalSheet) -> Iterator[str]:
    """Yield the names that determine lengths of lists; the import fixes their values."""
    for region in sheet.regions:
        if region.math is None:
            continue
        for tag in ("range", "lowerBound", "upperBound"):
            for node in region.math.all(tag):
                yield from (key_of(name) for name in node.all("id"))
        for node in region.math.all("apply"):
            if len(node.parts) == 3 and node.parts[0].tag == "indexer":
                yield from (key_of(name) for name in node.parts[2].all("id"))


def _parameter_unit(sort: Sort) -> str:
    unit = unit_for(sort, [])
    return "1" if sort.kind.base == registry.Unit("") else unit


def items_in(term: Term) -> list[str]:
    """Return the items of a literal list; empty for other lists."""
    if not term.text.startswith("["):
        return []
    items, depth, start = [], 0, 1
    for place, sign in enumerate(term.text):
        depth += (sign in "[(") - (sign in "])")
        if (sign == "," and depth == 1) or place == len(term.text) - 1:
            items.append(term.text[start:place].strip())
            start = place + 1
    return items


def _in(text: str, unit_text: str) -> str:
    try:
        value = float(unit(unit_text).from_si(constant(text).value))
    except ValueError:
        raise Untranslatable(
            "worksheets cannot interpolate in calculated lists", "write the points as a curve"
        ) from None
    return number(value).text
