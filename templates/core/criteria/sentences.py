"""Sentences about two compared values: they state the facts, never the requirement.

Warnings of criteria and of rules are worded here, so that no sentence contradicts its own numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

from templates.core.units.units import unit_symbol

IS = {"<": "is below", "<=": "is not above", ">": "is above", ">=": "is not below"}
DIGITS = 4  # of a number in a sentence, unless more are needed to tell two apart
_MOST_DIGITS = 17


@dataclass(frozen=True)
class Side:
    """One side of a comparison: its words, which may be empty, and its magnitude in the unit of both."""

    words: str
    magnitude: float


def compared(left: Side, sign: str, right: Side, unit: str) -> str:
    """Return a true comparison: `minimum film thickness 2.133 µm is below permissible film 3 µm`."""
    printed, (one, other) = unit_symbol(unit), told_apart(left.magnitude, right.magnitude)
    sides = f"{left.words} {one} {printed}", f"{right.words} {other} {printed}"
    return f" {IS[sign]} ".join(side.strip() for side in sides)


def told_apart(one: float, other: float) -> tuple[str, str]:
    """Return two numbers in so many digits that they differ, unless they are equal."""
    texts = (f"{one:.{DIGITS}g}", f"{other:.{DIGITS}g}")
    digits = DIGITS
    while texts[0] == texts[1] and one != other and digits < _MOST_DIGITS:
        digits += 1
        texts = (f"{one:.{digits}g}", f"{other:.{digits}g}")
    return texts
