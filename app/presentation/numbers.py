"""Numbers and units as a worksheet shows them: five significant digits, aligned at the point, the unit once.

`app/web/shared/numbers.js` formats numbers in the same way while a user types; `tests/app/web` compares the
two.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple, Protocol, runtime_checkable

from pydantic import BaseModel

from templates.core.units.units import unit_symbol

DIGITS = 5
LARGEST_PLAIN = 1e6  # larger numbers are shown with a power of ten
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class AlignedNumber(NamedTuple):
    """A number split at the decimal point, for alignment in a column."""

    whole: str
    rest: str


def aligned(value: float) -> AlignedNumber:
    """Return a number with five significant digits: `3.2449` → `3` and `.2449`.

    `1.2e-7` → `1` and `.2·10⁻⁷`.
    """
    rounded = float(f"{value:.{DIGITS}g}")
    shown = f"{rounded:.0f}" if 1e4 <= abs(rounded) < LARGEST_PLAIN else f"{rounded:.{DIGITS}g}"
    mantissa, _, exponent = shown.partition("e")
    whole, point, fraction = mantissa.partition(".")
    power = f"·10{str(int(exponent)).translate(SUPERSCRIPTS)}" if exponent else ""
    return AlignedNumber(whole.replace("-", "−"), point + fraction + power)


def plain(value: float) -> str:
    """Return a number with five significant digits on one line."""
    return "".join(aligned(value))


@lru_cache(maxsize=1024)
def unit(text: str | None) -> str:
    """Return a unit in its printed form: `mm**2/s` → `mm²/s`; empty for a pure number or a text."""
    return unit_symbol(text) if text else ""


ALMOST_ALL = 0.985


def percent(relative: float) -> str:
    """Return a relative error with two digits: `0.24` → `24 %`, `4.5e-5` → `0.0045 %`."""
    return f"{rough(relative * 100)} %"


def share(used: float) -> str:
    """Return the used share of an allowance with two digits.

    Near 100 % and above it has four digits, so that the side of the limit shows.
    """
    return percent(used) if used < ALMOST_ALL else f"{plain(float(f'{used * 100:.4g}'))} %"


def rough(value: float) -> str:
    """Return a number with two significant digits."""
    return plain(float(f"{value:.2g}"))


@runtime_checkable
class Quantity(Protocol):
    """A quantity in an answer; some have a unit, a tolerance, or a reason for a missing value."""

    @property
    def value(self) -> object:
        """Return the magnitude, of any shape, or the text of a choice."""


SIGNS = {
    "plus": "+",
    "minus": "−",
    "upper": "",
    "lower": "",
}  # signs of deviations; upper and lower already have one
PARTS = ("value", "unit", "reason", *SIGNS, "zone", "distribution", "state_in_table")


def in_line(quantity: object) -> str:
    """Return a quantity on one line: `25 kN`, `= scale * 48 mm`, `[1, 2, 3] mm`."""
    if quantity is None:
        return ""
    if isinstance(quantity, Mapping):
        return _line(quantity)
    if isinstance(quantity, BaseModel) and "value" in (fields := vars(quantity)):
        return _line(fields)  # testing for a missing attribute takes ten times as long
    if hasattr(quantity, "value"):  # a quantity; isinstance with the protocol takes ten times as long
        return _line({name: getattr(quantity, name, None) for name in PARTS})
    return _written(quantity)


class Rounded(Protocol):
    """A value before and after the rounding of its relation."""

    @property
    def calculated(self) -> object:
        """Return the quantity before the rounding."""

    @property
    def chosen(self) -> object:
        """Return the quantity after it."""


def rounded(value: Rounded) -> str:
    """Return a rounded value on one line: `calculated 23.47 mm → chosen 23.5 mm`."""
    return f"calculated {in_line(value.calculated)} → chosen {in_line(value.chosen)}"


def _line(quantity: Mapping[str, object]) -> str:
    if not has_value(quantity["value"]):
        return str(quantity.get("reason") or "none")
    symbol = quantity.get("unit")
    value = quantity["value"]
    parts = (_written(value), unit(str(symbol) if symbol else None), tolerance(quantity), _remark(value))
    return " ".join(filter(None, parts))


def _written(value: object) -> str:
    if isinstance(value, list):
        return _list(value)
    if value is None:
        return MISSING
    return plain(value) if isinstance(value, float) else str(value)


def has_value(value: object) -> bool:
    """Return whether there is a value: something other than None, or than a list of nothing else."""
    return any(map(has_value, value)) if isinstance(value, list) and value else value is not None


def _list(values: list[object]) -> str:
    """Return a list of up to 20 values completely; of a longer one the smallest and the largest value."""
    if size(values) <= FEW:
        return f"[{', '.join(map(_written, values))}]"
    ends, flat = extremes(values), list(_flat(values))
    return " … ".join(_written(flat[place]) for place in ends) if ends else "[…]"


def _remark(values: object) -> str:
    """Return the length of a long list, and its smallest and largest values with their positions."""
    if not isinstance(values, list) or size(values) <= FEW:
        return ""
    ends = extremes(values)
    is_row = ends is not None and size(values) == len(values)
    where = f"; least no. {ends[0] + 1}, largest no. {ends[1] + 1}" if ends and is_row else ""
    return f"({counted(values)} values{where})"


MISSING = "–"  # an item of a list without a value
FEW = 20  # longest list that is shown completely


def size(values: object) -> int:
    """Return the number of values in a list of any nesting depth."""
    return sum(map(size, values)) if isinstance(values, list) else 1


def counted(values: list[object]) -> str:
    """Return the number of values as text: `720`, or `3 × 24` for a table."""
    inside = values[0] if values else None
    return f"{len(values)} × {counted(inside)}" if isinstance(inside, list) else str(len(values))


def extremes(values: list[object]) -> tuple[int, int] | None:
    """Return the positions of the smallest and the largest number in a list; None if there is no number."""
    placed = [(value, place) for place, value in enumerate(_flat(values)) if isinstance(value, int | float)]
    return (min(placed)[1], max(placed, key=lambda one: (one[0], -one[1]))[1]) if placed else None


def _flat(values: object) -> Iterator[object]:
    if isinstance(values, list):
        for value in values:
            yield from _flat(value)
    else:
        yield values


def tolerance(more: Mapping[str, object]) -> str:
    """Return a tolerance as it is written after its value: `H7 (+0.025 −0.0)`, `+10 −5 uniform, in table`."""
    given = {name: more[name] for name in (*SIGNS, "zone", "distribution") if more.get(name) is not None}
    if not given:
        return ""
    signed = [_deviation(name, given[name]) for name in SIGNS if name in given]
    is_even = "plus" in given and given["plus"] == given.get("minus")
    limits = signed[0].replace("+", "±", 1) if is_even else " ".join(signed)
    zone = given.get("zone")
    parts = (f"{zone} ({limits})" if zone and limits else zone or limits, given.get("distribution"))
    end = ", in table" if more.get("state_in_table") else ""
    return " ".join(str(part) for part in parts if part) + end


def _deviation(name: str, size: object) -> str:
    """Return a deviation with its sign, in the unit of the value unless its text has a unit."""
    shown = plain(size) if isinstance(size, float) else str(size)
    sign = SIGNS[name]
    return sign + shown if sign or shown.startswith(("-", "−")) else f"+{shown}"
