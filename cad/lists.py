"""Parameters that are lists, written as text: `[0, 180, 180, 0] deg` in STEP files, jobs and keys."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

LONGEST_TEXT = 2000
"""Longest text that is read as a list; this limits the reading time, which is linear in the length."""

_LIST = re.compile(r"\s*\[([^\[\]]*)\]([^\[\]]*)")
_NOISE = 12  # decimals of an item in its unit; a sine's rounding error stays below


def written(values: Iterable[float], unit: str) -> str:
    """Return a list as text with twelve digits; rounding noise about zero is removed."""
    inside = ", ".join(f"{number:.12g}" for number in rounded(values))
    return f"[{inside}]" if unit == "1" else f"[{inside}] {unit}"


def rounded(values: Iterable[float]) -> list[float]:
    """Return the items as numbers, rounded as in their text."""
    return [float(f"{round(float(value), _NOISE) + 0.0:.12g}") for value in values]


def listed(raw: Any) -> Any:
    """Convert a text that contains a list to a quantity; return anything else unchanged."""
    if not isinstance(raw, str) or len(raw) > LONGEST_TEXT or not (match := _LIST.fullmatch(raw)):
        return raw
    try:
        numbers = [float(item) for item in match[1].split(",")]
    except ValueError:
        return raw  # the caller reports what is wrong with it
    return {"value": numbers, "unit": match[2].strip() or "1"}
