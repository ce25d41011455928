"""Find the units of expressions with the parser of the worksheet language."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache

import lark

from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.quantities import ScaledNumber
from templates.core.errors import FaultyText
from templates.core.units.conformity import misfit
from templates.core.units.expressions import GRAMMAR, Sort, checked
from templates.core.units.nodes import kind_of
from templates.core.units.operations import Name
from templates.core.units.sorts import Part
from templates.core.units.units import dimension_of, registry, unit

Call = Callable[[list[Part]], Part]

_USUAL = ("1", "mm", "m**2", "m**3", "s", "kg", "kN", "MPa", "kN*m", "kg/m**3", "m/s", "m/s**2", "W", "K",
          "J", "Pa*s", "m**2/s", "kN/m", "m**4", "rad/s", "Hz", "1/s", "N/m**3", "A", "V",
          "ohm")  # fmt: skip
"""Units in which results are declared if the sheet requests none."""
_SHORT = {"meter": "m", "kilogram": "kg", "second": "s", "kelvin": "K", "ampere": "A", "mole": "mol",
          "radian": "rad", "candela": "cd"}  # fmt: skip


@lru_cache(maxsize=1)
def _parser() -> lark.Lark:
    return lark.Lark(GRAMMAR, parser="lalr", start="expression", propagate_positions=True)


@dataclass
class Declarations:
    """The names that lines have declared so far, as the scope of expressions."""

    sorts: dict[str, Sort] = field(default_factory=dict)
    functions: dict[str, tuple[int, Sort]] = field(default_factory=dict)
    bound: Mapping[str, Sort] = field(default_factory=dict)

    def sort(self, text: str, bound: Mapping[str, Sort] | None = None) -> Sort:
        """Return the sort of an expression.

        Parameters
        ----------
        bound
            The sorts of the parameters, if the expression is the body of a function.

        Raises
        ------
        Untranslatable
            If the language refuses the expression, for example because units do not fit.
        """
        before, self.bound = self.bound, bound or {}
        try:
            result: Sort = checked(_parser().parse(text), self)[1]
        except FaultyText as error:
            raise Untranslatable(
                f"the worksheet language refuses the formula ({error})", _remedy(error.code)
            ) from None
        except lark.exceptions.LarkError:
            raise Untranslatable("the formula cannot be read", "write it by hand") from None
        finally:
            self.bound = before
        return result

    def name(self, text: str) -> Part:
        """Return a name as a part of an expression, with its sort."""
        sort = self.bound.get(text) or self.sorts.get(text)
        if sort is None:
            raise FaultyText("unknown_name", f"{text[:40]} is not declared")
        return Name(text), sort

    def function(self, name: str) -> Call | None:
        """Return the function that a line has declared under a name; None if there is none."""
        if name not in self.functions:
            return None
        count, result = self.functions[name]

        def call(arguments: list[Part]) -> Part:
            if len(arguments) != count:
                raise FaultyText("unknown_function", f"{name} takes {count} values")
            axis = next((sort.axis for _, sort in arguments if sort.axis), "")
            return Name(name), replace(result, axis=axis)

        return call

    def spend(self) -> None:
        """Do nothing, because operations are counted when the sheet is read."""


def _remedy(code: str) -> str:
    remedies: Mapping[str, str] = {
        "unit_mismatch": "write the line by hand, with the intended units",
        "axis_mismatch": "write lists of equal length over one axis",
    }
    return remedies.get(code, "write the line by hand")


def sort_of(text: str, axis: str = "") -> Sort:
    """Return the sort of a value that is declared in a unit."""
    return Sort(kind_of(text), axis=axis)


def fits(text: str, sort: Sort) -> bool:
    """Return whether a value can be declared in a unit."""
    try:
        return misfit(sort.kind, unit(text), text) is None and not unit(text).absolute
    except FaultyText:
        return False


def _is_speed(text: str) -> bool:
    """Return whether a unit measures angular speed."""
    return dimension_of(unit(text)) == dimension_of(unit("rad/s"))


def unit_for(sort: Sort, wanted: Sequence[str]) -> str:
    """Return the unit in which a value is declared.

    It is the first suitable requested unit, else a common one, else an SI unit.

    Raises
    ------
    Untranslatable
        If its kind of quantity has no unit with whole powers.
    """
    if sort.kind.base == registry.Unit("radian") and not sort.kind.turned:
        return next((text for text in wanted if fits(text, sort) and text != "1"), "rad")
    if dimension_of(sort.kind) == dimension_of(unit("1/s")) and any(map(_is_speed, wanted)):
        return "rad/s"  # Mathcad does not distinguish 1/s from rad/s, and its rpm is 2*pi/60 of that unit
    usual = (text for text in _USUAL if dimension_of(unit(text)) == dimension_of(sort.kind))
    declared = next((text for text in (*wanted, *usual) if fits(text, sort)), None)
    if declared:
        return declared
    powers = tuple(
        (_SHORT.get(name, name), Fraction(str(power)).limit_denominator(100))
        for name, power in registry.Quantity(1.0, sort.kind.base).unit_items()
    )
    return ScaledNumber(1.0, powers).unit
