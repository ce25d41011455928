"""A judged criterion: its verdict, and the numbers behind it at the worst point or place."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from templates.core.criteria.comparison import NOT_CHECKED, Codes, Verdict
from templates.core.criteria.sentences import Side, compared

_NAME = re.compile(r"(?:[A-Za-z]\w*\.)*([A-Za-z]\w*)")


@dataclass(frozen=True, slots=True)
class Place:
    """Place of the worst value: a point of an array, counted from 1, or a place along a curve.

    A place without a unit is a name: that of a variant of a design.
    """

    name: str
    value: Any
    unit: str


@dataclass(slots=True)  # frozen, each would cost 25 times as much
class Judgement:
    """A criterion as judged; over several points or places it stands for the worst of them.

    Attributes
    ----------
    value, limit, margin
        In `unit`, the margin in `margin_unit`; None where there is none. A positive margin is safe.
    band
        In `unit`; an open end is infinite. None where the error is not known.
    error_known
        Whether every error that contributes to the band is known. Without it the verdict is that of the value
        itself, unless the known part of the band holds the limit.
    needs
        The relative error below which the verdict would be decided; None above 1.
    give
        The names of what is missing.
    rows
        The verdict at every point, as places in `VERDICTS`.
    """

    name: str
    words: str
    require: str
    verdict: Verdict
    unit: str
    value: float | None = None
    limit: float | None = None
    band: tuple[float, float] | None = None
    relative_error: float | None = None
    error_known: bool = True
    utilisation: float | None = None
    margin: float | None = None
    margin_unit: str = ""
    needs: float | None = None
    give: tuple[str, ...] = ()
    reason: str | None = None
    level: str | None = None
    truth: str | None = None
    where: tuple[Place, ...] = ()
    points: int | None = None
    counts: Mapping[Verdict, int] | None = None
    rows: Codes = NOT_CHECKED
    source: str | None = None
    unverified: str | None = None
    warning: str | None = None
    waived: str | None = None

    @property
    def is_certain(self) -> bool:
        """Return whether nothing about the verdict is unverified, or follows from an unknown error."""
        return self.error_known and self.unverified is None

    @property
    def is_open(self) -> bool:
        """Return whether a finer calculation may tell more: undecided, or compared with an unknown error."""
        is_compared = self.verdict in ("met", "not_met") and self.margin is not None
        return self.verdict == "undecided" or (is_compared and not self.error_known)

    @property
    def sides(self) -> tuple[str, str]:
        """Return the texts of value and limit."""
        value, _, limit = self.require.partition(self.sign)
        return value.strip(), limit.strip()

    @property
    def sign(self) -> str:
        """Return the sign between value and limit that is required."""
        return ">=" if ">=" in self.require else "<="

    @property
    def has_fixed_limit(self) -> bool:
        """Return whether the limit is a number that stands in the criterion itself."""
        return self.sides[1].removeprefix("-")[:1].isdigit()

    @property
    def misses(self) -> bool:
        """Return whether the value, its error aside, lies beyond the limit."""
        return self.margin is not None and self.margin < 0


def sentence(judgement: Judgement) -> str:
    """Return a verdict as a sentence: `film 1.53 µm is below permissible film 2 µm: not met`."""
    verdict = judgement.verdict.replace("_", " ")
    verdict += f", {judgement.truth}" if is_model(judgement.truth) else ""
    unknown = "" if judgement.error_known or judgement.verdict == "not_checked" else "; error unknown"
    value, limit = judgement.value, judgement.limit
    left, right = map(_in_words, judgement.sides)
    if value is None or limit is None:
        return f"{left} {judgement.sign} {right}: {verdict}"
    opposite = {">=": "<", "<=": ">"}[judgement.sign]
    sign = opposite if judgement.misses else judgement.sign
    return f"{compared(Side(left, value), sign, Side(right, limit), judgement.unit)}: {verdict}{unknown}"


def is_model(truth: str | None) -> bool:
    """Return whether a truth is a model named in words, such as `rigid film`; others are names of levels."""
    return truth is not None and " " in truth


def not_judged(judgement: Judgement) -> str:
    """Return why there is no verdict, as a sentence."""
    return f"{judgement.words} cannot be judged: {judgement.reason}"


def _in_words(text: str) -> str:
    """Return a side in words; a number stands for itself, and is shown as the value."""
    if text.removeprefix("-")[:1].isdigit():
        return ""
    words = _NAME.sub(lambda name: name[1].replace("_", " "), text)
    return words if _NAME.fullmatch(text) else f"{words} ="
