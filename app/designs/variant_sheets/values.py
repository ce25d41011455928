"""Convert a value of a variant to a cell and back: a number in the column's unit, a relation, or a text."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from app.plain import Raw
from app.presentation.input_text import text_of, value_of
from app.presentation.spreadsheets import Value
from templates.core.errors import FaultyText
from templates.core.units.quantity import read
from templates.core.units.relation import is_relation, parse
from templates.core.units.units import unit

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_QUANTITY = re.compile(rf"({NUMBER.pattern})(?:\s*([^\s0-9.+-].*|1))?", re.DOTALL)
FORMULA = (
    "this is a formula; type its value. Write a relation of the design in a column whose heading ends "
    "with ' =', without its equals sign"
)
_DIGITS = 1e-15
"""Relative tolerance: a spreadsheet may round a number by less than this."""


@dataclass(frozen=True)
class Shape:
    """The form of a value in a cell: a number with its unit, a relation, or a text."""

    value: Value
    unit: str = ""  # unit of a number
    is_relation: bool = False


def shape(raw: Raw) -> Shape:
    """Return a typed value in the form of a cell."""
    if is_relation(raw):
        return Shape(str(raw).strip().removeprefix("=").strip(), is_relation=True)
    number = _number(raw)
    return Shape(*number) if number else Shape(text_of(raw))


def _number(raw: Raw) -> tuple[float, str] | None:
    """Return the number and unit of a plain quantity; None for other values, such as one with a tolerance."""
    if isinstance(raw, Mapping) and raw.keys() == {"value", "unit"} and isinstance(raw["unit"], str):
        bare = _number(raw["value"]) if not isinstance(raw["value"], str) else None
        return (bare[0], raw["unit"]) if bare else None
    if isinstance(raw, str) and (parts := _QUANTITY.fullmatch(raw.strip())):
        number = float(parts[1])
        return (int(number) if number.is_integer() else number, (parts[2] or "1").strip())
    if isinstance(raw, (int, float)) and not isinstance(raw, bool):
        return raw, "1"
    return None


def same(one: Raw, other: Raw) -> bool:
    """Return whether two typed values mean the same, however they are written."""
    if one == other:
        return True
    this, that = shape(one), shape(other)
    if this.is_relation or that.is_relation or isinstance(this.value, str) or isinstance(that.value, str):
        return this == that
    numbers = this.value, that.value
    return _same_unit(this.unit, that.unit) and math.isclose(*map(_float, numbers), rel_tol=_DIGITS)


def _float(value: Value) -> float:
    return float(value or 0)


def _same_unit(one: str, other: str) -> bool:
    return one == other or unit(one) == unit(other)


def relation(text: str) -> str:
    """Return the relation in a cell, which is written without its equals sign.

    Raises
    ------
    FaultyText
        If it has an equals sign, or is not a relation.
    """
    if text.startswith("="):
        raise FaultyText("formula", f"write the relation without `=`: {text.lstrip('= ')[:60]}")
    parse(f"= {text}")
    return f"= {text}"


def given(text: str, column: str, declared: str | None) -> Raw:
    """Return the value of a cell; `column` is the unit of its column, which may be empty.

    `declared` is the declared unit of the place; None for a choice, or if it is unknown.

    Raises
    ------
    FaultyText
        If it is not a value, or has no unit or a unit of another kind.
    """
    if text.startswith("="):
        raise FaultyText("formula", FORMULA)
    typed = _typed(text, column, declared)
    if declared is not None and not (isinstance(typed, list) and any(map(is_relation, typed))):
        read(typed, declared)
    return typed


def _typed(text: str, column: str, declared: str | None) -> Raw:
    if NUMBER.fullmatch(text):
        if not column and declared not in (None, "1"):
            raise FaultyText("missing_unit", f"{text[:40]} has no unit; write {declared} below the heading")
        return text if column in ("", "1") else f"{text} {column}"
    typed = value_of(text)
    is_bare = isinstance(typed, list) and bool(typed) and not any(isinstance(item, str) for item in typed)
    return {"value": typed, "unit": column} if is_bare and column not in ("", "1") else typed
