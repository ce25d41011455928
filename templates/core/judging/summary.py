"""The verdict over several criteria: their order, worst first, and the one that governs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

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
    """Return criteria in order: not met, undecided, not checked, met.

    Inside each by utilisation, largest first.
    """
    return sorted(judgements, key=rank)


def rank(judgement: Judgement) -> tuple[int, float, float, str]:
    """Return the place of a judgement in that order."""
    used = judgement.utilisation
    margin = judgement.margin if judgement.margin is not None else 0.0
    return (
        WORST_FIRST.index(judgement.verdict),
        -used if used is not None else 0.0,
        margin if used is None else 0.0,
        judgement.name,
    )


def summarised(ordered: Sequence[Judgement]) -> Summary:
    """Return the verdict over criteria in order.

    Waived criteria are counted and listed as what they are, but no longer make the verdict worse than met.
    """
    verdicts = [judgement.verdict for judgement in ordered]
    counts = {verdict: verdicts.count(verdict) for verdict in SHOWN}
    decisive = [judgement for judgement in ordered if judgement.waived is None]
    governing = next((j.name for j in ordered if j.verdict != "not_checked"), None)
    verdict = decisive[0].verdict if decisive else ordered[0].verdict if ordered else "not_checked"
    green = bool(ordered) and all(j.verdict == "met" and j.is_certain for j in ordered)
    headline = _headline(tuple(counts.values()), len(ordered) - len(decisive))
    return Summary(verdict, counts, governing, headline, green)


@lru_cache(maxsize=1024)
def _headline(counts: tuple[int, ...], waived: int) -> str:
    """Return the number of criteria of each verdict in `SHOWN`, in words."""
    parts = [f"{n} {verdict.replace('_', ' ')}" for verdict, n in zip(SHOWN, counts, strict=True) if n]
    return ", ".join([*parts, *([f"{waived} waived"] if waived else [])]) or "no criteria"
