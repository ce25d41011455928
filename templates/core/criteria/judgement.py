"""A judged criterion: its verdict, the numbers behind it, and sentences about the two compared values.

Warnings of criteria and of rules are written here. They state the actual relation, never the required one,
so no sentence contradicts its own numbers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

from templates.core.criteria.comparison import NOT_CHECKED, Codes, Verdict
from templates.core.units.units import unit_symbol

IS = {"<": "is below", "<=": "is not above", ">": "is above", ">=": "is not below"}
DIGITS = 4  # significant digits in a sentence, unless two numbers need more to differ
_MOST_DIGITS = 17
_NAME = re.compile(r"(?:[A-Za-z]\w*\.)*([A-Za-z]\w*)")
_NUMBER = re.compile(r"-?[0-9][0-9.]*(?:[eE][-+]?[0-9]+)?(?: \S+)?")
_FACTOR = r"[A-Za-zµ°%][A-Za-z_µ°%²³]*(?:\*\*-?[0-9]+)?"
_TERM = re.compile(
    r"(?P<number>(?<![\w.])[0-9][0-9.]*(?:[eE][-+]?[0-9]+)?) "
    rf"(?P<unit>{_FACTOR}(?:[*/](?:{_FACTOR}|\({_FACTOR}(?:\*{_FACTOR})*\)))*)|{_NAME.pattern}"
)
"""A number with its unit, or a name."""


@dataclass(frozen=True, slots=True)
class Place:
    """Location of the worst value: a point of an array, counted from 1, or a place along a curve.

    A place without a unit is the name of a variant of a design.
    """

    name: str
    value: Any
    unit: str


@dataclass(slots=True)  # a frozen instance would take 25 times as long to create
class Judgement:
    """A judged criterion; over several points or places it describes the worst of them.

    Attributes
    ----------
    value, limit, margin
        In `unit`, the margin in `margin_unit`; None where there is none. A positive margin is safe.
    band
        In `unit`; an open end is infinite. None where the error is unknown.
    error_known
        Whether every error that contributes to the band is known. If not, the verdict is that of the value
        itself, unless the known part of the band contains the limit.
    needs
        The relative error below which the verdict would be decided; None above 1.
    give
        The names of the missing inputs.
    rows
        The verdict at every point, as indices in `VERDICTS`.
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
        """Return whether the verdict depends on nothing unverified and on no unknown error."""
        return self.error_known and self.unverified is None

    @property
    def is_open(self) -> bool:
        """Return whether a finer calculation may change the verdict: undecided, or an error is unknown."""
        is_compared = self.verdict in ("met", "not_met") and self.margin is not None
        return self.verdict == "undecided" or (is_compared and not self.error_known)

    @property
    def sides(self) -> tuple[str, str]:
        """Return the value and the limit as text."""
        return _parts_of(self.require).sides

    @property
    def sign(self) -> str:
        """Return the required sign between value and limit."""
        return _parts_of(self.require).sign

    @property
    def has_fixed_limit(self) -> bool:
        """Return whether the limit follows from a literal number in the criterion."""
        return self.sides[1].removeprefix("-")[:1].isdigit()

    @property
    def misses(self) -> bool:
        """Return whether the value itself, without its error, violates the limit."""
        return self.margin is not None and self.margin < 0


def sentence(judgement: Judgement) -> str:
    """Return a verdict as a sentence: `film 1.53 µm is below permissible film 2 µm: not met`."""
    value, limit = judgement.value, judgement.limit
    return verdict_sentence(
        judgement.require,
        judgement.verdict,
        None if value is None or limit is None else (value, limit, judgement.unit),
        misses=judgement.misses,
        error_known=judgement.error_known,
        truth=judgement.truth,
    )


def verdict_sentence(
    require: str,
    verdict: str,
    numbers: tuple[float, float, str] | None,
    *,
    misses: bool,
    error_known: bool,
    truth: str | None,
) -> str:
    """Return a sentence that states a requirement and its verdict, with value, limit and unit if present."""
    parts = _parts_of(require)
    words = verdict.replace("_", " ") + (f", {truth}" if is_model(truth) else "")
    if numbers is None:
        return f"{parts.written}: {words}"
    value, limit, unit = numbers
    if not (math.isfinite(value) and math.isfinite(limit)):
        return f"{parts.written}: {words}"
    actual = {">=": "<", "<=": ">"}[parts.sign] if misses else parts.sign
    unknown = "" if error_known or verdict == "not_checked" else "; error unknown"
    sides = Side(parts.value_words, value), Side(parts.limit_words, limit)
    return f"{compared(sides[0], actual, sides[1], unit)}: {words}{unknown}"


class _Parts(NamedTuple):
    """A required comparison, split into its parts.

    `sides` are value and limit as text; `written` is the whole comparison with labels for names; the words of
    each side precede its number.
    """

    sign: str
    sides: tuple[str, str]
    value_words: str
    limit_words: str
    written: str


@lru_cache(maxsize=1024)  # bounded, because worksheets and designs keep adding criteria
def _parts_of(require: str) -> _Parts:
    sign = ">=" if ">=" in require else "<="
    left, _, right = require.partition(sign)
    value, limit = left.strip(), right.strip()
    written = f"{_name(value)} {sign} {_name(limit)}"
    return _Parts(sign, (value, limit), _in_words(value), _in_words(limit), written)


def _is_number(side: str) -> bool:
    return bool(_NUMBER.fullmatch(side))


def is_model(truth: str | None) -> bool:
    """Return whether a truth is a model of the part, such as `rigid film`.

    Other truths are solutions of the same model, such as a level or a finer mesh.
    """
    return truth is not None and truth.endswith(" film")


def not_judged(judgement: Judgement) -> str:
    """Return a sentence that gives the reason why there is no verdict."""
    return f"{judgement.words} cannot be judged: {judgement.reason}"


def _in_words(text: str) -> str:
    """Return the words that precede the value of a side; empty for a number, which needs none."""
    if _is_number(text):
        return ""
    return _name(text) if _NAME.fullmatch(text) else f"{_name(text)} ="


def _name(text: str) -> str:
    """Return the labels of names without their steps, and numbers with the printed form of their units."""
    return text if _is_number(text) else in_words(text)


def in_words(text: str) -> str:
    """Return a side of a comparison with the labels of its names and the printed form of its units."""
    return _TERM.sub(_label, text)


def _label(term: re.Match[str]) -> str:
    if term["number"]:
        return f"{term['number']} {unit_symbol(term['unit'])}"
    return term[term.lastindex or 0].replace("_", " ")


class Side(NamedTuple):
    """One side of a comparison: its words, which may be empty, and its magnitude in the common unit."""

    words: str
    magnitude: float


def related(left: str, sign: str, right: str) -> str:
    """Return the true relation without numbers, as in `minimum film thickness is below permissible film`."""
    return f"{left} {IS[sign]} {right}"


def compared(left: Side, sign: str, right: Side, unit: str) -> str:
    """Return a true comparison, such as `minimum film thickness 2.133 µm is below permissible film 3 µm`."""
    printed, (one, other) = unit_symbol(unit), told_apart(left.magnitude, right.magnitude)
    first, second = f"{left.words} {one} {printed}".strip(), f"{right.words} {other} {printed}".strip()
    return f"{first} {IS[sign]} {second}"


def told_apart(one: float, other: float) -> tuple[str, str]:
    """Return two numbers as text, with enough digits to differ if they are not equal."""
    texts = (f"{one:.{DIGITS}g}", f"{other:.{DIGITS}g}")
    digits = DIGITS
    while texts[0] == texts[1] and one != other and digits < _MOST_DIGITS:
        digits += 1
        texts = (f"{one:.{digits}g}", f"{other:.{digits}g}")
    return texts
