"""Convert Mathcad's units, constants and stored results to quantities of this project."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from app.worksheets.imports.errors import Untranslatable
from app.worksheets.imports.names import key_of
from app.worksheets.imports.trees import Node
from templates.core.errors import FaultyText
from templates.core.units.units import unit

_OURS: Mapping[str, str] = {
    "μm": "um", "mil": "thou", "in": "inch", "lbm": "lb", "gm": "g", "Ω": "ohm", "°": "deg", "l": "L",
    "sec": "s", "RPM": "rpm", "R": "degR", "°R": "degR", "C": "coulomb", "F": "farad", "H": "henry",
    "Å": "angstrom", "Δ°C": "delta_degC", "Δ°F": "delta_degF",
    "meter": "m", "kilogram": "kg", "second": "s", "kelvin": "K",
}  # fmt: skip
"""Units whose names differ between Mathcad and this project."""

_SIZES: Mapping[str, tuple[float, str]] = {
    "yr": (31556925.9747, "s"), "year": (31556925.9747, "s"), "tonf": (2000.0, "lbf"),
}  # fmt: skip
"""Names that mean a unit of another size here: Mathcad's year is the tropical year of 1900."""

PI, EULER = math.pi, math.e
CONSTANTS: Mapping[str, tuple[float, str]] = {
    "e": (EULER, "1"), "γ": (0.5772156649015329, "1"), "α": (0.0072973525643, "1"),
    "c": (299792458.0, "m/s"), "g": (9.80665, "m/s**2"), "e_{c}": (1.602176634e-19, "coulomb"),
    "h": (6.62607015e-34, "J*s"), "ℏ": (6.62607015e-34 / (2 * PI), "J*s"), "k": (1.380649e-23, "J/K"),
    "m_{u}": (1.66053906892e-27, "kg"), "N_{A}": (6.02214076e23, "mol**-1"),
    "R": (8.31446261815324, "J/(mol*K)"),
    "R_{∞}": (10973731.568157, "m**-1"), "ε_{0}": (8.8541878188e-12, "F/m"),
    "μ_{0}": (1.25663706127e-6, "N/A**2"), "σ": (5.670374419e-8, "W/(m**2*K**4)"),
    "Φ_{0}": (2.067833848e-15, "Wb"),
}  # fmt: skip
"""Constants of Mathcad Prime, CODATA 2022; they apply only to names labelled as constants."""

BEYOND = 1e307
"""The value that Mathcad stores for infinity."""


@dataclass(frozen=True)
class ScaledNumber:
    """A number times powers of units."""

    number: float = 1.0
    powers: tuple[tuple[str, Fraction], ...] = ()

    def times(self, other: ScaledNumber, power: int = 1) -> ScaledNumber:
        """Return the product with a power of another scaled number."""
        powers = dict(self.powers)
        for name, exponent in other.powers:
            powers[name] = powers.get(name, Fraction(0)) + exponent * power
        kept = tuple((name, exponent) for name, exponent in powers.items() if exponent)
        return ScaledNumber(self.number * float(other.number) ** power, kept)

    def raised(self, power: Fraction) -> ScaledNumber:
        """Return a power of the quantity."""
        powers = tuple((name, exponent * power) for name, exponent in self.powers)
        return ScaledNumber(float(self.number) ** float(power), powers)

    @property
    def unit(self) -> str:
        """Return the units as text, such as `kN*m` or `kg/(m*s**2)`; `1` if there are none.

        Raises
        ------
        Untranslatable
            If a power is not a whole number, or the text is not a unit of this project.
        """
        if any(exponent.denominator != 1 for _, exponent in self.powers):
            raise Untranslatable(
                "worksheets cannot take the root of a unit",
                "write the formula in pure numbers, such as `f_ck / 1 MPa`",
            )
        over = [_factor(name, int(power)) for name, power in self.powers if power > 0]
        under = [_factor(name, -int(power)) for name, power in self.powers if power < 0]
        if not over:
            text = "*".join(_factor(name, int(power)) for name, power in self.powers) or "1"
        else:
            below = f"({'*'.join(under)})" if len(under) > 1 else "".join(under)
            text = "*".join(over) + (f"/{below}" if under else "")
        try:
            unit(text)
        except FaultyText:
            raise Untranslatable(f"unit {text[:40]}", "write the quantity in another unit") from None
        return text

    @property
    def si(self) -> float:
        """Return the factor for conversion to SI."""
        factors = (float(unit(name).factor ** float(power)) for name, power in self.powers)
        return float(self.number) * math.prod(factors)


def _factor(name: str, power: int) -> str:
    return name if power == 1 else f"{name}**{power}"


def unit_named(name: str) -> ScaledNumber | None:
    """Return the unit of this project for a Mathcad unit; None if there is none."""
    if name == "g":
        return ScaledNumber(9.80665, (("m", Fraction(1)), ("s", Fraction(-2))))
    size, ours = _SIZES.get(name, (1.0, _OURS.get(name, name)))
    try:
        scale = unit(ours)
    except FaultyText:
        return None
    return None if scale.absolute else ScaledNumber(size, ((ours, Fraction(1)),))


def scaled(node: Node, is_unit: bool = False) -> ScaledNumber | None:
    """Return a tree of numbers and units as one quantity; None if it contains anything else.

    With `is_unit`, plain names count as units, as in the unit of a result.
    """
    parts = node.parts
    match node.tag:
        case "real":
            return _number(node.text)
        case "placeholder":
            return ScaledNumber() if is_unit else None
        case "id" if is_unit or node.attributes.get("labels") == "UNIT":
            return unit_named(key_of(node))
        case "parens" if len(parts) == 1:
            return scaled(parts[0], is_unit)
        case "apply" if len(parts) == 2 and parts[0].tag in ("neg", "percent"):
            inner = scaled(parts[1], is_unit)
            sign = -1.0 if parts[0].tag == "neg" else 0.01
            return None if inner is None else inner.times(ScaledNumber(sign))
        case "apply" if len(parts) == 3 and parts[0].tag in ("mult", "scale", "div", "pow"):
            return _combined(parts[0].tag, scaled(parts[1], is_unit), scaled(parts[2], is_unit))
    return None


def _combined(sign: str, left: ScaledNumber | None, right: ScaledNumber | None) -> ScaledNumber | None:
    if left is None or right is None:
        return None
    try:
        if sign != "pow":
            combined = left.times(right, -1 if sign == "div" else 1)
        elif right.powers or abs(right.number) > (12 if left.powers else 300):
            return None
        else:
            combined = left.raised(Fraction(right.number).limit_denominator(100))
    except (ArithmeticError, TypeError, ValueError):
        return None
    return combined if isinstance(combined.number, float) and math.isfinite(combined.number) else None


def _number(text: str) -> ScaledNumber | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return ScaledNumber(value) if math.isfinite(value) and len(text) < 50 else None


@dataclass(frozen=True)
class Result:
    """A result that Mathcad stored, in SI: one value, or the items of a list."""

    values: tuple[float, ...]
    is_list: bool = False
    unit: str = "1"
    """Mathcad's unit, in which both values are displayed."""
    factor: float = 1.0


def result_of(cached: Node, asked: Node | None, carries_units: bool) -> Result | None:
    """Return a stored result as numbers in SI; None for texts, matrices, complex numbers and infinity.

    Parameters
    ----------
    asked
        The unit in which the region requests its result.
    carries_units
        Whether the result includes its whole unit; if not, it is a multiple of the requested unit.
    """
    wanted = scaled(asked, is_unit=True) if asked is not None and not carries_units else ScaledNumber()
    if wanted is None or not cached.parts:
        return None
    try:
        values = list(_values(cached.parts[0], wanted))
        shown = values[0][1] if values else wanted
        label = shown.unit if shown.number == 1.0 else f"{shown.number:g} {shown.unit}"
        numbers = tuple(value * scale.si for value, scale in values)
    except (Untranslatable, ArithmeticError, ValueError, TypeError):
        return None
    if not numbers or not all(math.isfinite(n) for n in numbers) or any(abs(v) >= BEYOND for v, _ in values):
        return None
    is_list = next(cached.parts[0].all("matrix"), None) is not None
    return Result(numbers, is_list, label, shown.si)


def _values(node: Node, scale: ScaledNumber) -> Iterator[tuple[float, ScaledNumber]]:
    match node.tag:
        case "real":
            yield float(node.text), scale
        case "unitedValue" if len(node.parts) == 2:
            yield from _values(node.parts[0], scale.times(_monomial(node.parts[1])))
        case "matrix" if 1 in (_size(node, "rows"), _size(node, "cols")):
            for part in node.parts:
                if part.tag == "matrix":
                    raise ValueError("a list of lists")
                yield from _values(part, scale)
        case _:
            raise ValueError(node.tag)


def _size(node: Node, name: str) -> int:
    text = node.attributes.get(name, "")
    return int(text) if text.isdigit() and len(text) < 7 else 0


def _monomial(node: Node) -> ScaledNumber:
    product = ScaledNumber()
    for part in node.parts:
        named = unit_named(part.attributes.get("unit", ""))
        if named is None:
            raise ValueError("a unit that worksheets do not have")
        over = int(part.attributes.get("power-numerator", "1"))
        under = int(part.attributes.get("power-denominator", "1")) or 1
        product = product.times(named.raised(Fraction(over, under)))
    return product


def is_infinite(text: str) -> bool:
    """Return whether a stored number means infinity."""
    try:
        return not abs(float(text)) < BEYOND
    except ValueError:
        return True


def close(ours: Iterable[float], theirs: Iterable[float], within: float = 1e-9) -> bool:
    """Return whether values agree, relative to the largest of them.

    A zero in a list is compared relative to the other items.
    """
    one, other = list(ours), list(theirs)
    if len(one) != len(other) or not all(map(math.isfinite, one)):
        return False
    greatest = max(map(abs, [*one, *other]), default=0.0)
    return all(abs(a - b) <= within * greatest for a, b in zip(one, other, strict=True))
