"""Static position of a journal in a mass-conserving film, from its load: eccentricity and attitude found.

The film is fed by a line at the widest gap, or by grooves that stand still relative to the load. Films are
those of `cavitating_film`, searched for on 64 × 8 intervals to 1e-4 of the load and then extrapolated from
twice as many; what is left is made up by the slope of the film map. No answer, where the supply pressure
alone lifts more than the load.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.physics.arrays import ECCENTRICITY_LIMIT, Array
from templates.physics.cavitating_film import CavitatingFilm, Groove, cavitating_film
from templates.physics.film_map import mapped_load
from templates.physics.film_map_inverse import mapped_eccentricity

_COARSE, _FINE = (64, 8), (128, 16)
_ACCURACY = 1e-4
_STEPS = 14
_SMALLEST = 1e-3
_LONGEST = 2.0
"""Largest change of ln So of the map in one step [-]."""


@dataclass(frozen=True)
class Feed:
    """How a bearing is fed; without grooves by a line at the widest gap."""

    pressure: float = 0.0
    """Supply pressure above ambient P = p psi²/(eta omega_h) [-]."""
    grooves: tuple[tuple[float, float], ...] = ()
    """Angle of the centre from the load in the sense of rotation, and width around, of each [rad]."""

    def placed(self, attitude: float) -> list[Groove]:
        """The grooves as the film sees them, from the narrowest gap."""
        if not self.grooves:
            return [Groove(np.pi, 0.0, P=self.pressure)]
        return [Groove(angle - attitude, width, P=self.pressure) for angle, width in self.grooves]


@dataclass(frozen=True)
class FedFilm:
    """A film whose load is nearly the one wanted; dimensionless as in `cavitating_film`."""

    eps: float
    So: float
    attitude: float
    P_max: float
    peak: float
    friction: float
    side_flow: float


@dataclass(frozen=True)
class Position:
    """A film whose load is nearly the one wanted."""

    eps: float
    film: CavitatingFilm
    tried: float
    """Attitude at which the grooves were placed [rad]."""


def fed_film(So: float, ratio: float, feed: Feed) -> FedFilm | None:
    """Find the film that bears So, to 1e-4; None if there is none or it does not settle.

    Below eps 1e-3 an unpressurised film is proportional to eps, and the film there stands for all.

    Args:
        So: Sommerfeld number F psi²/(B D eta omega_h), 0 or more [-].
        ratio: width over diameter B/D, 0.01 … 100 [-].
        feed: grooves and supply pressure.
    """

    low, high = np.log(mapped_load(np.array([_SMALLEST, ECCENTRICITY_LIMIT]), np.array(ratio)))

    def position(x: float, attitude: float) -> Position:
        eps = float(mapped_eccentricity(np.exp(min(max(x, low), high)), np.array(ratio)))
        return Position(eps, cavitating_film(eps, ratio, feed.placed(attitude), 0.0, *_COARSE), attitude)

    wanted = float(np.log(max(So, 1e-300)))
    if feed.pressure == 0:
        wanted = max(wanted, low)
    try:
        found = _grooved(position, wanted) if feed.grooves else _lined(position, wanted, low, high)
        return None if found is None else _extrapolated(found, ratio, feed)
    except (ArithmeticError, ValueError, RuntimeError):  # the last: a singular matrix
        return None


def _extrapolated(found: Position, ratio: float, feed: Feed) -> FedFilm:
    """By Richardson: load and attitude converge with order 2, shear and flow, which see the front, with 1."""
    coarse = found.film
    fine = cavitating_film(found.eps, ratio, feed.placed(found.tried), 0.0, *_FINE)
    second = {name: _towards(coarse, fine, name, 1 / 3) for name in ("So", "attitude", "P_max")}
    first = {name: _towards(coarse, fine, name, 1.0) for name in ("friction", "side_flow")}
    return FedFilm(eps=found.eps, peak=_peak(fine), **second, **first)


def _towards(coarse: CavitatingFilm, fine: CavitatingFilm, name: str, share: float) -> float:
    value = float(getattr(fine, name))
    return value + share * (value - float(getattr(coarse, name)))


def _peak(film: CavitatingFilm) -> float:
    """Place of the largest pressure at mid-width, by a parabola through the three nodes about it [rad]."""
    P = film.P[:, 0]
    k = min(max(int(P.argmax()), 1), P.size - 2)
    x = film.phi[k - 1 : k + 2] - film.phi[k]
    bend, slope, _ = np.polyfit(x / x[2], P[k - 1 : k + 2], 2)
    return float(film.phi[k] - (x[2] * slope / (2 * bend) if bend < 0 else 0.0))


def _lined(
    position: Callable[[float, float], Position], wanted: float, low: float, high: float
) -> Position | None:
    """Step along ln So of the map, on which the film's ln So rises about one for one; then bisect."""
    x = min(max(wanted, low), high)
    for _ in range(4 * _STEPS):
        found = position(x, 0.0)
        excess = float(np.log(found.film.So)) - wanted
        if abs(excess) < _ACCURACY:
            return found
        low, high = (low, x) if excess > 0 else (x, high)
        step = x - min(max(excess, -_LONGEST), _LONGEST)
        x = step if low < step < high else (low + high) / 2
        if high - low < _ACCURACY:
            return None
    return None


def _grooved(position: Callable[[float, float], Position], wanted: float) -> Position | None:
    """Broyden's method for ln So and the attitude together."""
    x, inverse = np.array([wanted, np.pi / 4]), np.diag([1.0, -0.5])
    found, residual = _residual(position, x, wanted)
    for _ in range(_STEPS):
        if np.abs(residual).max() < 10 * _ACCURACY:
            return found
        step = -np.clip(inverse @ residual, -0.5 * _LONGEST, 0.5 * _LONGEST)
        x = x + step
        found, new = _residual(position, x, wanted)
        change = inverse @ (new - residual)
        inverse += np.outer(step - change, step @ inverse) / (step @ change)
        residual = new
    return None


def _residual(
    position: Callable[[float, float], Position], x: Array, wanted: float
) -> tuple[Position, Array]:
    found = position(*x)
    turned = (found.film.attitude - x[1] + np.pi) % (2 * np.pi) - np.pi
    return found, np.array([np.log(found.film.So) - wanted, turned])
