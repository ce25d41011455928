"""The lines of a calculation report: symbol = expression = numbers = result, for every formula used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from templates.core.language.body import Body
from templates.core.language.spec import Choice
from templates.core.language.template import Template
from templates.core.paper.mathml import amount, expression, mathml, symbol, symbols
from templates.core.paper.methods import right_side
from templates.core.units.units import unit


@dataclass(frozen=True)
class Row:
    """One printed formula; `numbers` and `result` are empty if an array has no single value."""

    name: str
    words: str
    symbol: str
    expression: str
    numbers: str
    result: str
    source: str | None

    @property
    def latex(self) -> str:
        """Return the whole line as LaTeX."""
        return "=".join(part for part in (self.symbol, self.expression, self.numbers, self.result) if part)

    @property
    def mathml(self) -> str:
        """Return the whole line as MathML."""
        return mathml(self.latex)


NONE = r"\text{none}"


def rows(template: Template, units: Mapping[str, str] | None = None) -> Iterator[Row]:
    """Yield the report line of every formula that the template has evaluated so far.

    `units` gives other units than the declared ones, by attribute.
    """
    cls = type(template)
    names, shown_in = symbols(cls), units or {}
    values = {attribute: shown(template, attribute, shown_in) for attribute in cls.declarations}
    tested = {a: names[a] for a, declared in cls.declarations.items() if isinstance(declared, Choice)}
    result = {a: shown(template, a, shown_in, absolute=True) for a in cls.declarations}
    for formula in cls.formulas.values():
        if formula.attribute in vars(template):
            side, is_words = right_side(cls, formula, names, template.level)
            # a worksheet compares a choice: "law = walther", not "vogel = walther"
            filled = {**values, **tested} if isinstance(formula.function, Body) else values
            complete = not is_words and all(values.get(used) not in (None, "", NONE) for used in formula.uses)
            yield Row(
                name=formula.name,
                words=formula.meaning.words,
                symbol=symbol(formula),
                expression=side,
                numbers=expression(formula, filled, r"\cdot ") if complete and formula.latex is None else "",
                result=result[formula.attribute],
                source=formula.meaning.source,
            )


def shown(template: Template, attribute: str, units: Mapping[str, str], *, absolute: bool = False) -> str:
    """Return the value of a declaration with its unit, as LaTeX; empty if missing or an array.

    A temperature inside an expression is printed in kelvin, because sums and ratios are valid only there.
    """
    declared = template.declarations[attribute]
    if isinstance(declared, Choice):
        return rf"\text{{{getattr(template, attribute).replace('_', ' ')}}}"
    value = vars(template).get(attribute)
    if value is None or isinstance(value, (np.ndarray, tuple)):
        return ""
    if isinstance(value, str):
        return rf"\text{{{value.replace('_', ' ')}}}"
    if np.isnan(value):
        return NONE
    scale = unit(units.get(attribute, declared.meaning.unit))
    if scale.absolute and not absolute:
        return amount(float(value), "K")
    return amount(float(scale.from_si(value)), scale.text)
