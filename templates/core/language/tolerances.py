"""Tolerances, which are read and kept but not yet calculated with: whoever gives one is warned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from templates.core.language.ledger import Notice
from templates.core.units.quantity import TOLERANCES, Typed

UNUSED = "tolerance_unused"
DETAIL = "its tolerance is kept and shown, but not used: the results are those of the value alone"


def unused(given: Mapping[str, Any]) -> Iterator[Notice]:
    """A warning for every quantity, as typed or as read, that has `plus` or `minus`."""
    for name, value in given.items():
        if value.extra if isinstance(value, Typed) else has_tolerance(value):
            yield Notice(UNUSED, name, DETAIL)


def has_tolerance(value: Any) -> bool:
    """Whether a quantity as its user wrote it, or any of a list, has a tolerance."""
    match value:
        case dict():
            return not value.keys().isdisjoint(TOLERANCES)
        case list() | tuple():
            return any(isinstance(item, dict) and has_tolerance(item) for item in value)
    return False
