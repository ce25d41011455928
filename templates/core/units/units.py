"""Units: a factor to SI and what they measure; the one Pint registry; which unit may stand for which.

The registry reads units only; no Pint object reaches a formula's hot path.
A unit text is untrusted: its grammar is checked before Pint sees it (`m**9**9**9` would hang Pint).

Angular speed is kept in rad/s. The radian counts as a dimension of its own where a rate is meant,
so that `50 1/s` or `50 Hz` is refused as a speed instead of being wrong by 2π.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import flexcache
import flexparser
import pint

from templates.core import prepared
from templates.core.arrays import Array
from templates.core.errors import FaultyText

Value = float | Array

_PARSED = f"units-{pint.__version__}-{flexparser.__version__}-{flexcache.__version__}"
"""The folder that keeps Pint's definitions parsed; Pint names its files by what they were made from."""


def _registry(parsed: Path | None) -> pint.UnitRegistry[float]:
    return pint.UnitRegistry(cache_folder=parsed)


registry: pint.UnitRegistry[float] = prepared.from_folder(_PARSED, _registry)
registry.define("@alias revolution = rev")

_NAME = r"(?:[A-Za-zµμ°Ω]+(?:_[A-Za-z]+)*|%)"
_POWER = r"(?:(?:\*\*|\^)-?[0-9]{1,2}|[²³])?"
_FACTOR = rf"{_NAME}{_POWER}"
_PRODUCT = rf"{_FACTOR}(?:[*·]{_FACTOR})*"
_UNIT = rf"(?:1|{_PRODUCT})(?:[*·/](?:{_FACTOR}|\({_PRODUCT}\)))*"
_PATTERN = re.compile(_UNIT)
LONGEST_UNIT = 60


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
        """Return whether this is a temperature scale with a zero of its own, such as degC."""
        return self.offset != 0.0

    def to_si(self, value: Value) -> Value:
        """Return the value [this unit] in SI."""
        return value * self.factor + self.offset

    def from_si(self, value: Value) -> Value:
        """Return the value [SI] in this unit."""
        shifted = value - self.offset if self.offset else value
        return shifted if self.factor == 1 else shifted / self.factor


MOST_REMEMBERED = 20_000


def forget_units() -> None:
    """Keep what Pint remembers of units bounded: it keeps every unit that it ever parsed.

    Call it where units come in that a user made up. What was forgotten is calculated again.
    """
    kept = registry._cache
    for remembered in (kept.root_units, kept.dimensionality, kept.parse_unit, kept.conversion_factor):
        if len(remembered) > MOST_REMEMBERED:
            remembered.clear()


@lru_cache(maxsize=4096)
def unit(text: str) -> Unit:
    """Read a unit such as `kN`, `mm²/s`, `N*m`, `rpm` or `degC`; `1` is a pure number.

    Raises
    ------
    FaultyText
        If the text is not a unit, or one that Pint does not know.
    """
    if len(text) > LONGEST_UNIT or not _PATTERN.fullmatch(text):
        raise FaultyText("unknown_unit", f"{text[:60]!a} is not a unit; write it like kN, mm**2/s, W/(m*K)")
    forget_units()
    try:
        named = registry.Unit("" if text == "1" else text)
        size, base = registry.get_base_units(named)
        factor = float(size)  # type: ignore[arg-type]
        zero, two = (float(registry.Quantity(x, named).to_base_units().magnitude) for x in (0.0, 2.0))
    except (pint.PintError, ArithmeticError, AttributeError, TypeError, ValueError):
        raise FaultyText("unknown_unit", f"{text!r} is not a known unit; {_hint(text)}") from None
    if not (0 < factor < math.inf and math.isclose(two, 2 * factor + zero, rel_tol=1e-9)):
        raise FaultyText("unknown_unit", f"{text!r} has no fixed size (a logarithmic unit?)")
    difference = text.startswith("delta_") and base == registry.kelvin
    return Unit(text, factor, zero, registry.Unit(base), difference)


def _hint(text: str) -> str:
    if "deg" in text:
        return "in a product or quotient write a difference of temperatures: W/(m**2*K), N*m/delta_degC"
    return "units are case-sensitive: mm, kN, MPa, mPa*s, rpm, degC"


def compatible(one: pint.Unit, other: pint.Unit) -> bool:
    """Return whether two base units mean the same kind of quantity; a rate in rad/s is none in 1/s."""
    dimensions = registry.get_dimensionality(one)
    if dimensions != registry.get_dimensionality(other):
        return False
    is_rate = dict(dimensions).keys() == {"[time]"}
    return not is_rate or _radians(one) == _radians(other)


def dimension_of(base: pint.Unit) -> str:
    """Return a text that is equal for base units that are compatible."""
    dimensions = dict(registry.get_dimensionality(base))
    radians = _radians(base) if dimensions.keys() == {"[time]"} else 0.0
    powers = sorted([*dimensions.items(), *([("rad", radians)] if radians else [])])
    return " ".join(f"{name.strip('[]')}^{power:g}" for name, power in powers) or "1"


def _radians(base: pint.Unit) -> float:
    exponents: dict[str, Any] = dict(registry.Quantity(1.0, base).unit_items())
    return float(exponents.get("radian", 0))


@lru_cache(maxsize=4096)
def require_same_kind(typed: str, declared: str) -> Unit:
    """Return the unit `typed`, if a quantity declared in `declared` can be given in it.

    Raises
    ------
    FaultyText
        If it measures something else, is ambiguous as a speed, or mixes a temperature with a difference.
    """
    got, want = unit(typed), unit(declared)
    if compatible(got.base, want.base) and not _mixes_difference(got, want) and not _counts_angle(got, want):
        return got
    raise FaultyText(*_why_not(got, want))


def _mixes_difference(got: Unit, want: Unit) -> bool:
    return (got.difference and not want.difference) or (got.absolute and want.difference)


def _counts_angle(got: Unit, want: Unit) -> bool:
    """Return whether a pure number would be wrong by 2π: 1e6 cycles are an angle to Pint."""
    return want.text == "1" and _radians(got.base) != 0


def _why_not(got: Unit, want: Unit) -> tuple[str, str]:
    if registry.get_dimensionality(got.base) != registry.get_dimensionality(want.base):
        message = f"{got.text} measures {_measured(got)}; here {_measured(want)} is wanted: {_remedy(want)}"
        return "wrong_unit", message + _meant(got, want)
    if _mixes_difference(got, want):
        expected = "a difference of temperatures" if want.difference else "a temperature, not a difference,"
        return "wrong_unit", f"{got.text} does not fit: here {expected} is wanted; {_remedy(want)}"
    if _radians(want.base):
        message = f"{got.text} is ambiguous for a speed (turns or radians?): write rpm or rad/s"
        return "ambiguous_unit", message
    return "ambiguous_unit", f"{got.text} counts angle; {_remedy(want)}, without rad or turn"


def _remedy(want: Unit) -> str:
    return "give it without a unit" if want.text == "1" else f"give it in {want.text} or its like"


def _meant(got: Unit, want: Unit) -> str:
    """Return a hint on well-known slips of the pen.

    Pint takes C for coulomb, F for farad, U for an enzyme unit.
    """
    if want.base == registry.kelvin and got.text in ("C", "F"):
        return f" ({got.text} is not a temperature: write deg{got.text})"
    return " (U is not a turn: write rpm or rev/min)" if got.text.startswith("U/") else ""


_KINDS = {
    "a pure number": "1", "a length": "m", "an area": "m**2", "a volume": "m**3", "a time": "s",
    "a rate": "1/s", "a mass": "kg", "a density": "kg/m**3", "a force": "N", "a pressure": "Pa",
    "a velocity": "m/s", "an acceleration": "m/s**2", "a torque or an energy": "N*m", "a power": "W",
    "a temperature": "K",
    "a dynamic viscosity": "Pa*s", "a kinematic viscosity": "m**2/s", "a moment of inertia": "kg*m**2",
    "a stiffness": "N/m",
}  # fmt: skip


def _measured(scale: Unit) -> str:
    """Return the quantity that a unit measures, in words where there are usual ones."""
    dimensions = registry.get_dimensionality(scale.base)
    if _radians(scale.base) and not dimensions:
        return "an angle"
    if _radians(scale.base) and dict(dimensions) == {"[time]": -1}:
        return "an angular speed"
    same = (words for words, si in _KINDS.items() if registry.get_dimensionality(unit(si).base) == dimensions)
    return next(same, str(dimensions))
