r"""One effective viscosity for a film over a cycle, from the heat balance of film and oil flow.

.. math::
    k\,P = \rho c\,(Q + Q_p)(T_{ex} - T_{en}),\quad T = (T_{en} + T_{ex})/2,\quad
    \eta = \eta_\mathrm{Cross}\left(\eta_0(T),\ \dot\gamma\right)

This is the balance of ISO 7902-1 for a steady load, with power loss P and side flow Q averaged over the
cycle. Q_p is the flow that the supply pressure drives from a groove over the two lands, with the gap along
the orbit; as in the standard, the film's own pressure does not reduce it. The shear rate is |U|/h, averaged
over circumference and cycle.

P rises with the viscosity, and the film's temperature with P, so there is one root in ln(eta). The viscosity
at the supply temperature is divided by four repeatedly until it is too low: the last step brackets the root.
If there is no orbit at an end of that step, the step is halved.

References
----------
ISO 7902-1:1998, clause 6.4; Cross: J. Colloid Sci. 20, 1965, p. 417.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.optimize.elementwise import find_root

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.journals.oil import ViscousOil, viscosity_at
from templates.physics.journals.shear_thinning import (
    HTHS_TEMPERATURE,
    critical_rate_at,
    critical_rate_of_HTHS,
    viscosity_Cross_1965,
)
from templates.physics.orbits.cyclic_film import Duty, cycle_of, weights
from templates.physics.supplied.fed_cycle import (
    FedDuty,
    FedOrbit,
    fed_duty,
    fed_film,
    fed_orbit,
)
from templates.physics.supplied.supply_geometry import SupplyGeometry

LEVELS = ("mobility_short", "mobility", "mobility_grooved")
"""Levels of `fed_cycle` that are cheap enough to be solved at many viscosities."""
_STEPS = 6
_STEP = float(np.log(4))
"""Largest number and size (in ln) of the steps by which the search lowers the supply viscosity."""
_HALVINGS = 10
"""Largest number of halvings of a step at one end of which there is no orbit."""


@dataclass(frozen=True, kw_only=True)
class CycleOil(ViscousOil):
    """The oil and its heat capacity, in SI; single values for each point."""

    left: Array
    """Fraction of the shear-dependent viscosity that remains at 150 °C and 1e6 1/s; NaN without shear
    thinning [-].
    """
    endless: Array
    """Fraction of the viscosity that remains at infinite shear rate [-]."""
    exponent: Array
    """Exponent of Cross's law [-]."""
    supply: Array
    """Temperature of the supply [K]."""
    heat_capacity: Array
    """Heat capacity per volume [J/(m³ K)]."""
    share: Array
    """Share of the power loss that the oil removes [-]."""

    def sheared(self, T: Array, rate: Array) -> Array:
        """Return the viscosity [Pa s] at a temperature [K] and a shear rate [1/s]."""
        return self.viscosity(T) * (1 - self.taken(T, rate))

    def taken(self, T: Array, rate: Array) -> Array:
        """Return the share [-] by which shear reduces the viscosity at a temperature [K] and a rate [1/s]."""
        one, nothing = np.asarray(1.0), np.asarray(0.0)
        still, hot = self.viscosity(T), self.viscosity(np.asarray(HTHS_TEMPERATURE))
        at_150 = critical_rate_of_HTHS(self.left, one, nothing, self.exponent)
        critical = critical_rate_at(at_150, hot, still)
        with np.errstate(invalid="ignore"):
            kept = viscosity_Cross_1965(rate, one, nothing, critical, self.exponent)
        return np.where(np.isnan(self.left), 0.0, (1 - self.endless) * (1 - kept))


@dataclass(frozen=True)
class CycleBearing:
    """A bearing over its cycle, in SI."""

    level: str
    duty: Duty
    """Loads and speeds; the scale is that for 1 Pa s."""
    feeding: SupplyGeometry
    pressure: Array
    """Supply pressure, NaN without a groove [Pa]."""
    clearance: Array
    """Radial clearance [m]."""

    def fed(self, eta: Array) -> FedDuty:
        """Return the duty with its oil supply at a viscosity [Pa s]."""
        P = self.pressure * (2 * self.clearance / self.feeding.D) ** 2 / (eta * self.duty.Omega)
        return fed_duty(self.level, replace(self.duty, scale=self.duty.scale / eta), self.feeding, P)


@dataclass(frozen=True)
class CycleHeat:
    """The heat balance of every point; NaN where there is none."""

    eta: Array
    """Effective viscosity [Pa s]; infinite where no balance was found."""
    T: Array
    """Effective temperature [K]."""
    taken: Array
    """Share of the viscosity that shear takes [-]."""
    rate: Array
    """Mean shear rate [1/s]."""
    loss: Array
    """Power loss [W]."""
    side_flow: Array
    """Flow out of the ends displaced by the journal's motion [m³/s]."""
    feed_flow: Array
    """Flow driven by the supply pressure [m³/s]."""
    residual: Array
    """Viscosity from the heat balance over the assumed viscosity, minus 1 [-]."""


@dataclass(frozen=True)
class FilmState:
    """The results of a film with a given viscosity."""

    loss: Array
    side_flow: Array
    feed_flow: Array
    rate: Array


def heated_film(bearing: CycleBearing, eta: Array) -> tuple[FedOrbit, FilmState]:
    """Return orbit, loss, flows and shear rate at viscosities (...) [Pa s]; NaN where no orbit is found."""
    duty = bearing.duty
    fed = bearing.fed(eta)
    orbit = fed_orbit(bearing.level, fed)
    film = fed_film(bearing.level, fed, orbit)
    D, W, c, Omega = bearing.feeding.D, bearing.feeding.W, bearing.clearance, duty.Omega
    loss = film.loss * W * D**3 * eta * Omega**2 / (4 * c)
    side = film.side_flow * W * D * c * Omega
    period = cycle_of(duty.angle)
    mean = weights(duty.angle, period) / period
    sliding = np.abs(duty.omega_J - duty.omega_B)
    gap = orbit.gap
    with np.errstate(invalid="ignore"):
        rate = (sliding / np.sqrt(gap * (2 - gap))) @ mean * D / (2 * c)
    return orbit, FilmState(loss, side, film.feed_flow * W * D * c * Omega, rate)


@on_paper("solved numerically by bracketing the viscosity in the heat balance over the cycle")
def cycle_heat(bearing: CycleBearing, oil: CycleOil) -> CycleHeat:
    """Return the viscosity of every point that satisfies the heat balance."""
    shape = np.broadcast_shapes(
        *(np.shape(getattr(oil, field.name)) for field in fields(oil)), bearing.duty.points,
        *(np.shape(getattr(bearing.feeding, field.name)) for field in fields(bearing.feeding)),
        np.shape(bearing.pressure), np.shape(bearing.clearance),
    )  # fmt: skip
    top = np.log(np.broadcast_to(oil.viscosity(oil.supply), shape))

    def lack(x: Array) -> Array:
        """Return the logarithm of the viscosity from the heat balance minus that of the assumed viscosity."""
        eta = np.exp(x)
        film = heated_film(bearing, eta)[1]
        T = temperature(oil, film)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            return np.asarray(np.log(oil.sheared(T, film.rate)) - x)

    def at_some(x: Array, number: Array) -> Array:
        """Return the same object for a subset of the points, given by their indices."""
        everywhere = np.full(top.size, np.nan)
        everywhere[number.astype(np.int64)] = x
        return lack(everywhere.reshape(shape)).ravel()[number.astype(np.int64)]

    low, high = _bracket(lack, top, heaviest(bearing.duty))
    x = np.where(low == top, top, np.nan).ravel()
    number = np.flatnonzero((low < high).ravel())
    if number.size:
        missing: Callable[..., Array] = at_some
        found = find_root(
            missing, (low.ravel()[number], high.ravel()[number]), args=(number.astype(float),),
            tolerances={"xatol": 1e-10, "xrtol": 1e-12, "fatol": 1e-11},
        )  # fmt: skip
        x[number] = np.where(found.success, found.x, np.nan)
    solved = x.reshape(shape)
    film = heated_film(bearing, np.exp(solved))[1]
    T = temperature(oil, film)
    with np.errstate(invalid="ignore"):
        residual = np.asarray(oil.sheared(T, film.rate) / np.exp(solved) - 1)
    eta = np.where(np.isfinite(residual), np.exp(solved), np.inf)
    taken = oil.taken(T, film.rate)
    values = (eta, T, taken, film.rate, film.loss, film.side_flow, film.feed_flow, residual)
    return CycleHeat(*(np.asarray(value)[()] for value in values))


def _bracket(lack: Callable[[Array], Array], top: Array, load: Array) -> tuple[Array, Array]:
    """Return two values of ln(viscosity) with the root between them; NaN if there are none.

    Both are the supply viscosity `top` if it is too low already. Above the root the load may be so light that
    no orbit is found, below it so heavy that none is: then the interval is halved until both ends have one.
    """
    low, high, at = np.full(top.shape, np.nan), np.full(top.shape, np.nan), top
    low_known, high_known, found = (np.zeros(top.shape, bool) for _ in range(3))
    for _ in range(_STEPS + _HALVINGS + 1):
        missing = lack(at)
        with np.errstate(invalid="ignore"):
            below = (missing >= 0) | (np.isnan(missing) & (load >= np.exp(at)))
            above = (missing < 0) | (np.isnan(missing) & (load < np.exp(at)))
        low, low_known = np.where(below, at, low), np.where(below, missing >= 0, low_known)
        high, high_known = np.where(above, at, high), np.where(above, missing < 0, high_known)
        found = low_known & (high_known | (low == top))
        at = np.where(np.isnan(low), at - _STEP, (low + high) / 2)
        at = np.where(found | (at < top - (_STEPS + 0.5) * _STEP), np.nan, at)
        if np.isnan(at).all():
            break
    return np.where(found, low, np.nan), np.where(found, np.where(low == top, top, high), np.nan)


def heaviest(duty: Duty) -> Array:
    """Return the largest load number for an oil of 1 Pa s, (...) [Pa s]."""
    return np.asarray(np.hypot(duty.F_x, duty.F_y).max(axis=-1) * duty.scale)


def temperature(oil: CycleOil, film: FilmState) -> Array:
    """Return the mean of supply and outlet temperature, from the heat that the oil removes [K]."""
    with np.errstate(invalid="ignore", divide="ignore"):
        rise = oil.share * film.loss / (oil.heat_capacity * (film.side_flow + film.feed_flow))
    return np.asarray(oil.supply + rise / 2)


def _where_known(eta: Array, value: Array) -> Array:
    """Return the value where a viscosity was found, otherwise NaN."""
    return np.asarray(np.where(np.isnan(eta), np.nan, value))[()]


@units(None, returns="Pa*s", latex=r"\text{{by the heat balance}}")
def viscosity_of(heat: CycleHeat) -> Array:
    """Return the effective viscosity [Pa s]."""
    return heat.eta


@units(None, "Pa*s", returns="K", latex=r"\text{{by the heat balance}}")
def temperature_of(heat: CycleHeat, eta: Array) -> Array:
    """Return the effective temperature [K]; NaN where the viscosity is NaN."""
    return _where_known(eta, heat.T)


@units(None, "Pa*s", returns="1/s", latex=r"\text{{by the heat balance}}")
def rate_of(heat: CycleHeat, eta: Array) -> Array:
    """Return the mean shear rate [1/s]; NaN where the viscosity is NaN."""
    return _where_known(eta, heat.rate)


@units(None, "Pa*s", "Pa*s", returns="1", latex=r"1-\frac{{{1}}}{{{2}}}")
def shear_loss_of(heat: CycleHeat, eta: Array, still: Array) -> Array:
    """Return the share by which shear reduces the viscosity [-]; NaN where the viscosity is NaN.

    It follows from Cross's law and is never below 0. Except for the residual of the balance it equals 1 minus
    the ratio of the two viscosities [Pa s].
    """
    return _where_known(eta, heat.taken)


@units(None, "Pa*s", returns="W", latex=r"\text{{by the heat balance}}")
def loss_of(heat: CycleHeat, eta: Array) -> Array:
    """Return the power loss [W]; NaN where the viscosity is NaN."""
    return _where_known(eta, heat.loss)


@units(None, "Pa*s", returns="m**3/s", latex=r"\text{{by the heat balance}}")
def side_flow_of(heat: CycleHeat, eta: Array) -> Array:
    """Return the flow displaced by the journal's motion [m³/s]; NaN where the viscosity is NaN."""
    return _where_known(eta, heat.side_flow)


@units(None, "Pa*s", returns="m**3/s", latex=r"\text{{by the heat balance}}")
def feed_flow_of(heat: CycleHeat, eta: Array) -> Array:
    """Return the flow driven by the supply pressure [m³/s]; NaN where the viscosity is NaN."""
    return _where_known(eta, heat.feed_flow)


@units("m**3/s", "m**3/s", returns="m**3/s", latex="{0}+{1}")
def all_flow(side: Array, feed: Array) -> Array:
    """Return the flow out of the ends [m³/s]: side flow plus feed flow; a feed flow of NaN counts as 0."""
    return side + np.nan_to_num(feed)


@units(None, "1", "1", "Pa*s", "K", "K", None, "kg/m**3", "K", returns="Pa*s")
def viscosity_at_150(
    law: str, A: Array, B: Array, a: Array, b: Array, offset: Array, eta: Array, rho_ref: Array, T_ref: Array
) -> Array:
    """Return the viscosity at low shear and 150 °C, by the law `walther` or `vogel`, or as given [Pa s].

    Parameters
    ----------
    law
        The law whose constants are used.
    A, B
        Walther's intercept and slope [-].
    a, b, offset
        Vogel's factor [Pa s], slope and offset [K].
    eta
        The viscosity, if it is given, else NaN [Pa s].
    rho_ref, T_ref
        Density [kg/m³] at a temperature [K].
    """
    factor = a if law == "vogel" else np.full_like(np.asarray(a, float), np.nan)
    return viscosity_at(np.asarray(HTHS_TEMPERATURE), A, B, factor, b, offset, eta, rho_ref, T_ref)[()]


@units("Pa*s", "Pa*s", "1", None, returns="1", latex=r"\frac{{{0}-{2}\,{1}}}{{(1-{2})\,{1}}}")
def left_by_HTHS(hths: Array, hot: Array, endless: Array, eta: Array) -> Array:
    """Return the fraction of the shear-dependent viscosity that remains at 150 °C and 1e6 1/s [-].

    The result is NaN without shear thinning.

    Parameters
    ----------
    hths
        HTHS viscosity, NaN if none is given [Pa s].
    hot
        Viscosity at low shear and 150 °C [Pa s].
    endless
        Fraction of the viscosity that remains at infinite shear rate [-].
    eta
        The viscosity of the film, if it is given: it then has no shear thinning [Pa s].
    """
    left = (hths - endless * hot) / ((1 - endless) * hot)
    return np.where(np.isnan(eta), left, np.nan)[()]
