"""Static position of a journal in a mass-conserving film, from its load: eccentricity and attitude.

The film is fed by a line at the widest gap, or by grooves that are stationary relative to the load. The
search solves films of `cavitating_film` on 64 × 8 intervals. The result is extrapolated with a mesh of twice
as many intervals, and the film's stiffness corrects the remaining difference in load. There is no result if
the supply pressure alone supports more than the load, or if the search does not converge within 20 films.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities.cavitating_dynamics import LinearFilm, linear_film
from templates.physics.cavities.cavitating_film import CavitatingFilm, RingSolution, measured, solved_ring
from templates.physics.cavities.cavitating_network import Groove
from templates.physics.films.film_map import mapped_film, mapped_load
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

_COARSE, _FINE = (64, 8), (128, 16)
_ACCURACY = 1e-3
"""Residual over the load at which the search ends; the rest is corrected linearly."""
_SHORTEST = 1e-4
"""Step of y, relative to |y| if this is below 1, at which the search also ends: if pressure outweighs the
load [-].
"""
_HUNTED = 0.03
"""The same limit if the force has a discontinuity [-]."""
_STEPS = 20
_SMALLEST = 1e-3
"""Eccentricity below which a film without supply pressure is scaled linearly [-]."""
_LONGEST = 1.0
"""Longest step of atanh(eps); halved whenever the search reverses [-]."""


@dataclass(frozen=True)
class Feed:
    """The grooves that feed a bearing; if there are none, a line at the widest gap."""

    pressure: float = 0.0
    """Supply pressure above ambient P = p psi²/(eta omega_h) [-]."""
    grooves: tuple[tuple[float, float], ...] = ()
    """Angle of each centre from the load in the sense of rotation, and circumferential width [rad]."""

    def placed(self, attitude: float) -> list[Groove]:
        """Return the grooves with angles measured from the narrowest gap."""
        if not self.grooves:
            return [Groove(np.pi, 0.0, P=self.pressure)]
        return [Groove(angle - attitude, width, P=self.pressure) for angle, width in self.grooves]


@dataclass(frozen=True)
class FedFilm:
    """A film that carries almost exactly the required load; dimensionless as in `cavitating_film`."""

    eps: float
    """Eccentricity at the required load."""
    solved_eps: float
    """Eccentricity of the film that was solved for the other results."""
    attitude: float
    """Attitude at the required load [rad]."""
    P_max: float
    peak: float
    shear: float
    side_flow: float


@dataclass(frozen=True)
class Place:
    """The position of the journal as a vector y along and ahead of the load, of length atanh(eps).

    With this unknown no step leaves the bearing, and near the wall a step of 1 changes the force by an amount
    comparable to the load.
    """

    y: Array

    @property
    def eps(self) -> float:
        """Return the relative eccentricity [-]."""
        return min(float(np.tanh(np.hypot(*self.y))), ECCENTRICITY_LIMIT)

    @property
    def attitude(self) -> float:
        """Return the angle from the load to the narrowest gap [rad]."""
        return float(np.arctan2(self.y[1], self.y[0]))

    def moved(self, step: Array) -> "Place":
        """Return the position after a step of y, limited to eccentricities for which films can be solved."""
        y = self.y + step
        size = max(float(np.hypot(*y)), 1e-300)
        return Place(y * min(1.0, float(np.arctanh(ECCENTRICITY_LIMIT)) / size))


@dataclass(frozen=True)
class Lack:
    """The difference between a film's force and the load."""

    share: float
    """Missing force over the load; infinite without a film [-]."""
    step: Array
    """Change of y that corrects it linearly."""


def fed_coefficients(eps: float, ratio: float, attitude: float, feed: Feed) -> tuple[Array, Array]:
    """Return stiffness and damping (2, 2) in the axes of the load, in units of psi²/(B D eta omega_h).

    Parameters
    ----------
    eps
        Relative eccentricity [-].
    ratio
        Width over diameter B/D [-].
    attitude
        Angle from the load to the narrowest gap; without grooves the film determines it [rad].
    feed
        Grooves and supply pressure.

    Returns
    -------
    Both matrices; NaN where the cavities do not converge.
    """
    try:
        film = linear_film(solved_ring(max(eps, _SMALLEST), ratio, feed.placed(attitude), 0.0, *_FINE))
    except (ArithmeticError, RuntimeError):
        return np.full((2, 2), np.nan), np.full((2, 2), np.nan)
    own = float(np.arctan2(-film.force[1], film.force[0]))
    film = film.turned(attitude if feed.grooves else own)
    return film.K, film.B


def fed_film(So: float, ratio: float, feed: Feed) -> FedFilm | None:
    """Return the film that carries a Sommerfeld number; None if there is none or the search fails.

    Parameters
    ----------
    So
        Sommerfeld number F psi²/(B D eta omega_h), 0 or more [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].
    feed
        Grooves and supply pressure.
    """
    smallest = 0.0 if feed.pressure > 0 else float(mapped_load(np.array(_SMALLEST), np.array(ratio)))
    search = Search(max(So, smallest), ratio, feed)
    try:
        balance = search.balance()
        film = None if balance is None else search.extrapolated(*balance)
    except (ArithmeticError, ValueError, RuntimeError):  # the last two indicate a singular matrix
        return None
    return film if film is None or So >= smallest else replace(film, eps=film.eps * So / smallest)


@dataclass(frozen=True)
class Search:
    """The search for the position at which a film carries a load."""

    load: float
    """Sommerfeld number [-]."""
    ratio: float
    """Width over diameter B/D [-]."""
    feed: Feed
    """Stationary grooves, or none: the supply line then rotates with the journal."""

    def balance(self) -> tuple[Place, RingSolution] | None:
        """Return the position and its film on the coarse mesh, by Newton's method.

        Steps are halved when the search changes direction. The mesh follows the grooves, so the force has
        discontinuities; if the search oscillates about one, the position with the smallest residual is
        returned.
        """
        place, longest, before = self.start(), _LONGEST, np.zeros(2)
        best, nearest, ring = None, _HUNTED, None
        for _ in range(_STEPS):
            ring = self.solved(place, _COARSE, ring)
            lack = self.lack(place, linear_film(ring))
            distance = float(np.hypot(*lack.step)) / min(1.0, float(np.hypot(*place.y)))
            if distance <= nearest:
                best, nearest = (place, ring), distance
            if lack.share <= _ACCURACY or distance <= _SHORTEST:
                return place, ring
            if lack.step @ before < 0:
                longest /= 2
            if longest <= _HUNTED and best is not None:
                break
            before = lack.step * min(1.0, longest / float(np.hypot(*lack.step)))
            place = place.moved(before)
        return best

    def start(self) -> Place:
        """Return the initial position of the journal, from the film map."""
        eps = mapped_eccentricity(np.array(self.load), np.array(self.ratio))
        eps = np.where(np.isnan(eps), ECCENTRICITY_LIMIT, np.maximum(eps, _SMALLEST))
        attitude = mapped_film(eps, np.array(self.ratio))["attitude"]
        return Place(np.arctanh(eps) * np.array([np.cos(attitude), np.sin(attitude)]))

    def solved(self, place: Place, mesh: tuple[int, int], near: RingSolution | None) -> RingSolution:
        """Return the film at a position; the solution starts from a nearby film if there is one."""
        grooves = self.feed.placed(place.attitude)
        if near is not None:
            with suppress(ArithmeticError):
                return solved_ring(place.eps, self.ratio, grooves, 0.0, *mesh, near)
        return solved_ring(place.eps, self.ratio, grooves, 0.0, *mesh)

    def lack(self, place: Place, film: LinearFilm) -> Lack:
        """Return the difference between force and load; `film` is in the axes of the line of centres."""
        step = self._step_to_grooves if self.feed.grooves else self._step_with_line
        missing, displacement = step(place, film)
        share = float(np.hypot(*missing)) / self.load if self.load > 0 else np.inf
        along, ahead = displacement
        size = float(np.arctanh(place.eps))
        radial, turned = place.y / size, np.array([-place.y[1], place.y[0]]) / size
        return Lack(share, along / (1 - place.eps**2) * radial + ahead * size / place.eps * turned)

    def _step_to_grooves(self, place: Place, film: LinearFilm) -> tuple[Array, Array]:
        """Return the missing force, and the displacement that supplies it, in axes of the line of centres."""
        load = self.load * np.array([np.cos(place.attitude), -np.sin(place.attitude)])
        missing: Array = load - film.force
        return missing, np.asarray(np.linalg.solve(film.K, missing))

    def _step_with_line(self, place: Place, film: LinearFilm) -> tuple[Array, Array]:
        """Return the missing force, and the step along the line of centres; the film rotates as a whole."""
        borne = float(np.hypot(*film.force))
        missing = (self.load - borne) * film.force / borne
        along = (self.load - borne) / (film.force / borne @ film.K[:, 0])
        return missing, np.array([max(along, -0.9 * place.eps), 0.0])

    def extrapolated(self, place: Place, ring: RingSolution) -> FedFilm:
        """Return the film by Richardson extrapolation from the coarse mesh, corrected to the load.

        Load and peak pressure converge with order 2; shear and flow depend on the re-formation front and
        converge with order 1.
        """
        finer = self.solved(place, _FINE, ring)
        coarse, fine, linear = measured(ring), measured(finer), linear_film(finer)
        force = linear.force + (linear.force - linear_film(ring).force) / 3
        final = place.moved(self.lack(place, replace(linear, force=force)).step)
        turning = force + linear.K[:, 0] * (final.eps - place.eps)
        friction, side_flow = (2 * getattr(fine, n) - getattr(coarse, n) for n in ("friction", "side_flow"))
        return FedFilm(
            eps=final.eps,
            solved_eps=place.eps,
            attitude=final.attitude if self.feed.grooves else float(np.arctan2(-turning[1], turning[0])),
            P_max=fine.P_max + (fine.P_max - coarse.P_max) / 3,
            peak=_peak(fine),
            shear=friction + place.eps * force[1] / 2,
            side_flow=side_flow,
        )


def _peak(film: CavitatingFilm) -> float:
    """Return the angle of the largest pressure at mid-width [rad], from a parabola through three nodes."""
    P = film.P[:, 0]
    k = min(max(int(P.argmax()), 1), P.size - 2)
    x = film.phi[k - 1 : k + 2] - film.phi[k]
    bend, slope, _ = np.polyfit(x / x[2], P[k - 1 : k + 2], 2)
    return float(film.phi[k] - (x[2] * slope / (2 * bend) if bend < 0 else 0.0))
