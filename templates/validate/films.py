"""Bearings of a given Sommerfeld number, and the dimensionless groups of the published tables.

S = μ N L D (R/c)²/W = 1/(2π So), K = k c/W, B = b c ω/W, with N in revolutions per second and c the radial
clearance. x lies along the load and y ahead of it in the sense of rotation.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import Any

from templates import get
from templates.door import Calculation

DIAMETER, PSI, VISCOSITY, SPEED = 0.1, 1e-3, 0.02, 100.0
CLEARANCE = PSI * DIAMETER / 2
SPLIT_10 = {"value": [[90, 10], [270, 10]], "unit": "deg"}
SPLIT_20 = {"value": [[90, 20], [270, 20]], "unit": "deg"}

CONSTANT_OIL: dict[str, Any] = {
    "oil_inlet_temperature": "40 degC",
    "oil_outlet_temperature": "40 degC",
    "reference_temperature": "40 degC",
    "reference_density": "1000 kg/m**3",
    "temperature_1": "40 degC",
    "kinematic_viscosity_1": "20 mm**2/s",
    "temperature_2": "100 degC",
    "kinematic_viscosity_2": "4 mm**2/s",
}
"""An oil of 20 mPa s at the temperature of the film, for `oil_film` 1."""


def load_of(S: float, width_ratio: float, preload: float = 0.0) -> float:
    """Return the load [N] at a Sommerfeld number that refers to the clearance of machining."""
    machined = PSI / (1 - preload)
    return width_ratio * DIAMETER**2 * VISCOSITY * SPEED / (machined**2 * 2 * pi * S)


def film(
    S: float, width_ratio: float, level: str | None = None, preload: float = 0.0, **others: Any
) -> Calculation:
    """Return `oil_film` 2 of a bearing with this Sommerfeld number."""
    return get("oil_film", 2)(
        level=level,
        radial_load=f"{load_of(S, width_ratio, preload)!r} N",
        bearing_diameter=f"{DIAMETER} m",
        bearing_width=f"{width_ratio * DIAMETER!r} m",
        diametral_clearance=f"{PSI * DIAMETER!r} m",
        dynamic_viscosity=f"{VISCOSITY} Pa*s",
        speed=f"{SPEED} rad/s",
        preload=preload,
        **others,
    )


def film_of_paper(S: float, width_ratio: float) -> Calculation:
    """Return `oil_film` 1 of a bearing with this Sommerfeld number; its viscosity fits 20 mPa s."""
    return get("oil_film", 1)(**_bearing(S, width_ratio), **CONSTANT_OIL)


def film_under_constant_cycle(S: float, width_ratio: float) -> Calculation:
    """Return `oil_film_cycle` 1, level `mobility`, under a constant load at this Sommerfeld number."""
    common = _bearing(S, width_ratio)
    load = -load_of(S, width_ratio)
    turn = [15.0 * n for n in range(24)]
    return get("oil_film_cycle", 1)(
        level="mobility",
        crank_angle={"value": turn, "unit": "deg"},
        load_x={"value": [load] * 24, "unit": "N"},
        load_y={"value": [0.0] * 24, "unit": "N"},
        dynamic_viscosity=f"{VISCOSITY} Pa*s",
        oil_supply="flooded_ends",
        **{name: common[name] for name in common if name != "radial_load"},
    )


def _bearing(S: float, width_ratio: float) -> dict[str, Any]:
    """Return load, sizes and speed of a plain bearing with this Sommerfeld number."""
    return {
        "radial_load": f"{load_of(S, width_ratio)!r} N",
        "bearing_diameter": f"{DIAMETER} m",
        "bearing_width": f"{width_ratio * DIAMETER!r} m",
        "diametral_clearance": f"{PSI * DIAMETER!r} m",
        "speed": f"{SPEED} rad/s",
    }


def value(calculation: Calculation, name: str, unit: str) -> float:
    """Return a result as a number in this unit."""
    return float(getattr(calculation, name).to(unit).magnitude)


def place(calculation: Calculation, preload: float = 0.0) -> dict[str, float]:
    """Return eccentricity, over the clearance of machining, and attitude angle [°]."""
    eps = value(calculation, "relative_eccentricity", "1")
    return {"eps": eps * (1 - preload), "phi_deg": value(calculation, "attitude_angle", "deg")}


def coefficients(calculation: Calculation, names: Iterable[str], preload: float = 0.0) -> dict[str, float]:
    """Return stiffness (Kxx …) and damping (Bxx …) in the groups of the clearance of machining."""
    scale = CLEARANCE / (1 - preload) / value(calculation, "radial_load", "N")
    return {name: _coefficient(calculation, name, scale) for name in names}


def _coefficient(calculation: Calculation, name: str, scale: float) -> float:
    if name.startswith("K"):
        return value(calculation, f"stiffness_{name[1:]}", "N/m") * scale
    return value(calculation, f"damping_{name[1:]}", "N*s/m") * scale * SPEED
