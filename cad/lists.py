"""Parameters that are lists, written as text: `[0, 180, 180, 0] deg` in STEP files, jobs and keys."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from templates.core.errors import FaultyText
from templates.core.units.tolerance import STATE_IN_TABLE, split

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
    return {"value": numbers, **_unit_of(match[2].strip())}


def _unit_of(rest: str) -> dict[str, Any]:
    """Return the unit after a list, and the tolerance that its items share."""
    try:
        written = split(rest)
    except FaultyText:
        written = None
    if written is None or written.zone is not None:
        return {"unit": rest or "1"}
    upper, lower = (f"{end:+.12g} {written.scale}" for end in (written.upper, written.lower))
    more = {STATE_IN_TABLE: True} if written.state_in_table else {}
    return {"unit": written.unit, "upper": upper, "lower": lower, **more}
