"""Tolerances, which are read and kept but not yet calculated with: whoever gives one is warned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from templates.core.language.ledger import Notice
from templates.core.units.quantity import TOLERANCES, Typed

UNUSED = "tolerance_unused"
_SIMPLE = (str, int, float)  # values without a place for a tolerance
DETAIL = "its tolerance is kept and shown, but not used: the results are those of the value alone"


def unused(given: Mapping[str, Any]) -> Iterator[Notice]:
    """A warning for every quantity, as typed or as read, that has `plus` or `minus`."""
    return (
        Notice(UNUSED, name, DETAIL)
        for name, value in given.items()
        if not isinstance(value, _SIMPLE) and has_tolerance(value)
    )


def has_tolerance(value: Any) -> bool:
    """Whether a quantity, or any of a list, has a tolerance."""
    match value:
        case Typed():
            return bool(value.extra)
        case dict():
            return not value.keys().isdisjoint(TOLERANCES)
        case list() | tuple():
            return any(isinstance(item, dict) and has_tolerance(item) for item in value)
    return False
