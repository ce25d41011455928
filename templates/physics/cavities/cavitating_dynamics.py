"""Linear stiffness and damping of a film with mass-conserving cavities, by perturbing its discrete equations.

The set of full nodes is held constant. In full nodes the pressure follows the change of the gap, in the
others the void fraction does; a re-formation front therefore moves with the oil that reaches it. The damping
applies to slow motion: the oil stored in cavities follows the displacement, so its rate of change is
proportional to the velocity. Grooves are stationary.

Axes and scales are those of `film_dynamics`, but with psi²/(B D eta omega_h) in place of the load, so that
the coefficients stay finite as the load vanishes.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities.cavitating_film import RingSolution, force
from templates.physics.cavities.cavitating_network import perturbed_flows
from templates.physics.cavities.scaled_sum import ColumnScaledSum
from templates.physics.films.film_equations import midpoints
from templates.physics.films.film_mesh import gap

_DAMPING = 1e-10
"""Fraction of the diagonal that is added; otherwise a ring of cavities alone would leave its void
undetermined.
"""


@dataclass(frozen=True)
class LinearFilm:
    """The force of a film and its derivatives, along and ahead of the line of centres, in units of So."""

    force: Array
    """Force, (2,)."""
    K: Array
    """Stiffness, (2, 2), per displacement over the radial clearance."""
    B: Array
    """Damping, (2, 2), per velocity over omega_h times the radial clearance."""

    def turned(self, attitude: float) -> "LinearFilm":
        """Return the same values in axes x, y; the line of centres lies ahead of x by the attitude [rad]."""
        cos, sin = np.cos(attitude), np.sin(attitude)
        turn = np.array([[cos, -sin], [sin, cos]])
        return LinearFilm(turn @ self.force, turn @ self.K @ turn.T, turn @ self.B @ turn.T)


def linear_film(film: RingSolution) -> LinearFilm:
    """Return the force, stiffness and damping of a solved film."""
    ring, P, fill = film.ring, film.solution.P, 1 - film.solution.void
    phi, middle = ring.phi, midpoints(ring.phi)
    respond, storage = _response(film), 12 * ring.cells()
    H = np.repeat(gap(phi[:-1], ring.eps), ring.zeta.size)
    columns = []
    for shape in (np.cos, np.sin):
        dA, dT = perturbed_flows(ring, -shape(phi), -shape(middle))
        dP, dvoid = respond(dA @ P + dT @ fill)
        stored = -np.repeat(shape(phi[:-1]), ring.zeta.size) * fill - H * dvoid
        columns += [force(ring, dP), force(ring, respond(storage * stored)[0])]
    return LinearFilm(force(ring, P), np.array(columns[::2]).T, np.array(columns[1::2]).T)


def _response(film: RingSolution) -> Callable[[Array], tuple[Array, Array]]:
    """Return a function that computes how pressure and void change to balance a loss of oil at the nodes."""
    network, free = film.network, film.network.free
    full = film.solution.void == 0
    slopes, is_full = ColumnScaledSum.of(network.A, network.T).among(free), full[free]
    by_pressure, by_shear = np.abs(slopes.diagonals())
    damping = _DAMPING * np.where(is_full, by_pressure, -by_shear)
    solve = slopes.factorised(is_full * 1.0, is_full - 1.0, damping)

    def respond(loss: Array) -> tuple[Array, Array]:
        change = np.zeros(full.size)
        change[free] = solve(-loss[free])
        return np.where(full, change, 0.0), np.where(full, 0.0, change)

    return respond
