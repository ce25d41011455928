"""Format values for a report: a number split at the decimal point for alignment, and its unit."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from app.calculations.schemas.evaluations import Output, UsedInput
from app.plain import Raw
from app.presentation import numbers
from app.presentation.input_text import text_of
from app.presentation.numbers import in_line
from app.schemas.answers import Quantity, Shown, Values
from app.solids.schemas.analyses import AnalysisOutput
from templates.core.units.units import base_text, dimension_of, unit

DIGITS_TYPED = 12  # digits shown of a typed number, as many as are stored
_DERIVED = ("1", "m", "kg", "s", "N", "Pa", "J", "W", "K", "rad", "rad/s", "Hz")
_COMPOSED = (*_DERIVED, "m**2", "m**3", "m**2/s", "m**3/s", "Pa*s", "N/m", "N*s/m", "kg*m**2", "N*m")
_UNSEEN = re.compile("[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")
_WORD = re.compile(r"[A-Za-zµμ°Ω%_]+")
WRITTEN = numbers.PARTS  # parts of a quantity that a line shows
TOLERANCE = WRITTEN[3:]


@dataclass(frozen=True)
class Cell:
    """A formatted value: the two parts of a number with its unit, or a text if there is no single number."""

    whole: str = ""
    rest: str = ""
    unit: str = ""
    text: str = ""


NOTHING = Cell()

Valued = Quantity | Values | Shown | Output | UsedInput | AnalysisOutput
"""Answers that have a value and a unit."""


def cell(quantity: Valued, *, whole: bool = False) -> Cell:
    """Return a quantity as the interface shows it, with five digits, or with all typed digits (`whole`)."""
    value = quantity.value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        parts = _all_digits(value) if whole else numbers.aligned(value)
        return Cell(*parts, numbers.unit(quantity.unit) + _tolerance(quantity))
    return Cell(text=clean(_in_words(quantity)))


def _in_words(quantity: Valued) -> str:
    """Return a text, an array, or the reason for a missing value.

    Points without a value are dashes, followed by the reasons.
    """
    fields = {name: getattr(quantity, name) for name in WRITTEN if name in quantity.model_fields_set}
    if not isinstance(quantity, Output) or not quantity.reasons:
        return in_line(fields)
    reasons = dict.fromkeys(str(reason) for reason in flat(quantity.reasons) if reason)
    return f"{in_line({**fields, 'value': _dashed(quantity.value)})} (–: {'; '.join(reasons)})"


def flat(value: object) -> list[object]:
    """Return all items of a list of any nesting depth; a single value becomes a list of one."""
    return [item for part in value for item in flat(part)] if isinstance(value, list) else [value]


def _dashed(value: object) -> object:
    return [_dashed(item) for item in value] if isinstance(value, list) else "–" if value is None else value


def typed(raw: Raw) -> str:
    """Return a value as its user typed it."""
    return clean(text_of(raw))


def clean(text: str) -> str:
    """Return a user's text without invisible characters: control characters and direction marks."""
    return _UNSEEN.sub(" ", text)


def in_si(quantity: Valued) -> Cell:
    """Return a value in SI units; empty for texts and arrays."""
    value, name = quantity.value, quantity.unit
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not name:
        return NOTHING
    return cell(Quantity(value=float(unit(name).to_si(float(value))), unit=si_unit(name)))


@lru_cache(maxsize=512)
def si_unit(text: str) -> str:
    """Return the coherent SI unit of a unit, with the same composition.

    `kN` → `N`, `mPa*s` → `Pa*s`, `rpm` → `rad/s`.
    """
    whole = _WORD.fullmatch(text) or text == "1"
    if not whole:
        replaced = _WORD.sub(lambda word: _coherent(word[0], _DERIVED) or "?", text)
        composed = re.sub(r"(?<=/)rad/s|m\*\*3(?=\*\*)", "?", replaced)
        if "?" not in composed and unit(composed).factor == 1:
            return composed
    return _coherent(text, _COMPOSED) or base_text(unit(text))


def _coherent(text: str, candidates: tuple[str, ...]) -> str | None:
    """Return the candidate of the same dimension.

    An angle is given in rad, although it counts as a pure number.
    """
    measured = unit(text)
    alike = [si for si in candidates if dimension_of(unit(si)) == dimension_of(measured)]
    exact = (si for si in alike if str(unit(si).base) == str(measured.base))
    return next(exact, alike[0] if alike else None)


def _all_digits(value: float) -> tuple[str, str]:
    """Return a number with all digits that the user typed."""
    shown = f"{value:.{DIGITS_TYPED}g}"
    if "e" in shown:
        return tuple(numbers.aligned(value))  # type: ignore[return-value]
    whole, point, fraction = shown.partition(".")
    return whole.replace("-", "−"), point + fraction


def _tolerance(quantity: Valued) -> str:
    written = {name: getattr(quantity, name) for name in TOLERANCE if name in quantity.model_fields_set}
    return f" {numbers.tolerance(written)}" if written else ""
