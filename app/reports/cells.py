"""Values as a report shows them: a number in two parts that meet at the decimal point, and its unit."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from app.calculations.display import System, converted
from app.web import numbers
from templates.core.units import compatible, unit

DIGITS_TYPED = 12  # of a number that a user typed: as many as are kept
_DERIVED = ("1", "m", "kg", "s", "N", "Pa", "J", "W", "K", "rad", "rad/s")
_COMPOSED = (*_DERIVED, "m**2", "m**3", "m**2/s", "m**3/s", "Pa*s", "N/m", "N*s/m", "kg*m**2", "N*m")
_WORD = re.compile(r"[A-Za-zµμ°Ω%_]+")


@dataclass(frozen=True)
class Cell:
    """A value: a number's two parts with its unit, or a text where there is no single number."""

    whole: str = ""
    rest: str = ""
    unit: str = ""
    text: str = ""


NOTHING = Cell()


def cell(quantity: Any, *, typed: bool = False) -> Cell:
    """A quantity as the interface tells it; as many digits as were typed, else five."""
    value = quantity.get("value") if isinstance(quantity, Mapping) else quantity
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        whole, rest = numbers.aligned(value) if not typed else _as_typed(value)
        return Cell(whole, rest, numbers.unit(_unit_of(quantity)) + _tolerance(quantity))
    return Cell(text=numbers.told(quantity))


def in_si(quantity: Any) -> Cell:
    """The same value in SI units; empty for texts and arrays."""
    value, name = (quantity.get("value"), _unit_of(quantity)) if isinstance(quantity, Mapping) else (None, "")
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not name:
        return Cell()
    si = si_unit(name)
    scale = unit(name)
    return cell({"value": float(scale.to_si(float(value))), "unit": si})


def shown(quantity: Any, system: System) -> Cell:
    """A quantity in the system's units."""
    return cell(converted(quantity, system))


@lru_cache(maxsize=512)
def si_unit(text: str) -> str:
    """The coherent SI unit of a unit, composed as it is: `kN` → `N`, `mPa*s` → `Pa*s`, `rpm` → `rad/s`."""
    whole = _WORD.fullmatch(text) or text == "1"
    if not whole:
        replaced = _WORD.sub(lambda word: _coherent(word[0], _DERIVED) or "?", text)
        composed = re.sub(r"(?<=/)rad/s|m\*\*3(?=\*\*)", "?", replaced)
        if "?" not in composed and unit(composed).factor == 1:
            return composed
    return _coherent(text, _COMPOSED) or f"{unit(text).base:~C}"


def _coherent(text: str, candidates: tuple[str, ...]) -> str | None:
    base = unit(text).base
    return next((si for si in candidates if compatible(unit(si).base, base)), None)


def _unit_of(quantity: Any) -> str:
    return str(quantity.get("unit") or "") if isinstance(quantity, Mapping) else ""


def _as_typed(value: float) -> tuple[str, str]:
    """A number with all digits that were typed."""
    shown = f"{value:.{DIGITS_TYPED}g}"
    if "e" in shown:
        return tuple(numbers.aligned(value))  # type: ignore[return-value]
    whole, point, fraction = shown.partition(".")
    return whole.replace("-", "−"), point + fraction


def _tolerance(quantity: Any) -> str:
    signs = (("plus", "+"), ("minus", "−"))
    parts = [f" {sign}{quantity[name]}" for name, sign in signs if name in quantity]
    return "".join(parts) if isinstance(quantity, Mapping) else ""
