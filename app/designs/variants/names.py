"""Names of variants and of the values that they override, and the order of these names."""

from __future__ import annotations

import re

BASE = "base"
"""The design without any override; no variant has this name."""
RESERVED = {
    BASE: f"{BASE!r} is the design itself; give the variant another name, such as `main_1`",
    "report": "'report' is the address of the report of all variants; give the variant another name",
}
"""Names that a variant must not have, and why."""

MOST_VARIANTS = 200
MOST_OVERRIDES = 10_000  # largest number of values that all variants of a design override together
PLACE = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63})?$"
"""A parameter of the design, an input of a step, or a parameter of a model: `film.bearing_width`."""

_PART = re.compile(r"[0-9]+|[^0-9]+")

NaturalKey = tuple[tuple[tuple[int, int, str], ...], str]


def natural(name: str) -> NaturalKey:
    """Return a sort key for names in natural order: main_2 before main_10."""
    parts = (
        (0, int(part), "") if part[0].isdigit() else (1, 0, part.lower()) for part in _PART.findall(name)
    )
    return tuple(parts), name


def dotted(variant: str, model: str) -> str:
    """Return the name under which a revision stores a variant's model: `main_2.shell`.

    The name of a model of the design itself has no dot.
    """
    return f"{variant}.{model}"
