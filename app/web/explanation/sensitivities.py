"""Prepare the sensitivities of an explanation for its page: slopes, elasticities and bars."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.designs.schemas.designs import Sensitivity
from app.presentation import numbers

WIDTH = 100  # width of a bar's picture; its middle means no change
HELPS = {"increase": "raise it", "decrease": "lower it"}


@dataclass(frozen=True)
class Bar:
    """The bar of an elasticity: its start and its length."""

    begin: float
    length: float
    sign: str  # a class: rises or falls


@dataclass(frozen=True)
class SensitivityLine:
    """A row of the table of sensitivities."""

    name: str
    slope: str
    elasticity: str
    bar: Bar | None
    helps: str
    reason: str


def sensitivity_lines(items: Sequence[Sensitivity]) -> list[SensitivityLine]:
    """Return all lines with their bars; the largest elasticity has the longest bar."""
    largest = max((abs(item.elasticity or 0.0) for item in items), default=0.0)
    return [_line(item, largest) for item in items]


def _line(item: Sensitivity, largest: float) -> SensitivityLine:
    slope = item.slope
    return SensitivityLine(
        item.name,
        "–" if slope is None else numbers.in_line({"value": _digits(slope.value), "unit": slope.unit}),
        "–" if item.elasticity is None else numbers.plain(_digits(item.elasticity)),
        _bar(item.elasticity, largest) if item.elasticity else None,
        HELPS[item.helps] if item.helps else "",
        item.reason or "",
    )


def _bar(elasticity: float, largest: float) -> Bar:
    length = WIDTH / 2 * abs(elasticity) / largest
    begin = WIDTH / 2 if elasticity > 0 else WIDTH / 2 - length
    return Bar(round(begin, 2), round(length, 2), "rises" if elasticity > 0 else "falls")


def _digits(value: float) -> float:
    """Return a number with four digits, which is the accuracy of the differences."""
    return float(f"{value:.4g}")
