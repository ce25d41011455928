"""Remedies for a refused expression, chosen by its fault and by the operation at the place of the fault."""

from __future__ import annotations

import re
from typing import Any

import lark

from templates.core.sheets.names import Names
from templates.core.units.operations import FUNCTIONS, Kind
from templates.core.units.rules import in_words
from templates.core.units.units import base_text, dimension_of, registry, unit

MOST_NAMES = 4
_LATER_UNIT = re.compile(r"([*/])([A-Za-z]\w*)")
_COMMON = (
    "1", "mm", "mm**2", "mm**3", "s", "m/s", "m/s**2", "kg", "kg/m**3", "kg*m**2", "N", "MPa", "N*m", "N/mm",
    "W", "K", "mPa*s", "mm**2/s", "rad/s", "Hz", "1/s", "W/(m*K)", "J/(kg*K)", "W/(m**2*K)", "N/mm**3",
    "N*s/m", "mm**4", "1/m", "1/K", "A", "V", "m**3/s", "kg/s",
)  # fmt: skip
_EQUAL = frozenset({"add", "subtract", "compare", "if", "list"})
_EQUAL_CALLS = frozenset({"min", "max", "atan2"})
_TRUTHS = {
    "if": "write a comparison behind `if`, for example `x < 3 mm`",
    "and": "write a comparison on each side, for example `x < 3 mm and y > 1 mm`",
    "or": "write a comparison on each side, for example `x < 3 mm or y > 1 mm`",
    "not": "write a comparison behind `not`, for example `not x < 3 mm`",
}
_AXES = {
    "item": "write the name without an index, or take a list and one number, for example `x[2]`",
    "list": "write single values between the brackets, for example `[max(x), 3 mm]`",
    "call": "give a list, for example `max([a, b])`, or take `max(…)` of each list first",
}
_GENERAL = {
    "no_truth": "test a choice by `is`, and make a quantity of a condition by `if … then … else …`",
    "axis_mismatch": "take `max(…)`, `mean(…)` or an item of one of the lists, or declare both over one name",
    "index": "count from 1, with a whole number or a name in [1]",
    "unknown_function": "correct the name, or declare the function above this line",
    "unknown_unit": "write a unit, such as `kN`, `mm**2/s` or `W/(m*K)`",
    "syntax": "write it like `log(x)`, `max(a, b)` or `x[2]`",
    "not_finite": "write a number below 1e308",
    "too_large": "define its parts under names of their own, and call functions less often",
}


def remedy_at(code: str, tree: lark.Tree[Any], meta: Any, names: Names) -> str:
    """Return a remedy for a refused expression.

    Parameters
    ----------
    code
        The code of the fault.
    tree
        The expression.
    meta
        The place of the fault in the expression.
    names
        The names of the worksheet.
    """
    at = next((part for part in tree.iter_subtrees() if part.meta is meta), tree)
    if code == "unit_mismatch":
        return "; ".join(filter(None, (_equal(at, names), _units(at, names))))
    special = {"no_truth": _TRUTHS, "axis_mismatch": _AXES}.get(code, {})
    return special.get(str(at.data), _GENERAL.get(code, ""))


def declared_in(name: str, kind: Kind) -> str:
    """Return the advice to declare a name in a unit that fits its formula."""
    return f"declare {name} in {common_unit(kind)}, or correct the formula"


def common_unit(kind: Kind) -> str:
    """Return the unit that engineers use for a kind of value, such as MPa for a pressure."""
    if kind.base == registry.kelvin:
        return kind.unit
    alike = (text for text in _COMMON if dimension_of(unit(text)) == dimension_of(kind))
    return next(alike, base_text(kind))


def names_in_units(at: Any, names: Names) -> str:
    """Return the advice to put blanks before a name that was read as a unit, such as t in `1 turn/t`."""
    tokens = (
        at.scan_values(lambda token: getattr(token, "type", "") == "QUANTITY") if hasattr(at, "data") else ()
    )
    for text in map(str, tokens):
        spaced = _LATER_UNIT.sub(lambda part: _spaced(part, names), text)
        if spaced != text:
            return f"{text} is a unit from end to end; if it holds a name, write {spaced}"
    return ""


def _is_quantity(token: Any) -> bool:
    return getattr(token, "type", "") == "QUANTITY"


def _spaced(part: re.Match[str], names: Names) -> str:
    return f" {part[1]} {part[2]}" if part[2] in names.sorts else part[0]


def _equal(at: lark.Tree[Any], names: Names) -> str:
    """Return a sentence about what the operation at a place requires of its operands."""
    called = str(at.children[0])[:-1] if at.data == "call" else ""
    if at.data in _EQUAL or called in _EQUAL_CALLS:
        return "write both in the same unit"
    if at.data == "power":
        return "write a plain number as exponent, and divide by a unit first, for example `(d / 1 mm)**2`"
    if called in FUNCTIONS and called not in names.functions:
        return f"divide by a unit first, for example `{called}(x / 1 mm)`"
    if called in names.functions:
        return f"give {called} values in the units of its declaration"
    return "divide by a unit first, for example `x / 1 mm`"


def _units(at: lark.Tree[Any], names: Names) -> str:
    """Return the units of the names in an expression: `F is in kN, D in mm`."""
    used = map(str, at.scan_values(lambda token: getattr(token, "type", "") == "NAME"))
    shown = {name: text for name in used if (text := _unit_of(name, names))}
    parts = [f"{name} in {text}" for name, text in list(shown.items())[:MOST_NAMES]]
    return ", ".join([parts[0].replace(" in ", " is in ", 1), *parts[1:]]) if parts else ""


def _unit_of(name: str, names: Names) -> str:
    if name in names.parameters:
        return in_words(names.parameters[name][1].kind)
    return names.units.get(name, "")
