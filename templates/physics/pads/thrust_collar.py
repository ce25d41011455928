r"""A thrust collar on fixed-incline pads: film from load, with the temperature of a heat balance.

Every pad has the same film, h = h_o + t (1 − xi) over its angle. The film ratio a = h_i/h_o is the only
unknown: it gives the outlet film h_o = t/(a − 1), the load then gives the viscosity, and the heat balance the
temperature. At one value of a the oil has that viscosity at that temperature.

Heat balance of a pad: its oil enters at T_1. It leaves at the outlet at T_2, and at the sides at the mean of
both, which is the film temperature. A fraction k of the outlet's oil flows under the next pad, and fresh oil
replaces the rest; no heat is lost through pads and collar:

.. math::
    P = \rho c\,(T_2 - T_1)(Q_i - \tfrac12 Q_s), \quad Q_i T_1 = k Q_o T_2 + (Q_i - k Q_o) T_s
"""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper
from templates.physics.numerics.roots import root_between
from templates.physics.pads.sector_equations import solved_sectors
from templates.physics.pads.slider_film import shear_of_wedge

FLATTEST, STEEPEST = 1e-6, 99.0
"""Limits of the search for h_i/h_o − 1 [-]."""
HOTTEST = 773.15
"""Highest film temperature of the search [K]."""

_MESH = 32, 8
_BLOCK = 512
_LARGEST_LOGARITHM = 60.0

Law = Callable[..., Array]
"""Function that returns the viscosity [Pa s] at a temperature [K]; further arguments are the oil's
constants."""


@dataclass(frozen=True, kw_only=True)
class Collar:
    """A collar in operation, in SI; arrays that broadcast together."""

    load: Array
    """Specific load: the load over the area of the pads [Pa]."""
    taper: Array
    """Taper h_i − h_o [m]."""
    omega: Array
    """Angular velocity [rad/s]."""
    radius: Array
    """Mean radius r_m [m]."""
    angle: Array
    """Angle of one pad [rad]."""
    reach: Array
    """Outer over inner radius [-]."""
    heat_capacity: Array
    """Heat capacity of the oil per volume, rho c [J/(m³ K)]."""
    T_supply: Array
    """Temperature of fresh oil; NaN if there is no heat balance [K]."""
    carried: Array
    """Fraction k of the oil from a pad's outlet that enters the next pad [-]."""


@dataclass(frozen=True)
class CollarFilm:
    """The results of the film, dimensionless; NaN where no film ratio carries the load below `HOTTEST`."""

    a: Array
    """Film ratio h_i/h_o; infinite where no film ratio supports the load."""
    load: Array
    """Specific load times h_o²/(6 eta omega r_m² angle)."""
    friction: Array
    """Friction torque over load, mean radius and h_o/l."""
    inlet: Array
    """Flow into a pad over omega r_m h_o b."""
    side: Array
    """Flow out at the sides of a pad over omega r_m h_o b."""


def collar_film(a: Array, angle: Array, reach: Array) -> CollarFilm:
    """Return the film of sector pads.

    Parameters
    ----------
    a
        (N,) film ratio above 1 [-].
    angle
        (N,) angle of a pad [rad].
    reach
        (N,) outer over inner radius [-].
    """
    blocks = [slice(i, i + _BLOCK) for i in range(0, a.size, _BLOCK)]
    numbers = [_extrapolated(a[part], angle[part], reach[part]) for part in blocks]
    load, inlet, side = np.concatenate(numbers).T if numbers else np.empty((3, 0))
    farther_out = (
        2 * (1 + reach**2) / (1 + reach) ** 2
    )  # the mean of r² over r_m², to which shear is proportional
    friction = farther_out * shear_of_wedge(a) / (6 * load) + (a - 1) / 2
    return CollarFilm(a, load, friction, inlet, side)


def _extrapolated(a: Array, angle: Array, reach: Array) -> Array:
    """Return load, inlet and side flow of sector pads (N, 3), by Richardson extrapolation from two meshes."""
    along, across_half = _MESH
    coarse = solved_sectors(a, angle, reach, along // 2, across_half // 2)
    fine = solved_sectors(a, angle, reach, along, across_half)
    return fine + (fine - coarse) / 3


def collar_temperature(collar: Collar, film: CollarFilm) -> Array:
    """Return the temperature of a film that carries the load; NaN without a supply [K]."""
    gain = collar.load / collar.heat_capacity * film.friction / (film.inlet - film.side / 2)
    kept = collar.carried * (film.inlet - film.side)
    return collar.T_supply + gain * (kept / (film.inlet - kept) + 0.5)


def _excess(law: Law, logarithm: Array, collar: Collar, oil: tuple[Array, ...]) -> Array:
    """Return ln of the oil's viscosity over the needed one, at the film ratio 1 + exp(logarithm)."""
    wedge = np.exp(logarithm)
    film = collar_film(1 + wedge, collar.angle, collar.reach)
    T = np.minimum(collar_temperature(collar, film), HOTTEST)
    h_o = collar.taper / wedge
    needed = collar.load * (h_o / collar.radius) ** 2 / (6 * collar.omega * collar.angle * film.load)
    there = np.log(law(T, *oil))
    return np.clip(there, -_LARGEST_LOGARITHM, _LARGEST_LOGARITHM) - np.log(needed)


@on_paper(
    "solved numerically by bracketing the film ratio, of pads by finite volumes of the Reynolds equation"
)
def working_collar(collar: Collar, law: Law, *oil: Array) -> CollarFilm:
    """Return the film that carries the load with the oil's viscosity at the temperature of the film.

    There is no film if its heat balance would make it hotter than `HOTTEST`.

    Parameters
    ----------
    collar
        The collar, with arrays that broadcast together.
    law
        Function that returns the viscosity from a temperature and the oil's constants.
    oil
        The constants of the oil, arrays.
    """
    names = [field.name for field in fields(Collar)]
    values = [np.asarray(getattr(collar, name), dtype=float) for name in names]
    parts = np.broadcast_arrays(*values, *oil)
    needed = [part for name, part in zip(names, parts, strict=False) if name != "T_supply"]
    usable = np.all(np.isfinite(needed), axis=0)
    chosen = [part[usable] for part in parts]

    def excess(logarithm: Array, *points: Array) -> Array:
        at = Collar(**dict(zip(names, points, strict=False)))
        return _excess(law, logarithm, at, points[len(names) :])

    low, high = (np.full(chosen[0].shape, np.log(limit)) for limit in (FLATTEST, STEEPEST))
    a, numbers = np.full(usable.shape, np.nan), np.full((len(fields(CollarFilm)), *usable.shape), np.nan)
    with np.errstate(all="ignore"):
        root = np.atleast_1d(root_between(excess, low, high, *chosen)) if usable.any() else low
    a[usable] = 1 + np.exp(root)
    borne = np.isfinite(a)
    film = collar_film(a[borne], *(parts[names.index(name)][borne] for name in ("angle", "reach")))
    numbers[:, borne] = [getattr(film, field.name) for field in fields(CollarFilm)]
    whole = Collar(**dict(zip(names, parts, strict=False)))
    with np.errstate(all="ignore"):
        hot = collar_temperature(whole, CollarFilm(*numbers)) > HOTTEST
    numbers[:, hot] = np.nan
    numbers[0, hot | (usable & ~borne)] = np.inf
    return CollarFilm(*(number[()] for number in numbers))
