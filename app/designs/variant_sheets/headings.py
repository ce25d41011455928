"""Match a heading of a sheet, or the name of a row, as people write it: `Radial load`, `main 1`."""

from __future__ import annotations

import re
from collections.abc import Collection

from app.reference import Reference

SIGNS = {
    r"(?<!\w)[-−](?=\s*[0-9])": "minus", "[-−–]": "", r"\+": "plus", "%": "percent", "°": "deg",
    r"(?<=[0-9])[.,](?=[0-9])": "point",
}  # fmt: skip
"""How a sign is written in the name of a variant, which has letters, digits and underscores only."""


def place_named(heading: str, places: Collection[str]) -> str:
    """Return the place to which a heading refers, by its full name or by the words of its input.

    If no place or several places fit, return the heading itself. `Radial load` refers to `film.radial_load`
    if no other step has an input with these words.
    """
    if heading in places:
        return heading
    words = joined(heading.lower())
    named = [place for place in places if words in (place.lower(), Reference.parse(place).own_name.lower())]
    return named[0] if len(named) == 1 else heading


def joined(words: str) -> str:
    """Return words joined to a name by underscores."""
    return "_".join(words.split())


def row_name(words: str) -> str:
    """Return the name of a row from words as people write them: `pin +10 %` → `pin_plus_10_percent`."""
    for sign, word in SIGNS.items():
        words = re.sub(sign, f" {word} ", words)
    return joined(words)
