"""The unit of the change of one quantity per unit of another: `um` and `N*m` give `um/(N*m)`."""

from __future__ import annotations

import re

from templates.core.errors import FaultyText
from templates.core.units.units import base_text, difference_of, unit

_PART = re.compile(r"([*·/]?)(?:\(([^)]*)\)|([^*·/()]+))")


def quotient(over: str, under: str) -> str:
    """Return the quotient of two units in a form that `units.unit` reads.

    The unit of a temperature is replaced by that of a temperature difference. The result is in SI base units
    if the names of the two units together are too long.
    """
    text = _quotient(difference_of(over), difference_of(under))
    try:
        return unit(text).text
    except FaultyText:
        return _quotient(base_text(unit(over)), base_text(unit(under)))


def _quotient(over: str, under: str) -> str:
    (top, bottom), (turned, up) = _parts(over), _parts(under)
    above, below = "*".join(top + up) or "1", bottom + turned
    if not below:
        return above
    return f"{above}/({'*'.join(below)})" if below[1:] else f"{above}/{below[0]}"


def _parts(name: str) -> tuple[list[str], list[str]]:
    """Return the factors in the numerator and the denominator of a unit, without factors `1`."""
    top, bottom = list[str](), list[str]()
    for sign, product, factor in _PART.findall(name.replace("**", "^")):
        factors = re.split("[*·]", product) if product else [factor]
        (bottom if sign == "/" else top).extend(f.replace("^", "**") for f in factors if f != "1")
    return top, bottom
