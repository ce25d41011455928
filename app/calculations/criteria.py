"""Criteria as judged, as the interface shows them: plain JSON values, never NaN or infinity."""

from __future__ import annotations

import math
from collections.abc import Sequence

from app.plain import JsonObject
from templates.core.judging.judgement import Judgement, Place
from templates.core.judging.summary import summarised


def rendered(ordered: Sequence[Judgement]) -> JsonObject:
    """Return `criteria`, worst first, and the `verdict` over them; nothing where there are no criteria."""
    if not ordered:
        return {}
    return {"criteria": [criterion(judgement) for judgement in ordered], "verdict": verdict(ordered)}


def verdict(ordered: Sequence[Judgement]) -> dict[str, object]:
    """Return the verdict over all criteria, which stand in order."""
    summary = summarised(ordered)
    return {
        "verdict": summary.verdict,
        "counts": dict(summary.counts),
        **({"governing": summary.governing} if summary.governing else {}),
        "headline": summary.headline,
        "green": summary.green,
    }


def criterion(judgement: Judgement) -> JsonObject:
    """Return one criterion as JSON, without the members that do not apply."""
    unit, value, limit, margin = judgement.unit, judgement.value, judgement.limit, judgement.margin
    parts = {
        "value": None if value is None else _quantity(value, unit),
        "limit": None if limit is None else _quantity(limit, unit),
        "band": None if judgement.band is None else _band(judgement.band, unit),
        "relative_error": judgement.relative_error,
        "error_stated": judgement.is_stated,
        "utilisation": judgement.utilisation,
        "margin": None if margin is None else _quantity(margin, judgement.margin_unit),
        "needs": judgement.needs,
        "give": list(judgement.give) or None,
        "reason": judgement.reason,
        "level": judgement.level,
        "truth": judgement.truth,
        "where": _where(judgement.where) if judgement.where else None,
        "points": judgement.points,
        "counts": dict(judgement.counts) if judgement.counts else None,
        "source": judgement.source,
        "unverified": judgement.unverified,
        "waived": judgement.waived,
    }
    present = {name: part for name, part in parts.items() if part is not None}
    names = {"name": judgement.name, "words": judgement.words, "require": judgement.require}
    return {**names, "verdict": judgement.verdict, **present}


def _quantity(value: float, unit: str) -> dict[str, object] | None:
    return {"value": value, "unit": unit} if math.isfinite(value) else None


def _band(band: tuple[float, float], unit: str) -> dict[str, object]:
    return {"value": [end if math.isfinite(end) else None for end in band], "unit": unit}


def _where(places: Sequence[Place]) -> dict[str, object]:
    """Return places by name; what has no unit is a name, such as that of a variant."""
    return {
        place.name: {"value": place.value, "unit": place.unit} if place.unit else place.value
        for place in places
    }
