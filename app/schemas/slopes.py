"""The slope of one value over another as a quantity."""

from __future__ import annotations

import math

from app.schemas.answers import Quantity
from templates.core.units.quotient import quotient
from templates.core.units.units import unit


def slope_in(over: str, under: str, slope: float) -> Quantity | None:
    """Return a slope [SI] as a quantity in the unit `over` per `under`; None if it is not finite."""
    name = quotient(over, under)
    value = slope / unit(name).factor
    return Quantity(value=value, unit=name) if math.isfinite(value) else None


def slope_between(over: str, under: str, slope: Quantity) -> Quantity | None:
    """Return a slope in the unit `over` per `under`."""
    return slope_in(over, under, slope.value * unit(slope.unit).factor)
