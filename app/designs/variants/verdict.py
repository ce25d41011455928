"""Verdicts over a design with variants: each criterion is shown for its worst variant."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from app.designs.variants.names import BASE
from templates.core.criteria.comparison import Verdict
from templates.core.criteria.judgement import Judgement, Place
from templates.core.criteria.summary import SHOWN, worst_first

VARIANT = "variant"
"""The entry in `where` of a criterion that names the worst variant; `base` is the design itself."""

Judged = Mapping[str, Sequence[Judgement]]
"""Criteria by the name of the variant."""


def merged(base: Sequence[Judgement], variants: Judged) -> list[Judgement]:
    """Return every criterion of a design with the judgement of its worst variant, worst first.

    Without variants the list is unchanged. The points of a merged criterion are the variants and the design
    itself. A limit that is unverified for one variant is unverified for all.
    """
    if not variants:
        return list(base)
    by_name: dict[str, list[Judgement]] = {}
    for variant, judgements in {BASE: base, **variants}.items():
        for judgement in judgements:
            place = Place(VARIANT, variant, "")
            by_name.setdefault(judgement.name, []).append(replace(judgement, where=(place, *judgement.where)))
    return worst_first(map(_worst, by_name.values()))


def _worst(judgements: Sequence[Judgement]) -> Judgement:
    """Return the worst judgement of one criterion over all variants, with the count of each verdict."""
    worst = worst_first(judgements)[0]
    counts = Counter(judgement.verdict for judgement in judgements)
    return replace(
        worst,
        points=len(judgements),
        counts=_ordered(counts),
        unverified=next((j.unverified for j in (worst, *judgements) if j.unverified), None),
    )


def _ordered(counts: Counter[Verdict]) -> dict[Verdict, int]:
    return {verdict: counts[verdict] for verdict in SHOWN if counts[verdict]}
