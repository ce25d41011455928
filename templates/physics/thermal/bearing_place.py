"""Position of a journal in a film of given, varying viscosity, by Newton's method with few film solutions.

The unknown is y, a vector along and ahead of the load with length atanh(eps), so that near the wall a step of
1 changes the force by the order of the load. The residuals are the logarithm of force over load and the angle
of the force from the load, which depend on y almost linearly. The first slopes come from differences, later
ones from Broyden's update.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.thermal.arc import Arc
from templates.physics.thermal.pressure import Gap, PressureSolution, gap_of, pressed

FARTHEST = float(np.arctanh(0.9999))
"""Largest length of y in the search."""
_STEPS = 40
_LONGEST = 0.7
_DIFFERENCE = 1e-5
_NOISE = 1e-6
"""Accepted residual where no step reduces it further: the films are not solved more accurately."""
_HALVINGS = 8
_STALE = 0.3
"""After a step that leaves more than this fraction of the residual, the slopes are computed again."""


class NoBalance(ArithmeticError):
    """No film was found that carries the load, or none whose heat is removed."""


class PositionSearch:
    """The search on one mesh; it keeps the last film and the slopes for the next search.

    Parameters
    ----------
    arc
        The mesh.
    edges
        (J + 1,) edges of the strips across.
    load
        So with the viscosity of the supply [-].
    feed
        P_s of the groove and its length over the width [-].
    y
        (2,) initial position; after a search, the final position.
    """

    def __init__(self, arc: Arc, edges: Array, load: float, feed: tuple[float, float], y: Array) -> None:
        self.arc, self.edges, self.load, self.feed, self.y = arc, edges, load, feed, y
        self.near: tuple[Array, Array] | None = None
        self.slopes: Array | None = None

    def placed(self, fluidity: Array, accuracy: float) -> PressureSolution:
        """Return the film that carries the load with a fluidity (n + 1, J).

        Raises
        ------
        NoBalance
            If there is none, or the search does not converge.
        """
        film = self._film(fluidity, self.y)
        lack, fresh = self._lack(film), False
        for _ in range(_STEPS):
            size = float(np.hypot(*lack))
            if size < accuracy:
                return film
            if self.slopes is None:
                self.slopes, fresh = self._differences(fluidity, lack), True
            nearer = self._nearer(fluidity, self._newton(lack), size, _HALVINGS if fresh else 1)
            if nearer is None:
                if size < _NOISE:
                    return self._film(fluidity, self.y)
                if fresh:
                    raise NoBalance("no trial position of the journal supports more of the load")
                self.slopes = None
                continue
            y, film, after = nearer
            step = y - self.y
            change = after - lack - self.slopes @ step
            self.slopes, fresh = self.slopes + np.outer(change, step) / (step @ step), False
            if np.hypot(*after) > _STALE * size:
                self.slopes = None
            self.y, lack = y, after
        raise NoBalance("the journal's position does not converge")

    def _nearer(
        self, fluidity: Array, step: Array, size: float, tries: int
    ) -> tuple[Array, PressureSolution, Array] | None:
        """Return the position and its film after a step, which is halved until the residual decreases."""
        for _ in range(tries):
            y = self.y + step
            if np.hypot(*y) < FARTHEST:
                film = self._film(fluidity, y)
                after = self._lack(film)
                if np.hypot(*after) < size:
                    return y, film, after
            step = step / 2
        return None

    def _newton(self, lack: Array) -> Array:
        """Return the Newton step of y."""
        step = -np.linalg.lstsq(np.asarray(self.slopes), lack, rcond=1e-12)[0]
        size = float(np.hypot(*step))
        if not size > 0:
            raise NoBalance("the force does not depend on the journal's position")
        return np.asarray(step * min(1.0, _LONGEST / size))

    def _film(self, fluidity: Array, y: Array) -> PressureSolution:
        """Return the film at a position; it is stored as the initial guess of the next one."""
        gap: Gap = gap_of(self.arc, y, fluidity, self.edges, self.feed)
        try:
            film = pressed(gap, self.near)
        except (ArithmeticError, RuntimeError) as failure:
            if self.near is None:
                raise NoBalance("the cavities do not converge") from failure
            self.near = None
            return self._film(fluidity, y)
        self.near = film.P, film.void
        return film

    def _lack(self, film: PressureSolution) -> Array:
        """Return the logarithm of force over load, and the angle between them."""
        along, ahead = film.force
        size = float(np.hypot(along, ahead))
        if not (np.isfinite(size) and size > 0):
            raise NoBalance("the film supports no load")
        return np.array([np.log(size / self.load), np.arctan2(ahead, along)])

    def _differences(self, fluidity: Array, lack: Array) -> Array:
        """Return the (2, 2) derivatives of the residuals by finite differences."""
        kept = self.near
        columns = []
        for step in _DIFFERENCE * np.eye(2):
            columns.append((self._lack(self._film(fluidity, self.y + step)) - lack) / _DIFFERENCE)
            self.near = kept
        return np.stack(columns, axis=1)
