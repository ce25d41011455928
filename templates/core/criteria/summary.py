"""The verdict over several criteria: their order, worst first, and the governing criterion."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from templates.core.criteria.comparison import WORST_FIRST, Verdict
from templates.core.criteria.judgement import Judgement

SHOWN: tuple[Verdict, ...] = ("met", "not_met", "undecided", "not_checked")


@dataclass(frozen=True, slots=True)
class Summary:
    """The verdict over all criteria; green only if all are met and none of them is uncertain.

    Attributes
    ----------
    error_unknown
        How many of the met criteria depend on an unknown error.
    governing
        The worst criterion that was checked. A criterion that meets a limit fixed in its template governs
        only if no criterion of the same value waits for its limit.
    """

    verdict: Verdict
    counts: Mapping[Verdict, int]
    error_unknown: int
    governing: str | None
    headline: str
    green: bool


def worst_first(judgements: Iterable[Judgement]) -> list[Judgement]:
    """Return criteria in the order: not met, undecided, not checked, met with an unknown error, met.

    Within each group they are sorted by utilisation, largest first.
    """
    return sorted(judgements, key=rank)


def rank(judgement: Judgement) -> tuple[int, bool, float, float, str]:
    """Return the position of a judgement in the order of `worst_first`."""
    used = judgement.utilisation
    margin = judgement.margin if judgement.margin is not None else 0.0
    return (
        WORST_FIRST.index(judgement.verdict),
        judgement.verdict == "met" and judgement.error_known,
        -used if used is not None else 0.0,
        margin if used is None else 0.0,
        judgement.name,
    )


def summarised(ordered: Sequence[Judgement]) -> Summary:
    """Return the verdict over criteria that are in the order of `worst_first`.

    Waived criteria are counted and listed, but do not worsen the verdict.
    """
    verdicts = [judgement.verdict for judgement in ordered]
    counts = {verdict: verdicts.count(verdict) for verdict in SHOWN}
    decisive = [judgement for judgement in ordered if judgement.waived is None]
    waiting = {_subject(j) for j in ordered if j.verdict == "not_checked"}
    governing = next((j.name for j in ordered if _may_govern(j, waiting)), None)
    met = [judgement for judgement in ordered if judgement.verdict == "met"]
    unknown = sum([not judgement.error_known for judgement in met])
    verdict = decisive[0].verdict if decisive else ordered[0].verdict if ordered else "not_checked"
    green = bool(ordered) and len(met) == len(ordered) and all(judgement.is_certain for judgement in met)
    headline = _headline(tuple(counts.values()), unknown, len(ordered) - len(decisive))
    return Summary(verdict, counts, unknown, governing, headline, green)


def _subject(judgement: Judgement) -> tuple[str, str]:
    """Return the step and the text of the judged value."""
    return judgement.name.rpartition(".")[0], judgement.sides[0]


def _may_govern(judgement: Judgement, waiting: Collection[tuple[str, str]]) -> bool:
    if judgement.verdict == "met" and judgement.has_fixed_limit:
        return _subject(judgement) not in waiting
    return judgement.verdict != "not_checked"


@lru_cache(maxsize=1024)
def _headline(counts: tuple[int, ...], unknown: int, waived: int) -> str:
    """Return a text with the number of criteria for each verdict in `SHOWN`.

    Criteria met with an unknown error are counted separately.
    """
    met, *others = counts
    words = ["met", "met (error unknown)", *(verdict.replace("_", " ") for verdict in SHOWN[1:])]
    numbers = [met - unknown, unknown, *others]
    parts = [f"{n} {text}" for text, n in zip(words, numbers, strict=True) if n]
    return ", ".join([*parts, *([f"{waived} waived"] if waived else [])]) or "no criteria"
