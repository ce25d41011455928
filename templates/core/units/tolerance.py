"""Tolerances of quantities: `55 ± 5 um`, `55 +10/-5 um`, `48 mm H7`, or `plus` and `minus` of an object.

A tolerance gives the limits of a value and its distribution between them. Ordinary calculations ignore it.
With `55 ± 5 um, in table` (in an object: `state_in_table`), the table of a drawing states the tolerance if no
face can carry it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np

from templates.core.errors import FaultyText, excerpt
from templates.core.units.fits import deviations, zones
from templates.core.units.units import Unit, Value, difference_of, require_same_kind, unit

Distribution = Literal["normal", "uniform", "triangular"]
DISTRIBUTIONS: tuple[Distribution, ...] = get_args(Distribution)
FORMS = "55 ± 5 um, 55 +10/-5 um or 48 mm H7"
STATE_IN_TABLE = "state_in_table"
IN_TABLE = ", in table"
"""What follows a tolerance in a text instead of that key."""
KEYS = ("plus", "minus", "upper", "lower", "zone", "distribution", STATE_IN_TABLE)
"""The keys that an object may have in addition to `value` and `unit`."""

LONGEST_TEXT = 200
NUMBER = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?"
_SIGN = r"[+\-−]"
_FIRST = re.compile(r"(?:1(?=[/*·]))?(?![0-9.+\-−±])[^\s±+−]*")  # the unit before it; there may be none
_SAME = re.compile(rf"(?:±|\+\s?/?\s?[-−])\s*({NUMBER})\s*(.*)", re.DOTALL)
_TWO = re.compile(rf"({_SIGN}?)\s*({NUMBER})\s*/\s*({_SIGN}?)\s*({NUMBER})\s*(.*)", re.DOTALL)
_TABLE_AT_END = re.compile(r"\s*,\s*in\s+table\s*\Z")
_ZONE = re.compile(r"[A-Za-z]{1,2}[0-9]{1,2}")
_FIT = re.compile(rf"{_ZONE.pattern}\s*/\s*{_ZONE.pattern}")


@dataclass(frozen=True)
class Tolerance:
    """The limits of a value and its distribution between them.

    Attributes
    ----------
    lower, upper
        Deviations of the limits from the value [SI, a difference]; one for all points, or one for each.
    distribution
        The distribution between the limits: `normal` (limits at three standard deviations, truncated there),
        `uniform`, or `triangular`. Mean and peak are in the middle of the limits.
    zone
        The ISO 286 zone from which the limits come.
    state_in_table
        Whether the table of a drawing states it if no face can carry it.
    """

    lower: Value
    upper: Value
    distribution: Distribution = "normal"
    zone: str | None = None
    state_in_table: bool = False


@dataclass(frozen=True)
class Written:
    """A tolerance as written in a text: the unit of the value, and the text that follows."""

    unit: str
    lower: float
    upper: float
    scale: str
    zone: str | None = None
    state_in_table: bool = False

    def of(self, si: float, name: str, declared: str) -> tuple[Tolerance, dict[str, Any]]:
        """Return the tolerance of a value [SI] in the unit `name`, and its text for an answer.

        Raises
        ------
        FaultyText
            If the limits contradict each other or the value.
        """
        if self.zone is not None:
            tolerance, extra = in_zone(self.zone, si, name)
        else:
            factor = _difference(self.scale, declared).factor
            tolerance = _between(self.lower * factor, self.upper * factor)
            extra = stated(tolerance, require_same_kind(name, declared))
        if self.state_in_table:
            return replace(tolerance, state_in_table=True), {**extra, STATE_IN_TABLE: True}
        return tolerance, extra


def split(text: str) -> Written | None:
    """Return the text after the number of a quantity if it contains a tolerance, otherwise None.

    Raises
    ------
    FaultyText
        If the text begins like a tolerance but cannot be read as one.
    """
    if suffix := _TABLE_AT_END.search(text):
        written = split(text[: suffix.start()])
        if written is None:
            detail = f"`in table` follows a tolerance; write it like {FORMS}, in table"
            raise FaultyText("not_a_tolerance", detail)
        return replace(written, state_in_table=True)
    first = match[0] if (match := _FIRST.match(text)) else ""
    rest = text[len(first) :].strip()
    if not rest:
        return None
    if same := _SAME.fullmatch(rest):
        half = float(same[1])
        return _written(first, -half, half, same[2])
    if two := _TWO.fullmatch(rest):
        one, other = _signed(two[1], two[2]), _signed(two[3], two[4])
        return _written(first, min(one, other), max(one, other), two[5])
    if first and _ZONE.fullmatch(rest):
        return Written(first, 0.0, 0.0, first, rest)
    if _FIT.fullmatch(rest):
        detail = "a fit names two parts: give the bore the first zone, and the shaft the second"
        raise FaultyText("not_a_tolerance", f"{excerpt(rest)} is not a tolerance of one value; {detail}")
    if rest[0] in "±+−":
        raise FaultyText("not_a_tolerance", f"{excerpt(rest)} is not a tolerance; write it like {FORMS}")
    return None


def _written(first: str, lower: float, upper: float, last: str) -> Written:
    """Return the value and its limits in the last unit of the text, or otherwise in the unit of the value."""
    last = last.strip()
    return Written(first or last or "1", lower, upper, last or first or "1")


def _signed(sign: str, number: str) -> float:
    """Return a deviation; only zero may be written without a sign."""
    size = float(number)
    if not sign and size:
        raise FaultyText("not_a_tolerance", f"give {number} a sign, for example {FORMS}")
    return size if sign == "+" or not size else -size


def is_toleranced(raw: Any) -> bool:
    """Return whether a quantity as the user wrote it has a tolerance; for a list, whether any item has."""
    match raw:
        case str():
            return _has_tolerance(raw)
        case Mapping():
            return not raw.keys().isdisjoint(KEYS)
        case list() | tuple():
            return any(isinstance(item, (str, Mapping)) and is_toleranced(item) for item in raw)
    return False


_QUANTITY = re.compile(rf"\s*[+-]?{NUMBER}\s*(.*)", re.DOTALL)


def _has_tolerance(text: str) -> bool:
    match = _QUANTITY.fullmatch(text) if len(text) <= LONGEST_TEXT else None
    try:
        return match is not None and split(match[1].strip()) is not None
    except FaultyText:
        return False


def is_zone(text: str) -> bool:
    """Return whether a text names a zone in the table."""
    return text in zones()


def from_object(raw: Mapping[str, Any], name: str, declared: str, si: Value) -> Tolerance | None:
    """Return the tolerance of an object whose value is `si` [SI] in the unit `name`; None if it has none.

    `plus` and `minus` are the largest deviations above and below the value; `upper` and `lower` are signed
    deviations, for limits that may both be on one side. Each is a number in the value's unit, or a text.

    Raises
    ------
    FaultyText
        If the tolerance is wrong; the error states a code and a remedy.
    """
    given = raw.keys() & KEYS
    if not given:
        return None
    distribution = _distribution(raw.get("distribution", "normal"))
    in_table = _in_table(raw.get(STATE_IN_TABLE, False))
    limits = {key: _deviation(raw[key], name, declared) for key in given & {*KEYS[:4]}}
    if "zone" in raw:
        return replace(_of_zone(raw["zone"], limits, si, name, distribution), state_in_table=in_table)
    if not limits:
        detail = "`distribution` and `state_in_table` need limits: give plus, minus or a zone"
        raise FaultyText("not_a_tolerance", detail)
    return replace(_between(*_ends(limits), distribution), state_in_table=in_table)


def _in_table(raw: Any) -> bool:
    if not isinstance(raw, bool):
        detail = f"{excerpt(raw)} is not a value of `state_in_table`; give true or false"
        raise FaultyText("not_an_option", detail)
    return raw


def _distribution(raw: Any) -> Distribution:
    for name in DISTRIBUTIONS:
        if raw == name:
            return name
    choices = ", ".join(DISTRIBUTIONS)
    raise FaultyText("not_an_option", f"{excerpt(raw)} is not a distribution of a tolerance; give {choices}")


def _deviation(raw: Any, name: str, declared: str) -> float:
    """Return a deviation [SI], from a number in the value's unit or from a text."""
    if isinstance(raw, str):
        match = re.fullmatch(rf"([+\-−]?)\s*({NUMBER})\s*(.*)", raw.strip(), re.DOTALL)
        if not match or len(raw) > LONGEST_TEXT:
            raise FaultyText("not_a_quantity", f"{excerpt(raw)} is not a tolerance; write it like 5 {name}")
        return float(match[1].replace("−", "-") + match[2]) * _of_text(match[3], declared).factor
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        raise FaultyText(
            "not_a_number", f"{excerpt(raw)} is not a number; write it like `1.5`, without quotes"
        )
    try:
        return float(raw) * require_same_kind(name, declared).factor
    except OverflowError:
        return math.inf


def _of_text(name: str, declared: str) -> Unit:
    """Return the unit of a tolerance that is given as a text.

    A tolerance of a temperature is a difference, so its unit is not degC.
    """
    if not name and declared != "1":
        raise FaultyText("missing_unit", f"the tolerance has no unit; add it, for example `5 {declared}`")
    scale = unit(name or "1")
    if scale.absolute and unit(declared).absolute:
        raise FaultyText("wrong_unit", f"a tolerance is a difference: give it in K or {difference_of(name)}")
    return _difference(name or "1", declared)


def _difference(name: str, declared: str) -> Unit:
    """Return the unit of a deviation; a deviation of 5 degC is 5 K."""
    scale = unit(name)
    return scale if scale.difference and _is_temperature(declared) else require_same_kind(name, declared)


def _is_temperature(declared: str) -> bool:
    return unit(declared).base == unit("K").base


def _ends(limits: Mapping[str, float]) -> tuple[float, float]:
    """Return the lower and upper deviation, from `plus` and `minus`, or from `lower` and `upper`."""
    if limits.keys() <= {"plus", "minus"}:
        for key, size in limits.items():
            if size < 0:
                hint = "for limits on one side give upper and lower with their signs"
                raise FaultyText("out_of_range", f"{key} is the largest deviation: give 0 or more; {hint}")
        return 0.0 - limits.get("minus", 0.0), limits.get("plus", 0.0)
    if limits.keys() != {"upper", "lower"}:
        raise FaultyText("not_a_tolerance", "give plus and minus, or both upper and lower")
    return limits["lower"], limits["upper"]


def _of_zone(
    zone: Any, limits: Mapping[str, float], si: Value, name: str, distribution: Distribution
) -> Tolerance:
    if not isinstance(zone, str):
        raise FaultyText("unknown_zone", f"{excerpt(zone)} is not a tolerance zone; write it like `H7`")
    if not isinstance(si, float):
        raise FaultyText(
            "not_single",
            "a tolerance zone applies to one size; give each item its own, for example `48 mm H7`",
        )
    tolerance, _ = in_zone(zone, si, name, distribution)
    if limits and not np.allclose(_ends(limits), deviations(zone, si), rtol=1e-6, atol=1e-12):
        raise FaultyText("not_a_tolerance", f"these are not the limits of {zone}; give the zone alone")
    return tolerance


def in_zone(
    zone: str, si: float, name: str, distribution: Distribution = "normal"
) -> tuple[Tolerance, dict[str, Any]]:
    """Return the tolerance of a nominal size [m] in a zone of ISO 286, and the text that an answer shows.

    Raises
    ------
    FaultyText
        If the zone is not available, or not for this size; if the quantity is not a length.
    """
    scale = unit(name)
    if scale.base != unit("m").base:
        raise FaultyText("wrong_unit", f"{zone} is a tolerance zone of lengths, not of a quantity in {name}")
    tolerance = Tolerance(*deviations(zone, si), distribution, zone)
    return tolerance, {**stated(tolerance, scale), "zone": zone}


def _between(lower: float, upper: float, distribution: Distribution = "normal") -> Tolerance:
    if not (math.isfinite(lower) and math.isfinite(upper)):
        raise FaultyText("not_finite", "a tolerance must be finite: not NaN, infinity or above 1.8e308")
    if lower > upper:
        raise FaultyText("not_a_tolerance", "the lower limit is above the upper limit; swap them")
    return Tolerance(lower, upper, distribution)


def stated(tolerance: Tolerance, scale: Unit) -> dict[str, Any]:
    """Return a tolerance in a unit as an answer states it: `plus`, `minus`; or `upper`, `lower`."""
    lower, upper = (_short(float(end) / scale.factor) for end in (tolerance.lower, tolerance.upper))
    if lower <= 0 <= upper:
        return {"plus": upper, "minus": 0.0 if lower == 0 else -lower}
    return {"upper": upper, "lower": lower}


def _short(number: float) -> float:
    """Return a number without its last digits, which are rounding errors of the unit conversion."""
    return float(f"{number:.12g}")


def joined(tolerances: list[Tolerance | None]) -> Tolerance | None:
    """Return the tolerances of the items of a list as one tolerance; None if no item has one.

    Raises
    ------
    FaultyText
        If the items have different distributions.
    """
    present = [one for one in tolerances if one is not None]
    if not present:
        return None
    if len({one.distribution for one in present}) > 1:
        raise FaultyText("not_a_tolerance", "all items of a list must have the same distribution")
    lower, upper = (
        np.array([0.0 if one is None else getattr(one, end) for one in tolerances])
        for end in ("lower", "upper")
    )
    in_table = any(one.state_in_table for one in present)
    return Tolerance(lower, upper, present[0].distribution, state_in_table=in_table)
