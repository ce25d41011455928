"""Convert radial sizes to diametral ones and vice versa, if the template declares the other kind.

A document stores a size under the name that the template declares: `radial_clearance` of 30 um becomes
`diametral_clearance` of 60 um, and a relation is multiplied by 2. If a document gives both, both are kept,
and the undeclared one is refused.
"""

from __future__ import annotations

from collections.abc import Mapping

from app.designs.document import Document
from app.plain import Raw
from templates.core.errors import FaultyText
from templates.core.language.intake import factor_of
from templates.core.units.quantity import read, scaled
from templates.core.units.relation import is_relation


def in_declared_sizes(document: Document, pairs: Mapping[str, str]) -> Document:
    """Return the document with every size under the name that its step declares.

    `pairs` maps the other names to the declared ones, both as `step.name`.
    """
    plain = document.model_copy(deep=True)
    for name, step in plain.steps.items():
        step.inputs = _renamed(step.inputs, _within(pairs, name))
    for variant, overrides in plain.variants.items():
        plain.variants[variant] = _renamed(overrides, pairs)
    return plain


def _within(pairs: Mapping[str, str], step: str) -> dict[str, str]:
    prefix = f"{step}."
    return {
        other.removeprefix(prefix): name.removeprefix(prefix)
        for other, name in pairs.items()
        if other.startswith(prefix)
    }


def _renamed(values: Mapping[str, Raw], pairs: Mapping[str, str]) -> dict[str, Raw]:
    """Return values with each size under its declared name, unless both names are given."""
    changed = {}
    for name, raw in values.items():
        declared = pairs.get(name)
        multiple = None if declared is None or declared in values else _multiple(raw, declared)
        if declared is None or multiple is None:
            changed[name] = raw
        else:
            changed[declared] = multiple
    return changed


def _multiple(raw: Raw, declared: str) -> Raw | None:
    """Convert a size to the declared one; return None if it is not a length, which is refused later."""
    factor = factor_of(declared.rpartition(".")[2])
    if is_relation(raw):
        return f"= {factor:g} * ({str(raw).strip().removeprefix('=').strip()})"
    try:
        typed = scaled(read(raw, "mm"), factor)
    except FaultyText:
        return None
    if isinstance(raw, str) and not typed.extra and isinstance(typed.value, float):
        return f"{typed.value:.12g} {typed.unit}"
    return {"value": typed.value, "unit": typed.unit, **typed.extra}
