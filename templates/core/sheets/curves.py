"""Curves through points: functions of one variable, linear between the points and undefined outside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import lark
import numpy as np

from templates.core.errors import FaultyText
from templates.core.sheets.clauses import Said
from templates.core.sheets.expressions import Reader
from templates.core.sheets.functions import taken
from templates.core.sheets.grammar import ParsedStatement
from templates.core.sheets.names import Call
from templates.core.sheets.partial import Partial
from templates.core.units.nodes import kind_of
from templates.core.units.sorts import Part, applied
from templates.core.units.units import unit


def curve_of(
    statement: ParsedStatement,
    reader: Reader,
    name: str,
    units: tuple[str, str],
    points: Sequence[Any],
    said: Said,
) -> Call:
    """Return the curve as a function, from the unit of its argument to the unit of its value.

    Raises
    ------
    Refusal
        If there are too few points or they do not ascend; the code is `curve`.
    """
    sides = list(zip(*(point.children for point in points), strict=True))
    along, values = (
        [float(unit(one).to_si(reader.limit(statement, tree, one))) for tree in side]
        for one, side in zip(units, sides, strict=True)
    )
    if len(along) < 2:
        raise statement.refuse("curve", "a curve needs at least two points", points[0], "give another point")
    for before, after, point in zip(along, along[1:], points[1:], strict=False):
        if not before < after:
            remedy = "sort the points and give each one once"
            raise statement.refuse("curve", "the points of a curve must be in ascending order", point, remedy)
    return _called(name, units, _operation(name, units, along, values, said, sides[0]))


def _operation(
    name: str, units: tuple[str, str], along: list[float], values: list[float], said: Said, ends: Any
) -> Partial:
    low, high, is_held = along[0], along[-1], said.is_held
    beyond = None if is_held else np.nan
    ends = [f"{float(unit(units[0]).from_si(end)):.6g}" for end in (low, high)]
    shown = "" if units[0] == "1" else f" {units[0]}"
    return Partial(
        name,
        lambda at: np.interp(at, along, values, left=beyond, right=beyond),
        lambda operation, kinds, nodes: kind_of(units[1]),
        1,
        is_missing=lambda at: np.logical_or(np.less(at, low), np.greater(at, high)),
        reason=f"{name} is known from {ends[0]}{shown} to {ends[1]}{shown} only",
    )


def _called(name: str, units: tuple[str, str], operation: Partial) -> Call:
    def call(arguments: list[Part]) -> Part:
        if len(arguments) != 1:
            raise FaultyText("unknown_function", f"{name} takes one value in {units[0]}")
        ((_, got),) = arguments
        taken(f"the value of {name}", units[0], arguments[0], f"{name} takes a value in {units[0]}")
        return applied(replace(operation, is_of_items=bool(got.axis)), arguments)

    return call


def points_of(parts: Sequence[Any]) -> list[lark.Tree[Any]]:
    """Return the points of a curve, found among the parts of its statement."""
    return [part for part in parts if isinstance(part, lark.Tree) and part.data == "point"]
