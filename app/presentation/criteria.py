"""Criteria in words, for pages and reports: the comparison, the utilisation, the margin, and what is missing.

The sentence about a criterion comes from the REST interface; this module writes the texts around it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from app.presentation import numbers
from app.reference import Reference
from templates.core.criteria.judgement import in_words

WORDS = {"met": "met", "not_met": "not met", "undecided": "undecided", "not_checked": "not checked"}
_SIGN = re.compile(r"^(.*?)\s*(>=|<=)\s*(.*)$", re.DOTALL)
_NAME = re.compile(r"(?:[A-Za-z]\w*\.)*([A-Za-z]\w*)")
_ONE_NAME = re.compile(r"\s*(?:[A-Za-z]\w*\.)*[A-Za-z]\w*\s*")
UNKNOWN = "error unknown"
SIGNS = {">=": "≥", "<=": "≤"}


class Amount(Protocol):
    """A magnitude with its unit."""

    @property
    def value(self) -> float:
        """Return the magnitude."""

    @property
    def unit(self) -> str:
        """Return the unit."""


class ValueRange(Protocol):
    """Two ends of a range with one unit; null where an end is infinite."""

    @property
    def value(self) -> Sequence[float | None]:
        """Return the low and the high end."""

    @property
    def unit(self) -> str:
        """Return the unit of both ends."""


class JudgedCriterion(Protocol):
    """A criterion as the interface returns it; see `app/schemas/criteria.py`."""

    @property
    def name(self) -> str: ...  # noqa: D102 - the schema describes every field
    @property
    def words(self) -> str: ...  # noqa: D102
    @property
    def require(self) -> str: ...  # noqa: D102
    @property
    def verdict(self) -> str: ...  # noqa: D102
    @property
    def value(self) -> Amount | None: ...  # noqa: D102
    @property
    def limit(self) -> Amount | None: ...  # noqa: D102
    @property
    def band(self) -> ValueRange | None: ...  # noqa: D102
    @property
    def relative_error(self) -> float | None: ...  # noqa: D102
    @property
    def error_known(self) -> bool | None: ...  # noqa: D102
    @property
    def utilisation(self) -> float | None: ...  # noqa: D102
    @property
    def margin(self) -> Amount | None: ...  # noqa: D102
    @property
    def needs(self) -> float | None: ...  # noqa: D102
    @property
    def give(self) -> Sequence[str] | None: ...  # noqa: D102
    @property
    def reason(self) -> str | None: ...  # noqa: D102
    @property
    def level(self) -> str | None: ...  # noqa: D102
    @property
    def where(self) -> Mapping[str, object] | None: ...  # noqa: D102
    @property
    def points(self) -> int | None: ...  # noqa: D102
    @property
    def counts(self) -> Mapping[str, int] | None: ...  # noqa: D102
    @property
    def unverified(self) -> str | None: ...  # noqa: D102
    @property
    def waived(self) -> str | None: ...  # noqa: D102
    def stated(self) -> str: ...  # noqa: D102


@dataclass(frozen=True)
class Line:
    """A criterion as a table row: texts, and the used share of its limit for the bar."""

    name: str
    step: str  # the block whose value is judged; empty if there is none
    title: str
    subject: str  # the step and the title
    verdict: str
    tag: str
    verdict_words: str
    sentence: str
    used: str
    share: float | None
    margin: str
    error: str
    missing: str
    give: tuple[str, ...]
    remarks: tuple[str, ...]
    unverified: bool = False
    is_open: bool = False
    is_error_unknown: bool = False

    @property
    def place(self) -> str:
        """Return the words in front of the sentence: the step, and the title if the sentence lacks it."""
        return self.step if self.sentence.startswith(self.title) else self.subject


def line(criterion: JudgedCriterion) -> Line:
    """Return a criterion as a table row of texts."""
    return Line(
        name=criterion.name,
        step=step_of(criterion.name, criterion.require),
        title=title(criterion.name, criterion.require),
        subject=subject_of(criterion.name, criterion.require),
        verdict=criterion.verdict,
        tag=tag(criterion),
        verdict_words=verdict_words(criterion),
        sentence=criterion.stated(),
        used="" if criterion.utilisation is None else numbers.share(criterion.utilisation),
        share=criterion.utilisation,
        margin=margin(criterion),
        error=error(criterion),
        missing=missing(criterion),
        give=tuple(criterion.give or ()),
        remarks=remarks(criterion),
        unverified=criterion.unverified is not None,
        is_open=is_open(criterion),
        is_error_unknown=_is_error_unknown(criterion),
    )


def sides(require: str) -> tuple[str, str, str]:
    """Return the left side, the sign and the right side of a requirement, as written."""
    parts = _SIGN.match(require)
    return (parts[1], parts[2], parts[3]) if parts else (require, "", "")


def plain_name(text: str) -> str:
    """Return a side of a requirement in words: `film.minimum_film_thickness` → `minimum film thickness`."""
    return _NAME.sub(lambda name: name[1].replace("_", " "), text).strip()


def step_of(name: str, require: str) -> str:
    """Return the block whose value is judged, from the criterion's name or its requirement."""
    own = Reference.parse(name)
    if own.output is not None:
        return own.block
    value = Reference.parse(sides(require)[0].strip())
    return value.block if value.output is not None and value.block.isidentifier() else ""


def subject_of(name: str, require: str) -> str:
    """Return a criterion in words, as every table names it: `film: bore deflection (rigid)`."""
    step, words = step_of(name, require), title(name, require)
    return f"{plain_name(step)}: {words}" if step else words


def limit_of(require: str) -> str:
    """Return the sign and the limit of a requirement in words: `≥ permissible film`."""
    _, sign, limit = sides(require)
    return f"{SIGNS.get(sign, sign)} {in_words(limit)}"


def title(name: str, require: str) -> str:
    """Return the judged value in words; for a value calculated within the criterion, the criterion's name.

    If the words do not contain the criterion's own name, that name follows, because another criterion may
    judge the same value.
    """
    left, own = sides(require)[0], plain_name(Reference.parse(name).own_name)
    subject = plain_name(left) if _ONE_NAME.fullmatch(left) else own
    return subject if own in subject else f"{subject} ({own})"


def verdict_words(criterion: JudgedCriterion) -> str:
    """Return the verdict in words, and whether its error is unknown."""
    words = WORDS[criterion.verdict]
    return f"{words}; {UNKNOWN}" if _is_error_unknown(criterion) else words


def tag(criterion: JudgedCriterion) -> str:
    """Return the CSS classes for the verdict on a page."""
    return f"{criterion.verdict} error-unknown" if _is_error_unknown(criterion) else criterion.verdict


def is_open(criterion: JudgedCriterion) -> bool:
    """Return whether a finer level might change or confirm the verdict."""
    return criterion.verdict == "undecided" or (_is_error_unknown(criterion) and criterion.level is not None)


def _is_error_unknown(criterion: JudgedCriterion) -> bool:
    return criterion.verdict in ("met", "not_met") and not criterion.error_known


def margin(criterion: JudgedCriterion) -> str:
    """Return the margin to the limit, with its range if the error is known; negative beyond the limit."""
    if criterion.margin is None:
        return ""
    left = numbers.in_line(criterion.margin)
    ends = _ends(criterion)
    return f"{left} ({numbers.plain(ends[0])} … {numbers.plain(ends[1])})" if ends else left


def _ends(criterion: JudgedCriterion) -> tuple[float, float] | None:
    """Return the smallest and the largest margin, in the unit of the margin.

    Return None if the error band does not determine them.
    """
    band, limit, left = criterion.band, criterion.limit, criterion.margin
    if band is None or limit is None or left is None or not band.unit == limit.unit == left.unit:
        return None
    low, high = band.value
    if low is None or high is None or low == high:
        return None
    at_least = sides(criterion.require)[1] == ">="
    return (low - limit.value, high - limit.value) if at_least else (limit.value - high, limit.value - low)


def error(criterion: JudgedCriterion) -> str:
    """Return the error of the value, in words."""
    if criterion.value is None:
        return ""
    if not criterion.error_known:
        return "unknown"
    if criterion.relative_error is None:
        return "open"
    return f"± {numbers.percent(criterion.relative_error)}"


def missing(criterion: JudgedCriterion) -> str:
    """Return the missing input, error or result that prevents a verdict; empty if there is a verdict."""
    if criterion.give:
        return f"give {', '.join(map(plain_name, criterion.give))}"
    if criterion.verdict == "undecided" and criterion.needs is not None:
        return f"needs an error below {numbers.percent(criterion.needs)}"
    return criterion.reason or ""


def remarks(criterion: JudgedCriterion) -> tuple[str, ...]:
    """Return remarks that restrict the verdict.

    They concern an unverified limit, a waiver, the worst place, and why there is no verdict or no error.
    """
    said = (
        f"unverified: {criterion.unverified}" if criterion.unverified else "",
        f"waived: {criterion.waived}" if criterion.waived else "",
        _where(criterion),
        criterion.reason if criterion.reason and missing(criterion) != criterion.reason else "",
    )
    return tuple(remark for remark in said if remark)


def _where(criterion: JudgedCriterion) -> str:
    places = [f"{plain_name(name)} {numbers.in_line(at)}" for name, at in (criterion.where or {}).items()]
    at = f"worst at {', '.join(places)}" if places else ""
    if not criterion.points or criterion.points == 1:
        return at
    each = [f"{number} {WORDS[verdict]}" for verdict, number in (criterion.counts or {}).items() if number]
    return "; ".join(filter(None, (at, f"{criterion.points} points: {', '.join(each)}")))


class VerdictSummary(Protocol):
    """The verdict over all criteria."""

    @property
    def verdict(self) -> str: ...  # noqa: D102 - the schema describes every field
    @property
    def green(self) -> bool: ...  # noqa: D102


def tone(verdict: VerdictSummary) -> str:
    """Return the colour of a verdict: green only if the interface permits it."""
    if verdict.green:
        return "green"
    return {"not_met": "bad", "undecided": "open", "not_checked": "open"}.get(verdict.verdict, "plain")


NOT_JUDGED = "criteria not judged (calculated before criteria existed); save to judge"
NO_CRITERIA = "no criteria: its templates declare none, and the design has none of its own"
_WHY = {
    "regenerating": "criteria not judged yet: the design is being calculated",
    "failed": "criteria not judged: the regeneration failed",
}


def headline_of(state: str, *, is_judged: bool) -> str:
    """Return the headline shown instead of a verdict, which says why there is none."""
    return NO_CRITERIA if is_judged else _WHY.get(state, NOT_JUDGED)
