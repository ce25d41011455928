"""Match a heading of a sheet, or the name of a row, as people write it: `Radial load`, `main 1`."""

from __future__ import annotations

from collections.abc import Collection

from app.reference import Reference


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
