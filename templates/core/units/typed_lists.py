"""Lists of numbers as people type them: `1-3-4-2`, `0 90 180 deg`, `45; -45 deg`, `[45 -45] deg`.

Pages and documents state the syntax `[1, 3, 4, 2] mm`; these texts are read as the same list. A text is a
list only if it cannot be a single quantity: signed numbers after the first may be its deviations.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from templates.core.errors import FaultyText, excerpt
from templates.core.units.tolerance import NUMBER

LONGEST_LIST = 100_000  # [characters]
_ORDER = re.compile(r"[0-9]{1,4}(?:[-–][0-9]{1,4})+")
_SEPARATOR = re.compile(r"[;\s]+|,\s+")
_SIGNED = re.compile(rf"[+-]?{NUMBER}")
_UNIT = re.compile(r"[A-Za-zµμ°%Ω].*")  # unlike `1/s`, it does not begin like a number
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:\s[0-9]{3})+(?:\s*[A-Za-zµμ°%Ω].*)?")


class TypedList(NamedTuple):
    """The numbers of a list, and its unit; the unit is empty for pure numbers."""

    numbers: list[float]
    unit: str


def listed(text: str) -> TypedList | None:
    """Return the list of at least two numbers in a text; None if the text is something else.

    Raises
    ------
    FaultyText
        If the text may also be one number with its thousands apart: `25 500 N`.
    """
    stripped = text.strip()
    if not stripped or len(text) > LONGEST_LIST or stripped[0] not in "[+-.0123456789":
        return None
    if _ORDER.fullmatch(stripped):
        return TypedList([float(item) for item in re.split("[-–]", stripped)], "")
    items = _bracketed(stripped) if stripped[0] == "[" else _open(stripped)
    if items and _THOUSANDS.fullmatch(stripped):
        shown = excerpt(stripped)
        remedy = "for one number, write it without spaces; for a list, write it like `[1, 2] mm` or `1; 2 mm`"
        raise FaultyText("not_a_quantity", f"{shown} may be one number or a list; {remedy}")
    return items


def _bracketed(text: str) -> TypedList | None:
    inside, bracket, unit = text[1:].partition("]")
    items, unit = _items(inside), unit.strip()
    if not bracket or not items or not all(map(_SIGNED.fullmatch, items)):
        return None
    return TypedList([float(item) for item in items], unit) if not unit or _UNIT.fullmatch(unit) else None


def _open(text: str) -> TypedList | None:
    items = _items(text)
    count = next((place for place, item in enumerate(items) if not _SIGNED.fullmatch(item)), len(items))
    numbers, unit = items[:count], " ".join(items[count:])
    if len(numbers) == 2 and numbers[1] == "1" and not unit and ";" not in text:
        return None  # a pure number with its unit: `0.3 1`
    are_deviations = ";" not in text and all(item[0] in "+-" for item in numbers[1:])
    if len(numbers) < 2 or are_deviations or (unit and not _UNIT.fullmatch(unit)):
        return None
    return TypedList([float(item) for item in numbers], unit)


def _items(text: str) -> list[str]:
    return [item for item in _SEPARATOR.split(text) if item]
