"""Systems of units for display: `?units=us` requests answers in inches and pounds instead of declared units.

All calculations are in SI, whatever units are shown. Values that users typed are never converted.
"""

from __future__ import annotations

from typing import Literal, cast

from templates.core.units.units import unit

System = Literal["si", "us"]
US = {
    "m": "ft", "mm": "inch", "um": "thou", "mm**2": "inch**2", "mm**3": "inch**3",
    "N": "lbf", "kN": "lbf", "N*m": "lbf*ft", "N/m": "lbf/inch", "N/um": "lbf/inch", "N*s/m": "lbf*s/inch",
    "Pa": "psi", "kPa": "psi", "MPa": "psi", "GPa": "psi", "bar": "psi",
    "kg": "lb", "kg*m": "lb*inch", "kg*mm": "lb*inch", "kg*m**2": "lb*ft**2", "kg*mm**2": "lb*inch**2",
    "kg/m**3": "lb/ft**3", "m/s": "ft/s", "m/s**2": "ft/s**2", "W": "hp", "kW": "hp",
    "degC": "degF", "delta_degC": "delta_degF",
    "J": "ft*lbf", "l/min": "gallon/min", "MPa*m/s": "psi*ft/min",
    "Pa*s": "reyn", "mPa*s": "ureyn", "N*m/rad": "lbf*inch/rad", "kN*m/rad": "lbf*inch/rad",
    "mm**2/s": "inch**2/s", "MPa/mm": "psi/inch", "cm**2": "inch**2", "cm**3/s": "inch**3/s",
    "mm**4": "inch**4", "1/mm**3": "1/inch**3", "1/N": "1/lbf", "cm**3": "inch**3",
    "kN/mm": "lbf/inch", "1/MPa": "1/psi", "um/GPa": "inch/psi", "s/m**2": "s/inch**2",
    "N*m*s/rad": "lbf*inch*s/rad",
    "MPa/kN": "psi/lbf", "MPa/(kN*m)": "psi/(lbf*ft)",
}  # fmt: skip
"""The US unit for each declared unit; other units, such as rpm, are used unchanged."""


def shown_unit(declared: str, system: System) -> str:
    """Return the display unit for a value with a declared unit."""
    return US.get(declared, declared) if system == "us" else declared


def shown_value(value: object, declared: str, system: System) -> object:
    """Return a magnitude of any shape, given in its declared unit, in its display unit."""
    return _value(value, declared) if system == "us" and declared in US else value


def _value(value: object, declared: str) -> object:
    if isinstance(value, list | tuple):
        return type(value)(_value(item, declared) for item in value)
    if value is None:
        return None
    return float(unit(US[declared]).from_si(unit(declared).to_si(float(cast(float, value)))))
