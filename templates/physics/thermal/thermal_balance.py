"""Equilibrium of a film, its temperatures and the load: with one temperature, or with a temperature field.

The temperatures are a fixed point: they determine the viscosity, the viscosity determines the film that
carries the load, and that film determines the temperatures. Anderson acceleration needs about ten films. For
comparison, the film with one effective temperature, as in ISO 7902-1, is solved on the same mesh and with the
same feed.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_map import mapped_film
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.thermal.across import strip_edges
from templates.physics.thermal.anderson import Anderson
from templates.physics.thermal.arc import Arc, groove_arc
from templates.physics.thermal.bearing_place import NoBalance, PositionSearch
from templates.physics.thermal.energy import FilmHeat, HeatSources, carried, heated
from templates.physics.thermal.pressure import PressureSolution

HOTTEST = 773.15
"""Highest temperature of the search [K]."""
FIELD, FINE = "field", "fine_field"
MESHES = {FIELD: ((24, 4, 8), (48, 8, 12)), FINE: ((48, 8, 12), (96, 16, 24))}
"""The initial and the final mesh of each level: intervals around, across half the width, strips across the
film."""
_ROUNDS = 80
_ACCURACY = 1e-7
"""The iteration ends when the change of temperature over the largest rise is below this [-]."""
_FORCE = 1e-8
_LIGHTEST, _HEAVIEST = 0.05, 0.98
"""Smallest and largest eccentricity at which a search starts [-]."""


@dataclass(frozen=True)
class Bearing:
    """A bearing, dimensionless except for its temperatures."""

    So: float
    """F psi²/(B D eta_s omega) with the viscosity of the supply [-]."""
    ratio: float
    """Width over diameter [-]."""
    pressure: float
    """Supply pressure p psi²/(eta_s omega) [-]."""
    groove: tuple[float, float, float]
    """Angle of the groove's middle from the load [rad], its angular width [rad], and its length over the
    bearing's width [-]."""
    heating: HeatSources
    fluidity: Callable[[Array], Array]
    """Function that returns the viscosity at supply over the viscosity at a temperature [K]."""

    def arc(self, y: Array, mesh: tuple[int, int, int]) -> Arc:
        """Return the mesh of the film, graded to a position of the journal."""
        centre, width, _ = self.groove
        eps, attitude = float(np.tanh(np.hypot(*y))), float(np.arctan2(y[1], y[0]))
        return groove_arc(
            centre + width / 2, 2 * np.pi - width, (min(eps, _HEAVIEST), attitude), self.ratio, *mesh[:2]
        )

    def placing(self, y: Array, mesh: tuple[int, int, int]) -> PositionSearch:
        """Return a position search on a mesh, starting from a given position."""
        return PositionSearch(
            self.arc(y, mesh), strip_edges(mesh[2]), self.So, (self.pressure, self.groove[2]), y
        )

    def start(self) -> Array:
        """Return the journal's position for a film at the supply viscosity, fed along its widest gap."""
        if not np.isfinite(self.So):
            raise NoBalance("the oil is not viscous enough to support a load")
        eps = mapped_eccentricity(np.asarray(self.So), np.asarray(self.ratio))
        eps = np.clip(np.where(np.isnan(eps), _HEAVIEST, eps), _LIGHTEST, _HEAVIEST)
        attitude = mapped_film(eps, np.asarray(self.ratio))["attitude"]
        return np.asarray(np.arctanh(eps) * np.array([np.cos(attitude), np.sin(attitude)]))


@dataclass(frozen=True)
class OneTemperature:
    """A film of uniform viscosity whose heat is removed by side flow and air."""

    T: float
    """Effective temperature [K]."""
    film: PressureSolution
    placing: PositionSearch


@dataclass(frozen=True)
class Warm:
    """A film with its temperatures."""

    film: PressureSolution
    heated: FilmHeat
    rounds: int
    """Number of films solved until the temperatures converged."""
    placing: PositionSearch
    supply: float
    """Temperature of the fresh oil [K]."""


def one_temperature(bearing: Bearing, placing: PositionSearch, T: float, step: float) -> OneTemperature:
    """Return the film at the effective temperature, by secants between guesses [K] at most `step` [K] apart.

    Raises
    ------
    NoBalance
        If no film carries the load, or its heat cannot be removed below 500 °C.
    """
    shape = placing.arc.phi.size, placing.edges.size - 1

    def missing(at: float) -> tuple[float, PressureSolution]:
        fluidity = np.full(shape, float(bearing.fluidity(np.asarray(at))))
        film = placing.placed(fluidity, _FORCE)
        return _mean(film, bearing.heating) - at, film

    lack, film = missing(T)
    after = T + float(np.clip(0.5 * lack, -step, step))
    for _ in range(_ROUNDS):
        if abs(lack) < _ACCURACY * max(abs(T - bearing.heating.supply), 1.0):
            return OneTemperature(T, film, placing)
        if not after < HOTTEST:
            break
        found, film = missing(after)
        slope = (found - lack) / (after - T) if after != T else -1.0
        T, lack = after, found
        after = T - float(np.clip(lack / min(slope, -0.3), -2 * step, 2 * step))
    raise NoBalance("no film temperature below 500 degC balances the heat")


def _mean(film: PressureSolution, heating: HeatSources) -> float:
    """Return the mean of supply and outlet temperature, from the heat removed by side flow and air [K]."""
    flow = carried(film)
    side = float(flow.side.sum())
    air = 0.0 if np.isinf(heating.wall) else 2 * np.pi * heating.wall
    gained = heating.delta * float(flow.heat.sum()) + air * (heating.outside - heating.supply)
    if not side + air > 0:
        raise NoBalance("no oil flow or surface removes the heat")
    return heating.supply + gained / (2 * side + air)


def warm(bearing: Bearing, placing: PositionSearch, T: Array) -> Warm:
    """Return the film with a temperature field, from a guess (n + 1, J) [K].

    Raises
    ------
    NoBalance
        If there is none below 500 °C, or the temperatures do not converge.
    """
    heating, search = bearing.heating, Anderson()
    given = [T for T in (heating.supply, heating.outside, heating.journal) if np.isfinite(T)]
    coldest = min(given)
    for rounds in range(1, _ROUNDS):
        film = placing.placed(bearing.fluidity(T), _FORCE)
        try:
            found = heated(film, heating, placing.edges)
        except RuntimeError as failure:
            raise NoBalance("no oil flow or surface removes the heat") from failure
        change = found.T - T
        rise = max(float(np.abs(found.T - heating.supply).max()), 1e-3)
        if float(np.abs(change).max()) < _ACCURACY * rise:
            if not (found.T.max() < HOTTEST and found.T.min() > coldest - 1):
                break
            return Warm(film, found, rounds, placing, heating.supply)
        T = np.clip(search.after(T, change), coldest, HOTTEST)
    raise NoBalance("the temperatures do not converge below 500 degC")


def both(bearing: Bearing, level: str) -> tuple[OneTemperature, tuple[Warm, Warm]]:
    """Return the film with one temperature on the level's mesh, and the film with a temperature field.

    The temperature field is solved on the next coarser mesh and on the level's mesh.

    Raises
    ------
    NoBalance
        If one of them is not found.
    """
    before, mesh = MESHES[level]
    placing = bearing.placing(bearing.start(), before)
    single = one_temperature(bearing, placing, bearing.heating.supply, 30.0)
    placing = bearing.placing(placing.y, before)
    T = np.full((placing.arc.phi.size, before[2]), single.T)
    coarse = warm(bearing, placing, T)
    finer = bearing.placing(coarse.placing.y, mesh)
    fine = warm(bearing, finer, _carried_over(coarse, finer))
    last = one_temperature(bearing, bearing.placing(single.placing.y, mesh), single.T, 0.5)
    return last, (coarse, fine)


def _carried_over(coarse: Warm, finer: PositionSearch) -> Array:
    """Interpolate the temperatures of one mesh to the nodes and strips of another."""
    T, arc = coarse.heated.T, coarse.placing.arc
    middle, new = (((edges[1:] + edges[:-1]) / 2) for edges in (coarse.placing.edges, finer.edges))
    columns = np.stack([np.interp(finer.arc.phi, arc.phi, strip) for strip in T.T], axis=1)
    return np.stack([np.interp(new, middle, row) for row in columns])
