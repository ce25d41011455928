"""Units: the factor to SI and the kind of quantity; the Pint registry; which unit may replace which.

The registry only parses units; no Pint object reaches a formula's hot path.
A unit text is untrusted: its grammar is checked before Pint reads it (`m**9**9**9` would block Pint).

Two kinds of quantity have the same dimension, and the unit determines which is meant:

- A temperature (degC, degF) and a temperature difference (delta_degC, delta_degF); K may be either.
- An angular speed (rad/s, rpm, rev/s), stored in rad/s, and a frequency in Hz: cycles per second. 1/s may be
  either, except where turns are counted.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Protocol

import flexcache
import flexparser
import pint

from templates.core import definition_cache
from templates.core.arrays import Array
from templates.core.errors import FaultyText

Value = float | Array
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PRINTED = {
    "deg": "°",
    "degC": "°C",
    "degF": "°F",
    "delta_degC": "K",
    "delta_degF": "Δ°F",
    "um": "µm",
    "ohm": "Ω",
    "thou": "mil",
    "inch": "in",
    "ureyn": "µreyn",
}

_PARSED = f"units-{pint.__version__}-{flexparser.__version__}-{flexcache.__version__}"
"""The folder of Pint's parsed definitions; Pint names its files by their source."""


def _registry(parsed: Path | None) -> pint.UnitRegistry[float]:
    return pint.UnitRegistry(cache_folder=parsed)


registry: pint.UnitRegistry[float] = definition_cache.from_folder(_PARSED, _registry)
registry.define("@alias revolution = rev")

_NAME = r"(?:[A-Za-zµμ°Ω]+(?:_[A-Za-z]+)*|%)"
_POWER = r"(?:(?:\*\*|\^)-?[0-9]{1,2}|[²³])?"
_FACTOR = rf"{_NAME}{_POWER}"
_PRODUCT = rf"{_FACTOR}(?:[*·]{_FACTOR})*"
_UNIT = rf"(?:1|{_PRODUCT})(?:[*·/](?:{_FACTOR}|\({_PRODUCT}\)))*"
_PATTERN = re.compile(_UNIT)
_REVOLUTION = re.compile(r"(?<![A-Za-z_])r(?=/(?:min|s|h)(?![A-Za-z]))")
"""The printed form of a revolution per minute in ISO 80000-3: r/min."""
_AMBIGUOUS = {
    re.compile(rf"(?<![A-Za-z_])(?:{names})(?![A-Za-z_])"): remedy
    for names, remedy in {
        "mils?": "write thou for 0.001 inch, mrad for an angle",
        "[gG]rads?": "write deg for degrees, gon for hundredths of a right angle",
        "[GM](?:rad|deg)": "write mrad or deg for an angle",
        "U(?=/)": "write rpm or rev/min for turns, umol/min for enzyme units",
    }.items()
}
"""Words that a reader and Pint interpret differently: `Grad` is German for degrees, here 1e9 rad; `U/min` is
German for turns per minute, here an enzyme unit."""
LONGEST_UNIT = 60


@dataclass(frozen=True)
class Unit:
    """A unit as typed, reduced to SI: si = value · factor + offset."""

    text: str
    factor: float
    offset: float
    base: pint.Unit
    difference: bool  # of two temperatures
    cycles: float = 0.0  # the power of the hertz
    turns: bool = False  # counts revolutions: rpm, rev/s, turn
    plain_angle: bool = (
        True  # for angles: whether the unit names radians, as rad/s does and rpm and deg/s do not
    )

    @property
    def absolute(self) -> bool:
        """Return whether the unit is a temperature scale with its own zero, such as degC."""
        return self.offset != 0.0

    def to_si(self, value: Value) -> Value:
        """Return the value [this unit] in SI."""
        return value * self.factor + self.offset

    def from_si(self, value: Value) -> Value:
        """Return the value [SI] in this unit."""
        shifted = value - self.offset if self.offset else value
        return shifted if self.factor == 1 else shifted / self.factor


_CYCLE = registry.Unit("Hz") * registry.Unit("s")
MOST_REMEMBERED = 20_000


def forget_units() -> None:
    """Clear Pint's caches if they are large, because Pint keeps every unit that it has parsed.

    Call this where users send arbitrary units. Cleared entries are parsed again when needed.
    """
    kept = registry._cache
    for remembered in (kept.root_units, kept.dimensionality, kept.parse_unit, kept.conversion_factor):
        if len(remembered) > MOST_REMEMBERED:
            remembered.clear()


@lru_cache(maxsize=4096)
def unit(text: str) -> Unit:
    """Return a unit from its text, such as `kN`, `mm²/s`, `N*m`, `rpm` or `degC`; `1` is a pure number.

    Raises
    ------
    FaultyText
        If the text is not a unit, or Pint does not know the unit.
    """
    if len(text) > LONGEST_UNIT or not _PATTERN.fullmatch(text):
        raise FaultyText(
            "unknown_unit", f"{text[:60]!a} is not a unit; write it like `kN`, `mm**2/s` or `W/(m*K)`"
        )
    for word, remedy in _AMBIGUOUS.items():
        if word.search(text):
            raise FaultyText("ambiguous_unit", f"{text} is ambiguous: {remedy}")
    forget_units()
    try:
        named = registry.Unit("" if text == "1" else _REVOLUTION.sub("rev", text))
        size, base = registry.get_base_units(named)
        factor = float(size)  # type: ignore[arg-type]
        zero, two = (float(registry.Quantity(x, named).to_base_units().magnitude) for x in (0.0, 2.0))
    except (pint.PintError, ArithmeticError, AttributeError, TypeError, ValueError):
        raise FaultyText("unknown_unit", f"{text!r} is not a known unit; {_hint(text)}") from None
    if not (0 < factor < math.inf and math.isclose(two, 2 * factor + zero, rel_tol=1e-9)):
        raise FaultyText(
            "unknown_unit", f"{text!r} has no fixed size in SI; logarithmic units are not accepted"
        )
    powers: dict[str, Any] = dict(registry.Quantity(1.0, named).unit_items())
    names = {str(name): float(power) for name, power in powers.items()}
    return Unit(
        text,
        factor,
        zero,
        registry.Unit(base),
        difference=text.startswith("delta_") and base == registry.kelvin,
        cycles=sum(power for name, power in names.items() if name.endswith("hertz")),
        turns=any("turn" in name or "revolutions_per" in name for name in names),
        plain_angle=any(name.endswith("radian") for name in names),
    )


def _hint(text: str) -> str:
    if "deg" in text:
        return "in a product or quotient write a difference of temperatures: W/(m**2*K), N*m/delta_degC"
    return "units are case-sensitive: mm, kN, MPa, mPa*s, rpm, degC"


class Measured(Protocol):
    """What a unit or a value measures: its SI base units, and the power of the hertz among them."""

    @property
    def base(self) -> pint.Unit:
        """Return the base units."""

    @property
    def cycles(self) -> float:
        """Return the exponent of the hertz."""


def base_text(measured: Measured) -> str:
    """Return the SI unit of a quantity in the form that `unit` reads: `N*m`, `kg/m**4`, `1`, `Hz`."""
    if name := named_unit(measured.base):
        return name
    cycles = measured.cycles if is_rate(measured.base) else 0.0
    return f"{registry.Unit(measured.base * _CYCLE**cycles) if cycles else measured.base:~C}" or "1"


def named_unit(base: pint.Unit) -> str | None:
    """Return the unit that engineers use for base units, if there is one: `N*m` for `kg*m**2/s**2`."""
    return _named().get(base)


@cache
def _named() -> dict[pint.Unit, str]:
    names = (
        "N", "Pa", "N*m", "W", "Pa*s", "N/m", "N*m/rad", "N*m*rad/s", "W/(m*K)", "J/(kg*K)",
    )  # fmt: skip
    return {registry.Unit(registry.get_base_units(name)[1]): name for name in names}


CUSTOMARY = {
    "m": "mm", "m**2": "mm**2", "m**3": "cm**3", "m**4": "mm**4", "kg*m": "kg*mm", "Pa": "MPa",
    "N/m": "kN/mm",
}  # fmt: skip
"""The unit in which engineers state what a relation gives in an SI unit, where they prefer another one."""


def is_rate(base: pint.Unit) -> bool:
    """Return whether base units are a power of time, possibly multiplied by angles."""
    return dict(registry.get_dimensionality(base)).keys() == {"[time]"}


def radians(base: pint.Unit) -> float:
    """Return the exponent of the radian in base units."""
    exponents: dict[str, Any] = dict(registry.Quantity(1.0, base).unit_items())
    return float(exponents.get("radian", 0))


def compatible(one: Measured, other: Measured) -> bool:
    """Return whether two values can be compared.

    A rate in rad/s cannot be compared with one in Hz; 1/s can be compared with both.
    """
    if registry.get_dimensionality(one.base) != registry.get_dimensionality(other.base):
        return False
    if not is_rate(one.base):
        return True
    counted = _counted(one), _counted(other)
    return counted[0] == counted[1] or (0.0, 0.0) in counted


def _counted(measured: Measured) -> tuple[float, float]:
    """Return whether a rate counts angle, and the exponent of the hertz: kinds of rates differ by these.

    The exponent of the radian does not matter: `omega**2 * phi` is an angular acceleration, and `c / J`, with
    c in N*m*s/rad, an angular speed.
    """
    return float(radians(measured.base) != 0), measured.cycles


def dimension_of(measured: Measured) -> str:
    """Return a text that is equal for units of equal dimension, but differs between rad/s, Hz and 1/s."""
    dimensions = dict(registry.get_dimensionality(measured.base))
    counted = zip(("rad", "cycle"), _counted(measured) if is_rate(measured.base) else (), strict=False)
    powers = sorted([*dimensions.items(), *((name, power) for name, power in counted if power)])
    return " ".join(f"{name.strip('[]')}^{power:g}" for name, power in powers) or "1"


@lru_cache(maxsize=4096)
def require_same_kind(typed: str, declared: str) -> Unit:
    """Return the unit `typed` if it fits a quantity declared in the unit `declared`.

    Raises
    ------
    FaultyText
        If it measures something else, is ambiguous as a speed, or confuses a temperature with a difference.
    """
    got, want = unit(typed), unit(declared)
    if compatible(got, want) and not _mixes_difference(got, want) and not _miscounts(got, want):
        return got
    raise FaultyText(*_why_not(got, want))


def difference_of(name: str) -> str:
    """Return the unit for a difference of two temperatures in a unit: `delta_degC` for `degC`."""
    return difference_in(name) if unit(name).absolute else name


def difference_in(name: str) -> str:
    """Return the unit of a difference that is declared in a unit such as K, otherwise the unit itself."""
    return {1.0: "delta_degC", unit("degF").factor: "delta_degF"}.get(unit(name).factor, name)


def beside(typed: str, declared: str) -> str:
    """Return the unit of a limit, target or shown value, so that it has the same kind as the value.

    For a temperature difference, degC becomes delta_degC.
    """
    return difference_of(typed) if unit(declared).difference else typed


def _mixes_difference(got: Unit, want: Unit) -> bool:
    if got.absolute:
        return want.base == registry.kelvin and not want.absolute
    return got.difference and want.absolute


def _miscounts(got: Unit, want: Unit) -> bool:
    """Return whether a typed number may be wrong by 2π: an angle where there is none, or vice versa."""
    counted, wanted = _counted(got), _counted(want)
    if want.text == "1":  # Pint reads 1e6 cycles as an angle
        return counted[0] != 0
    if not is_rate(got.base) or counted == wanted:
        return False
    return counted[0] != 0 or (wanted[0] != 0 and not want.plain_angle)


def _why_not(got: Unit, want: Unit) -> tuple[str, str]:
    if registry.get_dimensionality(got.base) != registry.get_dimensionality(want.base):
        message = f"{got.text} measures {_measured(got)}; here {_measured(want)} is wanted: {_remedy(want)}"
        return "wrong_unit", message + _meant(got, want)
    if _mixes_difference(got, want):
        return "wrong_unit", _of_other_kind(got, want)
    if radians(want.base):
        message = f"{got.text} is ambiguous for a speed (turns or radians?): write rpm or rad/s"
        return "ambiguous_unit", message
    if want.cycles:
        return "ambiguous_unit", f"{got.text} counts angle, and Hz cycles; {_remedy(want)}"
    return "ambiguous_unit", f"{got.text} counts angle; {_remedy(want)}, without rad or turn"


def _of_other_kind(got: Unit, want: Unit) -> str:
    """Return a sentence if a temperature was given for a temperature difference, or vice versa."""
    if want.absolute:
        return f"{got.text} does not fit: here a temperature, not a difference, is wanted; {_remedy(want)}"
    other = difference_of(got.text)
    if want.difference:
        return (
            f"{got.text} does not fit: here a difference of temperatures is wanted; give it in {other} or K"
        )
    meanings = f"write a temperature in {want.text}, a difference in {other}"
    return f"{got.text} is ambiguous beside {want.text}; {meanings}"


def _remedy(want: Unit) -> str:
    return (
        "give it without a unit"
        if want.text == "1"
        else f"give it in {want.text} or another unit of the same kind"
    )


def _meant(got: Unit, want: Unit) -> str:
    """Return a hint about units that are often mistaken: Pint reads C as coulomb and F as farad."""
    if want.base == registry.kelvin and got.text in ("C", "F"):
        return f" ({got.text} is not a temperature: write deg{got.text})"
    return ""


_KINDS = {
    "a pure number": "1", "a length": "m", "an area": "m**2", "a volume": "m**3", "a time": "s",
    "a rate": "1/s", "a mass": "kg", "a density": "kg/m**3", "a force": "N", "a pressure": "Pa",
    "a velocity": "m/s", "an acceleration": "m/s**2", "a torque or an energy": "N*m", "a power": "W",
    "a temperature": "K",
    "a dynamic viscosity": "Pa*s", "a kinematic viscosity": "m**2/s", "a moment of inertia": "kg*m**2",
    "a stiffness": "N/m",
}  # fmt: skip


def _measured(scale: Unit) -> str:
    """Return the name of the quantity that a unit measures, such as `a length`, if there is a usual one."""
    dimensions = registry.get_dimensionality(scale.base)
    if radians(scale.base) and not dimensions:
        return "an angle"
    if radians(scale.base) and dict(dimensions) == {"[time]": -1}:
        return "an angular speed"
    same = (words for words, si in _KINDS.items() if registry.get_dimensionality(unit(si).base) == dimensions)
    return next(same, str(dimensions))


@lru_cache(maxsize=4096)
def unit_symbol(text: str) -> str:
    """Return the printed form of a unit, in the same order: `N*m` → `N·m`, `mm**2/s` → `mm²/s`.

    The result is empty for a pure number.
    """
    if text == "1":
        return ""
    raised = re.sub(r"\*\*(-?[0-9]+)", lambda power: power[1].translate(_RAISED), text)
    return re.sub(r"[A-Za-z_]+", lambda word: _PRINTED.get(word[0], word[0]), raised).replace("*", "·")
