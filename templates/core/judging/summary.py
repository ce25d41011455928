"""The verdict over several criteria: their order, worst first, and the one that governs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from templates.core.judging.comparison import WORST_FIRST, Verdict
from templates.core.judging.judgement import Judgement

SHOWN: tuple[Verdict, ...] = ("met", "not_met", "undecided", "not_checked")


@dataclass(frozen=True, slots=True)
class Summary:
    """The verdict over all criteria; green only if all are met and nothing about them is uncertain."""

    verdict: Verdict
    counts: Mapping[Verdict, int]
    governing: str | None
    headline: str
    green: bool


def worst_first(judgements: Iterable[Judgement]) -> list[Judgement]:
    """Criteria in order: not met, undecided, not checked, met; inside each by utilisation, largest first."""
    return sorted(judgements, key=_rank)


def _rank(judgement: Judgement) -> tuple[int, float, float, str]:
    used = judgement.utilisation
    margin = judgement.margin if judgement.margin is not None else 0.0
    return (
        WORST_FIRST.index(judgement.verdict),
        -used if used is not None else 0.0,
        margin if used is None else 0.0,
        judgement.name,
    )


def summarised(ordered: Sequence[Judgement]) -> Summary:
    """The verdict over criteria in order.

    Waived criteria are counted and listed as what they are, but no longer make the verdict worse than met.
    """
    counts = Counter(map(attrgetter("verdict"), ordered))
    decisive = [judgement for judgement in ordered if judgement.waived is None]
    governing = next((j.name for j in ordered if j.verdict != "not_checked"), None)
    verdict = decisive[0].verdict if decisive else ordered[0].verdict if ordered else "not_checked"
    green = bool(ordered) and all(j.verdict == "met" and j.is_certain for j in ordered)
    return Summary(verdict, {v: counts[v] for v in SHOWN}, governing, _headline(ordered, counts), green)


def _headline(ordered: Sequence[Judgement], counts: Mapping[Verdict, int]) -> str:
    parts = [f"{counts[v]} {v.replace('_', ' ')}" for v in SHOWN if counts.get(v)]
    waived = sum(judgement.waived is not None for judgement in ordered)
    return ", ".join([*parts, *([f"{waived} waived"] if waived else [])]) or "no criteria"
