"""Relations that a study sets aside, and that a chosen row replaces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.designs.document import Document
from app.plain import Raw
from app.reference import Reference
from templates.core.units.relation import is_relation


def relations_at(document: Document, places: Iterable[str]) -> dict[str, str]:
    """Return the typed relations that set some of the places; a list of relations becomes one line."""
    raw = {place: _raw(document, Reference.parse(place)) for place in places}
    return {place: text for place, value in raw.items() if (text := _relation(value))}


def words(relations: Mapping[str, str]) -> str:
    """Return relations as a text: `film.bearing_width (= ratio * 48 mm)`."""
    return ", ".join(f"{place} ({text})" for place, text in relations.items())


def _raw(document: Document, reference: Reference) -> Raw:
    name = reference.output
    if name is None:
        return document.parameters.get(reference.block)
    if step := document.steps.get(reference.block):
        return step.inputs.get(name)
    model = document.models.get(reference.block)
    return model.parameters.get(name) if model else None


def _relation(raw: Raw) -> str:
    if isinstance(raw, list):
        return ", ".join(map(str, raw)) if any(is_relation(one) for one in raw) else ""
    return str(raw).strip() if is_relation(raw) else ""
