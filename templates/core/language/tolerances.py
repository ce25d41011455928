"""Warn about tolerances that a calculation ignores."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from templates.core.language.ledger import Notice
from templates.core.units.quantity import TypedQuantity
from templates.core.units.tolerance import is_toleranced

UNUSED = "tolerance_unused"
DETAIL = (
    'its tolerance is kept, but not used: the results are those of the value alone; "Analyse tolerances" on '
    "the page of a design, or POST /api/v1/designs/{id}/tolerance, calculates with it"
)


def unused(given: Mapping[str, Any]) -> Iterator[Notice]:
    """Yield a warning for every quantity with a tolerance, whether a user typed it or the service read it."""
    for name, value in given.items():
        if value.tolerance if isinstance(value, TypedQuantity) else is_toleranced(value):
            yield Notice(UNUSED, name, DETAIL)
