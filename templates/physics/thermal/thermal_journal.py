"""A journal bearing under static load with a temperature field in its film, in SI, for many points.

For comparison, the same film is also solved with one effective temperature.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.thermal.one_temperature import mapped_values
from templates.physics.thermal.thermal_balance import FIELD, FINE, OneTemperature, Warm, both
from templates.physics.thermal.thermal_case import ThermalCase

ONE = "one_temperature"
LEVELS = (ONE, FIELD, FINE)
ANGLES = np.radians(np.arange(0, 360, 5))
"""Angles from the load at which the bush's temperature is given [rad]."""


@dataclass(frozen=True)
class WarmFilm:
    """The results of the film at each point; dimensionless except temperatures [K]."""

    eps: Array
    """Relative eccentricity; infinite where no film was found [-]."""
    attitude: Array
    """Angle from the load to the smallest gap [rad]."""
    P_max: Array
    """Largest pressure p psi²/(eta_s omega) [-]."""
    T_max: Array
    """Highest temperature in the film [K]."""
    bush_max: Array
    """Highest temperature of the bush's surface [K]."""
    T_journal: Array
    T_groove: Array
    """Temperatures of the journal and of the oil that enters the film [K]."""
    T_side: Array
    """Mean temperature of the oil that leaves at the ends [K]."""
    torque: Array
    """Friction torque M psi/(B R² eta_s omega) [-]."""
    side: Array
    """Oil flow out of the ends, over U c_r B [-]."""
    dissipated: Array
    by_oil: Array
    by_bush: Array
    by_journal: Array
    """Heat dissipated, and heat removed by oil, bush and journal, over rho c U c_r B [K]."""
    residual: Array
    """Error of the heat balance over the dissipation, 0 below 1e-9; NaN with one temperature [-]."""
    mesh_error: Array
    """Relative change of the smallest film since the mesh of half the resolution [-]."""
    mesh_change: Array
    """Change of the highest temperature since the mesh of half the resolution [K]."""
    one_T: Array
    """Effective temperature of the same bearing in the one-temperature model [K]."""
    one_eps: Array
    one_torque: Array
    """Eccentricity and friction torque in the one-temperature model [-]."""
    bush: Array
    """(..., 72) temperature of the bush's surface at `ANGLES` [K]."""

    def admitted(self, eps: Array) -> "WarmFilm":
        """Return the same film with NaN where eps is NaN."""
        none = np.isnan(eps)
        each = {f.name: getattr(self, f.name) for f in fields(self)}
        bush = np.where(np.asarray(none)[..., None], np.nan, each.pop("bush"))
        kept = {name: np.where(none, np.nan, value)[()] for name, value in each.items()}
        return replace(self, **kept, bush=bush)


_ROUNDING = 1e-9
_FIELD = "solved numerically by finite volumes of Dowson's generalised Reynolds and the energy equation"


@on_paper(
    {
        ONE: "solved numerically by bracketing the heat balance of ISO 7902-1 with a map of films",
        FIELD: _FIELD,
        FINE: _FIELD,
    }
)
def warm_film(level: str, case: ThermalCase) -> WarmFilm:
    """Return the film of every point at a level.

    With one temperature all points are solved at once, otherwise one after the other.
    """
    if level == ONE:
        return _of_one(case)
    names = [field.name for field in fields(case)]
    parts = np.broadcast_arrays(*(np.asarray(getattr(case, name), float) for name in names))
    shape = parts[0].shape
    values = {f.name: np.full(shape, np.nan) for f in fields(WarmFilm) if f.name != "bush"}
    bush = np.full((*shape, ANGLES.size), np.nan)
    for at in np.ndindex(shape):
        point = ThermalCase(**{name: part[at] for name, part in zip(names, parts, strict=True)})
        if not point.is_whole():
            continue
        try:
            single, (coarse, fine) = both(point.bearing(), level)
            found = _measured(single, coarse, fine)
        except (ArithmeticError, RuntimeError, np.linalg.LinAlgError):
            values["eps"][at] = np.inf
            continue
        for name, value in found.items():
            values[name][at] = value
        bush[at] = _around(fine)
    return WarmFilm(**{name: value[()] for name, value in values.items()}, bush=bush)


def _of_one(case: ThermalCase) -> WarmFilm:
    """Return the film at level one_temperature; values that this level lacks are NaN."""
    values = mapped_values(case)
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    none = np.full(shape, np.nan)
    every = {f.name: values.get(f.name, none) for f in fields(WarmFilm) if f.name != "bush"}
    whole = {name: np.broadcast_to(value, shape)[()] for name, value in every.items()}
    return WarmFilm(**whole, bush=np.full((*shape, ANGLES.size), np.nan))


def _measured(single: OneTemperature, coarse: Warm, fine: Warm) -> dict[str, float]:
    """Return the scalar values of `WarmFilm`."""
    film, heat, supply = fine.film, fine.heated, fine.supply
    least, before = 1 - film.gap.eps, 1 - coarse.film.gap.eps
    return {
        "eps": film.gap.eps, "attitude": film.gap.attitude, "P_max": float(film.P.max()),
        "T_max": max(float(heat.T.max()), float(heat.bush.max())), "bush_max": float(heat.bush.max()),
        "T_journal": heat.journal,
        "T_groove": heat.groove, "T_side": supply + heat.by_side / heat.side, "torque": film.torque,
        "side": heat.side, "dissipated": heat.dissipated, "by_oil": heat.by_side + heat.by_drain,
        "by_bush": heat.by_bush, "by_journal": _above_rounding(heat.by_journal, heat.dissipated),
        "residual": _above_rounding(heat.residual, 1.0),
        "mesh_error": abs(before / least - 1),
        "mesh_change": abs(float(heat.T.max() - coarse.heated.T.max())),
        "one_T": single.T, "one_eps": single.film.gap.eps, "one_torque": single.film.torque,
    }  # fmt: skip


def _above_rounding(value: float, size: float) -> float:
    """Return a difference of numbers of a given magnitude; 0 if it is no more than rounding error."""
    return value if abs(value) > _ROUNDING * size else 0.0


def _around(warm: Warm) -> Array:
    """Return the temperature of the bush's surface at `ANGLES`; within the groove, that of the oil."""
    phi = warm.placing.arc.phi
    return np.interp(
        phi[0] + (ANGLES - phi[0]) % (2 * np.pi), phi, warm.heated.bush, right=warm.heated.groove
    )


@units("1", returns="rad", latex=r"k\,5°")
def bush_angles(eps: Array) -> Array:
    """Return the angles of the bush's temperatures from the load [rad], for each eccentricity [-]."""
    return np.asarray(np.broadcast_to(ANGLES, (*np.shape(eps), ANGLES.size)))


@on_paper(
    {
        ONE: "solved numerically by bracketing the heat balance of ISO 7902-1",
        FIELD: "solved numerically by finite volumes of the energy equation",
        FINE: "solved numerically by finite volumes of the energy equation",
    }
)
@units("1", returns="K")
def in_kelvin(value: Array) -> Array:
    """Return a temperature [K] of a `WarmFilm`, or a heat flow expressed in kelvin."""
    return value
