"""Criteria as judged, as the interface shows them: plain JSON values, never NaN or infinity."""

from __future__ import annotations

import math
from collections.abc import Sequence

from app.plain import JsonObject
from templates.core.judging.judgement import Judgement
from templates.core.judging.summary import summarised


def rendered(ordered: Sequence[Judgement]) -> JsonObject:
    """`criteria`, worst first, and the `verdict` over them; nothing where there are no criteria."""
    if not ordered:
        return {}
    summary = summarised(ordered)
    verdict = {
        "verdict": summary.verdict,
        "counts": dict(summary.counts),
        **({"governing": summary.governing} if summary.governing else {}),
        "headline": summary.headline,
        "green": summary.green,
    }
    return {"criteria": [criterion(judgement) for judgement in ordered], "verdict": verdict}


def criterion(judgement: Judgement) -> JsonObject:
    """One criterion; what does not apply is left out."""
    parts = {
        "value": _quantity(judgement.value, judgement.unit),
        "limit": _quantity(judgement.limit, judgement.unit),
        "band": _band(judgement),
        "relative_error": judgement.relative_error,
        "error_stated": judgement.is_stated,
        "utilisation": judgement.utilisation,
        "margin": _quantity(judgement.margin, judgement.margin_unit),
        "needs": judgement.needs,
        "give": list(judgement.give) or None,
        "reason": judgement.reason,
        "level": judgement.level,
        "truth": judgement.truth,
        "where": {p.name: {"value": p.value, "unit": p.unit} for p in judgement.where} or None,
        "points": judgement.points,
        "counts": dict(judgement.counts) if judgement.counts else None,
        "source": judgement.source,
        "unverified": judgement.unverified,
        "waived": judgement.waived,
    }
    known = {name: part for name, part in parts.items() if part is not None}
    names = {"name": judgement.name, "words": judgement.words, "require": judgement.require}
    return {**names, "verdict": judgement.verdict, **known}


def _quantity(value: float | None, unit: str) -> JsonObject | None:
    if value is None or not math.isfinite(value):
        return None
    return {"value": value, "unit": unit}


def _band(judgement: Judgement) -> JsonObject | None:
    if judgement.band is None:
        return None
    ends = [end if math.isfinite(end) else None for end in judgement.band]
    return {"value": ends, "unit": judgement.unit}
