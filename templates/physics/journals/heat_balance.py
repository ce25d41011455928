r"""Temperature of a journal bearing's film from the heat balance of ISO 7902-1, by bracketed search.

.. math:: P(T) = \rho c\,Q(T)\,(T_{out} - T_{supply}) + kA\,(T - T_{ambient}), \quad
    T = (T_{supply}+T_{out})/2

Every level of fidelity uses the power loss P and the side flow Q of the film map (`film_map`) at the
viscosity of T, so temperature and viscosity are the same at all levels. A term that is not given is omitted.
P decreases with T and the removed heat increases, so there is at most one root; it lies between the colder of
the two surroundings and 500 °C.

References
----------
ISO 7902-1:1998, clause 6.4; DIN 31652-1:1983, section 4.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.language.declare import on_paper
from templates.physics.films.film_map import NARROWEST, WIDEST, mapped_load
from templates.physics.journals.oil import ViscousOil
from templates.physics.journals.static_journal import static_film_at
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT
from templates.physics.numerics.roots import bracketed_root

HOTTEST = 773.15
"""Highest film temperature that is sought [K]."""
_ACCURACY = 1e-13


@dataclass(frozen=True, kw_only=True)
class OperatingPoint(ViscousOil):
    """A bearing in operation, in SI; arrays that broadcast together."""

    F: Array
    """Load [N]."""
    D: Array
    """Diameter [m]."""
    W: Array
    """Width [m]."""
    psi: Array
    """Relative clearance [-]."""
    omega_m: Array
    """Magnitude of the hydrodynamic speed [rad/s]."""
    omega_s: Array
    """Sliding speed, positive with the hydrodynamic speed [rad/s]."""
    heat_capacity: Array
    """Heat capacity of the oil per volume, rho c [J/(m³ K)]."""
    T_supply: Array
    """Temperature of the oil supplied, else NaN [K]."""
    T_ambient: Array
    """Temperature of the air, else NaN [K]."""
    kA: Array
    """Heat transfer coefficient times area, else NaN [W/K]."""

    def power_and_flow(self, T: Array) -> tuple[Array, Array]:
        """Return power loss [W] and side flow [m³/s] at T [K]; outside the map, the values at its limit."""
        eta, ratio = self.viscosity(T), self.W / self.D
        scale = self.W * self.D * eta * self.omega_m / self.psi**2
        inside = (ratio >= NARROWEST) & (ratio <= WIDEST)
        most = mapped_load(np.asarray(ECCENTRICITY_LIMIT), np.where(inside, ratio, 1.0))
        film = static_film_at("map", np.minimum(self.F / scale, most * (1 - 1e-9)), ratio)
        couple = film.eps * film.So * np.sin(film.attitude) / 2
        half = scale * self.psi * self.D / 2
        power = half * (film.shear * self.omega_s**2 / self.omega_m + couple * self.omega_m)
        return power, film.side_flow * (self.D / 2) ** 3 * self.psi * self.omega_m

    def coldest(self) -> Array:
        """Return the lower of the supply and the ambient temperature; if only one is given, that one [K]."""
        return np.fmin(self.T_supply, np.where(np.isfinite(self.kA), self.T_ambient, np.nan))

    def heat(self, rise: Array) -> tuple[Array, Array, Array]:
        """Return power, heat to oil and heat to air [W] at a rise above the coldest surrounding [K].

        Differences are formed before the rise is added, because a small rise would be lost in the rounding
        error of T.
        """
        coldest = self.coldest()
        power, flow = self.power_and_flow(coldest + rise)
        by_oil = self.heat_capacity * flow * 2 * ((coldest - self.T_supply) + rise)
        by_air = self.kA * ((coldest - self.T_ambient) + rise)
        return power, np.nan_to_num(by_oil, nan=0.0), np.nan_to_num(by_air, nan=0.0)

    def excess(self, rise: Array) -> Array:
        """Return the fraction of the power that is not removed [-]."""
        power, by_oil, by_air = self.heat(rise)
        return 1 - (by_oil + by_air) / power

    def residual(self, rise: Array) -> Array:
        """Return the heat imbalance relative to the largest of power, heat to oil and heat to air [-]."""
        power, by_oil, by_air = self.heat(rise)
        largest = np.maximum(power, np.maximum(np.abs(by_oil), np.abs(by_air)))
        return (power - by_oil - by_air) / largest


@dataclass(frozen=True)
class HeatBalance:
    """The balance; NaN where it was not requested."""

    T: Array
    """Film temperature [K]; infinite where there is no balance below 500 °C."""
    T_out: Array
    """Temperature of the outflowing oil; NaN also without a supply [K]."""
    residual: Array
    """Heat imbalance over the largest of power, heat to oil and heat to air [-]."""


@on_paper("solved numerically by bracketing the film temperature in the heat balance of ISO 7902-1")
def heat_balance(running: OperatingPoint) -> HeatBalance:
    """Return the film temperature of every point that has an oil supply, or air for cooling."""
    names = [field.name for field in fields(running)]
    parts = np.broadcast_arrays(*(np.asarray(getattr(running, name), dtype=float) for name in names))
    everything = OperatingPoint(**dict(zip(names, parts, strict=True)))
    wanted = asked_for(everything.T_supply, everything.T_ambient, everything.kA)
    T, residual = np.full(wanted.shape, np.nan), np.full(wanted.shape, np.nan)
    if wanted.any():
        point = OperatingPoint(**{name: part[wanted] for name, part in zip(names, parts, strict=True)})
        T[wanted], residual[wanted] = _balance(point)
    return HeatBalance(T[()], (2 * T - everything.T_supply)[()], residual[()])


def asked_for(T_supply: Array, T_ambient: Array, kA: Array) -> Mask:
    """Return whether a supply temperature is given, or both an air temperature and a heat transfer."""
    return np.asarray(np.isfinite(T_supply) | (np.isfinite(T_ambient) & np.isfinite(kA)))


def _balance(point: OperatingPoint) -> tuple[Array, Array]:
    """Return the temperature and residual of a one-dimensional array of points.

    If there is no balance, they are infinite and NaN; if data are missing, both are NaN.
    """
    coldest = point.coldest()
    most = HOTTEST - coldest
    rise = bracketed_root(point.excess, np.zeros_like(coldest), most, _ACCURACY)
    none = np.isnan(rise) & ~np.isnan(point.excess(most))
    return np.where(none, np.inf, coldest + rise), point.residual(rise)
