"""Save a table of variants as a revision of its design."""

from __future__ import annotations

from collections.abc import Mapping

from app.designs import repository
from app.designs.service import Designs, SaveResult
from app.plain import JsonObject, Raw
from app.storage.idempotency import Once

Table = Mapping[str, Mapping[str, Raw]]
"""Overrides by variant and place, as typed."""


def replace_variants(
    designs: Designs, id: str, table: Table, note: str | None, expected: str | None, once: Once
) -> SaveResult:
    """Replace the table of variants and return the new revision; an unchanged table creates none.

    Raises
    ------
    StaleRevision
        If `expected` (an If-Match) is not the newest revision.
    InvalidInputs
        If the table has faults; the error lists all of them, and nothing is saved.
    """
    with designs.database.read() as session:
        number, document, *_ = repository.newest(session, id)
    patch = {"variants": patch_between(document.get("variants", {}), table)}
    is_any = expected is None or expected.strip() == "*"
    return designs.change(id, patch, note, f'"{number}"' if is_any else expected, once)


def patch_between(old: Table, new: Table) -> JsonObject:
    """Return the merge patch that converts one table to another."""
    gone: JsonObject = {name: None for name in old if name not in new}
    kept = {
        name: {**{place: None for place in old.get(name, {}) if place not in values}, **values}
        for name, values in new.items()
    }
    return {**gone, **kept}
