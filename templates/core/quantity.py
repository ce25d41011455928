"""Units, handled once at the edge: from what a user types to SI floats, and back.

The one Pint registry lives here and reads units only; no Pint object reaches a formula's hot path.
A unit text is untrusted: its grammar is checked before Pint sees it (`m**9**9**9` would hang Pint).

Angular speed is kept in rad/s. The radian counts as a dimension of its own where a rate is meant,
so that `50 1/s` or `50 Hz` is refused as a speed instead of being wrong by 2π.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import pint
from numpy.typing import NDArray

from templates.core.errors import FaultyText

Value = float | NDArray[np.float64]

registry: pint.UnitRegistry[float] = pint.UnitRegistry()
registry.define("@alias revolution = rev")

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?"
_NAME = r"(?:[A-Za-zµμ°Ω]+(?:_[A-Za-z]+)*|%)"
_POWER = r"(?:(?:\*\*|\^)-?[0-9]{1,2}|[²³])?"
_FACTOR = rf"{_NAME}{_POWER}"
_PRODUCT = rf"{_FACTOR}(?:[*·]{_FACTOR})*"
_UNIT = rf"(?:1|{_PRODUCT})(?:[*·/](?:{_FACTOR}|\({_PRODUCT}\)))*"
UNIT_PATTERN = re.compile(_UNIT)
_QUANTITY_PATTERN = re.compile(rf"\s*({NUMBER})\s*(\S.*?)?\s*", re.DOTALL)
_LONGEST_TEXT = 200


@dataclass(frozen=True)
class Unit:
    """A unit as typed, reduced to SI: si = value · factor + offset."""

    text: str
    factor: float
    offset: float
    base: pint.Unit
    difference: bool  # of two temperatures

    @property
    def absolute(self) -> bool:
        """Whether this is a temperature scale with a zero of its own, such as degC."""
        return self.offset != 0.0

    def to_si(self, value: Value) -> Value:
        """The value [this unit] in SI."""
        return value * self.factor + self.offset

    def from_si(self, value: Value) -> Value:
        """The value [SI] in this unit."""
        return (value - self.offset) / self.factor


@lru_cache(maxsize=4096)
def unit(text: str) -> Unit:
    """Read a unit such as `kN`, `mm²/s`, `N*m`, `rpm` or `degC`; `1` is a pure number.

    Raises
    ------
    FaultyText
        If the text is no unit, or one that Pint does not know.
    """
    if len(text) > 60 or not UNIT_PATTERN.fullmatch(text):
        raise FaultyText("unknown_unit", f"{text[:60]!r} is no unit; write it as in kN, mm**2/s, W/(m*K)")
    try:
        named = registry.Unit("" if text == "1" else text)
        size, base = registry.get_base_units(named)
        factor = float(size)  # type: ignore[arg-type]
        zero, two = (float(registry.Quantity(x, named).to_base_units().magnitude) for x in (0.0, 2.0))
    except (pint.PintError, ArithmeticError, AttributeError, TypeError, ValueError):
        raise FaultyText("unknown_unit", f"{text!r} is no known unit; {_hint(text)}") from None
    if not (0 < factor < math.inf and math.isclose(two, 2 * factor + zero, rel_tol=1e-9)):
        raise FaultyText("unknown_unit", f"{text!r} has no fixed size (a logarithmic unit?)")
    return Unit(text, factor, zero, registry.Unit(base), text.startswith("delta_"))


def _hint(text: str) -> str:
    hints = {"C": "for a temperature write degC", "F": "for a temperature write degF", "U/min": "write rpm"}
    return hints.get(text, "units are case-sensitive: mm, kN, MPa, mPa*s, rpm, degC")


def compatible(one: pint.Unit, other: pint.Unit) -> bool:
    """Whether two base units mean the same kind of quantity; a rate in rad/s is none in 1/s."""
    if registry.get_dimensionality(one) != registry.get_dimensionality(other):
        return False
    is_rate = registry.get_dimensionality(one) == registry.get_dimensionality(registry.Unit("1/s"))
    return not is_rate or _radians(one) == _radians(other)


def _radians(base: pint.Unit) -> float:
    exponents: dict[str, Any] = dict(registry.Quantity(1.0, base).unit_items())
    return float(exponents.get("radian", 0))


@lru_cache(maxsize=4096)
def require_same_kind(typed: str, declared: str) -> Unit:
    """The unit `typed`, if a quantity declared in `declared` can be given in it.

    Raises
    ------
    FaultyText
        If it measures something else, is ambiguous as a speed, or mixes a temperature with a difference.
    """
    got, want = unit(typed), unit(declared)
    if compatible(got.base, want.base) and not _mixes_difference(got, want):
        return got
    raise FaultyText(*_why_not(got, want))


def _mixes_difference(got: Unit, want: Unit) -> bool:
    return (got.difference and not want.difference) or (got.absolute and want.difference)


def _why_not(got: Unit, want: Unit) -> tuple[str, str]:
    if registry.get_dimensionality(got.base) != registry.get_dimensionality(want.base):
        dimension = registry.get_dimensionality(got.base)
        hint = " (U is pint's enzyme unit: write rpm)" if got.text.startswith("U/") else ""
        return (
            "wrong_unit",
            f"{got.text} measures {dimension}{hint}; give it in {want.text} or its like",
        )
    if _mixes_difference(got, want):
        return "wrong_unit", f"{got.text} and {want.text} mix a temperature with a difference of temperatures"
    if _radians(want.base):
        return (
            "ambiguous_unit",
            f"{got.text} is ambiguous for a speed (turns or radians?): write rpm or rad/s",
        )
    return "ambiguous_unit", f"{got.text} counts angle; for {want.text} give a unit without rad or turn"


@dataclass(frozen=True)
class Typed:
    """A quantity as its user typed it, and what it is in SI."""

    value: Any
    unit: str
    si: Value
    extra: dict[str, Any]


def read(raw: Any, declared: str) -> Typed:
    """Read a quantity in any of its written forms, for something declared in the unit `declared`.

    Forms: `"25 kN"`, `{"value": 25, "unit": "kN"}` (value may be a list; `plus`, `minus` may stand by it),
    a list of such, and a bare number or list of numbers where the declared unit is `1`.

    Raises
    ------
    FaultyText
        With a code and a remedy.
    """
    match raw:
        case str():
            return _read_text(raw, declared)
        case dict():
            return _read_object(raw, declared)
        case list() | np.ndarray():
            return _read_list(list(raw), declared)
        case bool() | None:
            raise _no_quantity(raw, declared)
        case int() | float() | np.floating() | np.integer():
            return _read_bare(raw, declared)
    raise _no_quantity(raw, declared)


def read_any(raw: Any) -> Typed:
    """Read a quantity of whatever kind its own unit says.

    Raises
    ------
    FaultyText
        With a code and a remedy.
    """
    return read(raw, _own_unit(raw))


def _own_unit(raw: Any) -> str:
    match raw:
        case str():
            match = _QUANTITY_PATTERN.fullmatch(raw) if len(raw) <= _LONGEST_TEXT else None
            return (match[2] if match else None) or "1"
        case {"unit": str() as name}:
            return name
        case [first, *_]:
            return _own_unit(first)
    return "1"


def _read_text(text: str, declared: str) -> Typed:
    match = _QUANTITY_PATTERN.fullmatch(text) if len(text) <= _LONGEST_TEXT else None
    if match is None:
        raise _no_quantity(text, declared)
    number, name = match.groups()
    if name is None:
        return _read_bare(_number(number), declared)
    return _quantity(_number(number), name, declared)


def _read_object(raw: dict[str, Any], declared: str) -> Typed:
    extra: dict[str, Any] = {key: raw[key] for key in ("plus", "minus") if key in raw}
    if set(raw) - {"value", "unit", "plus", "minus"} or "value" not in raw:
        raise _no_quantity(raw, declared)
    if not isinstance(raw.get("unit", "1"), str):
        raise _no_quantity(raw, declared)
    if "unit" not in raw and declared != "1":
        raise FaultyText("missing_unit", f'the unit is missing; add "unit": "{declared}"')
    for tolerance in extra.values():
        _read_text(tolerance, declared) if isinstance(tolerance, str) else _number(tolerance)
    value = raw["value"]
    magnitude = _array(value) if isinstance(value, list) else _number(value)
    typed = _quantity(magnitude, raw.get("unit", "1"), declared)
    return Typed(value, typed.unit, typed.si, extra)


def _read_list(raw: list[Any], declared: str) -> Typed:
    if raw and all(isinstance(item, (str, dict)) for item in raw):
        parts = [read(item, declared) for item in raw]
        si = np.array([part.si for part in parts], dtype=float)
        return Typed(np.asarray(unit(declared).from_si(si)).tolist(), declared, si, {})
    if declared != "1":
        raise FaultyText("missing_unit", f'the unit is missing; write {{"value": […], "unit": "{declared}"}}')
    return _quantity(_array(raw), "1", declared)


def _read_bare(raw: Any, declared: str) -> Typed:
    if declared != "1":
        raise FaultyText("missing_unit", f'{raw:.15g} has no unit; write it as "{raw:.15g} {declared}"')
    return _quantity(_number(raw), "1", declared)


def _quantity(magnitude: Value, name: str, declared: str) -> Typed:
    given_in = require_same_kind(name, declared)
    si = given_in.to_si(magnitude)
    if not np.all(np.isfinite(si)):
        raise FaultyText("not_finite", f"the value is too large in {name}")
    shown = magnitude.tolist() if isinstance(magnitude, np.ndarray) else magnitude
    return Typed(shown, name, si, {})


def _number(raw: Any) -> float:
    if isinstance(raw, bool) or not isinstance(raw, (int, float, str)):
        raise FaultyText("not_a_number", f"{str(raw)[:60]!r} is no number")
    try:
        number = float(raw)
    except (OverflowError, ValueError):
        raise FaultyText("not_a_number", f"{str(raw)[:60]!r} is no finite number") from None
    if not math.isfinite(number):
        raise FaultyText("not_finite", "the value must be finite: not NaN, infinity or above 1.8e308")
    return number


def _array(raw: list[Any]) -> NDArray[np.float64]:
    """A list of numbers, nested evenly, as an array; `true` and texts are no numbers."""
    if not raw:
        raise FaultyText("empty", "an array needs at least one value")
    shape = _shape(raw)
    flat = np.array(_flatten(raw, len(shape)), dtype=object)
    if not all(type(item) in (int, float) for item in flat.tolist()):
        raise FaultyText("not_a_number", "every item of an array must be a number")
    try:
        array = flat.astype(float).reshape(shape)
    except (OverflowError, ValueError):
        raise FaultyText("uneven", "the rows of an array must be of equal length") from None
    if not np.isfinite(array).all():
        raise FaultyText("not_finite", "every item of an array must be a finite number")
    return array


def _shape(raw: list[Any]) -> tuple[int, ...]:
    shape: list[int] = []
    while isinstance(raw, list) and raw and len(shape) < 4:
        shape.append(len(raw))
        raw = raw[0]
    return tuple(shape)


def _flatten(raw: list[Any], depth: int) -> list[Any]:
    if depth <= 1:
        return raw
    rows = [row if isinstance(row, list) else [None] for row in raw]
    return [item for row in rows for item in _flatten(row, depth - 1)]


def _no_quantity(raw: Any, declared: str) -> FaultyText:
    form = '"1.5"' if declared == "1" else f'"1.5 {declared}"'
    return FaultyText("not_a_quantity", f"{str(raw)[:60]!r} is no quantity; write it as {form}")
