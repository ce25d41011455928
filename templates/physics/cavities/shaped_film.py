"""A film with a given gap, solved with either rupture condition: force, couple, stiffness and damping.

With `swift_stieber` the film ruptures where pressure and pressure gradient vanish, and re-forms wherever
motion brings oil. With `conserving` it ruptures and re-forms as mass conservation requires (`cavitation`).
Everything is dimensionless as in `cavitating_film`; axes: x along the load, y ahead of it in the sense of
rotation.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import splu

from templates.core.arrays import Array, Mask
from templates.physics.cavities.cavitation import Cavitation, Network, cavitation
from templates.physics.cavities.shaped_network import (
    FULL_TURN,
    Gaps,
    Nodes,
    Pocket,
    displaced,
    fed,
    gaps,
    network,
    perturbed,
)
from templates.physics.films.film_shape import Bore, Lie, directions

_MOST_STEPS = 200
_DAMPING = 1e-10
"""Fraction of the diagonal that is added; otherwise a ring of cavities alone would leave its void
undetermined.
"""


@dataclass(frozen=True)
class ShapedFilm:
    """A solved film."""

    nodes: Nodes
    H: Gaps
    network: Network
    fed: Mask
    """(n, m + 1) nodes that pockets feed."""
    conserving: bool
    """Whether cavities conserve mass."""
    solution: Cavitation

    @cached_property
    def P(self) -> Array:
        """Return the (n, m + 1) pressure above ambient."""
        return self.solution.P.reshape(self.nodes.shape)

    @cached_property
    def void(self) -> Array:
        """Return the (n, m + 1) fraction of the gap without oil; 0 with Swift–Stieber rupture."""
        return self.solution.void.reshape(self.nodes.shape)

    @cached_property
    def force(self) -> Array:
        """Return the (2,) force along and ahead of the load, in units of So."""
        return self.borne(self.P)

    def borne(self, P: Array) -> Array:
        """Return the force that a pressure field exerts on the journal."""
        return np.asarray(directions(self.nodes.phi[:-1]) @ (P * self.nodes.weight).sum(axis=1))

    @cached_property
    def couple(self) -> Array:
        """Return the moments in the planes of the axis and x or y, (2,), over the force of So times B/2.

        They are taken about the middle, and are positive if the film pushes the end zeta = 1 against x or y,
        that is, against a positive tilt.
        """
        if self.nodes.is_half:
            return np.zeros(2)
        return np.asarray(directions(self.nodes.phi[:-1]) @ (self.P * self.nodes.weight) @ self.nodes.zeta)

    @cached_property
    def shear(self) -> float:
        """Return the shear force on the journal over the full circle; in cavities only the oil is sheared."""
        fill = 1 - self.void
        return float((fill / self.H.nodes * self.nodes.weight).sum())

    @cached_property
    def load_couple(self) -> float:
        """Return the friction on the journal due to pressure, from half of ∬ H dP.

        In a plain bearing it is So eps sin(attitude)/2, the couple of load and reaction.
        """
        rise = np.roll(self.P, -1, axis=0) - self.P
        return float((self.H.around * rise * self.nodes.across).sum() / (4 if self.nodes.is_half else 8))

    @cached_property
    def side_flow(self) -> float:
        """Return the oil flow out of both ends, except that directly from a pocket, Q/(R³ psi omega_h)."""
        loss = self.network.loss(self.solution.P, self.solution.void).reshape(self.nodes.shape)
        ends = [-1] if self.nodes.is_half else [0, -1]
        out = -sum(loss[:, end][~self.fed[:, end]].sum() for end in ends)
        return float(out * self.nodes.ratio / (6 if self.nodes.is_half else 12))

    @cached_property
    def peak(self) -> tuple[float, float]:
        """Return the largest pressure and its angle from the load [rad], from a parabola around it."""
        i, j = np.unravel_index(self.P.argmax(), self.P.shape)
        n = self.nodes.shape[0]
        phi, column = self.nodes.phi[:-1], self.P[:, j]
        x = (phi[[i - 1, (i + 1) % n]] - phi[i] + np.pi) % FULL_TURN - np.pi
        before, top, after = column[i - 1] - column[i], column[i], column[(i + 1) % n] - column[i]
        bend = (after / x[1] - before / x[0]) / (x[1] - x[0])
        slope = before / x[0] - bend * x[0]
        aside = -slope / (2 * bend) if bend < 0 else 0.0
        return float(top + (slope + bend * aside) * aside), float(phi[i] + aside)

    @cached_property
    def linear(self) -> tuple[Array, Array]:
        """Return stiffness and damping in units of So per displacement/c and per velocity/(c omega_h)."""
        P, fill = self.solution.P, 1 - self.solution.void
        cells = 12 * np.outer(self.nodes.around, self.nodes.across)
        respond = self._response()
        K, B = np.zeros((2, 2)), np.zeros((2, 2))
        for k, change in enumerate(displaced(self.nodes)):
            dA, dT = perturbed(self.nodes, self.H, change)
            dP, dvoid = respond(dA @ P + dT @ fill)
            stored = change.nodes * (1 - self.void) - self.H.nodes * dvoid
            K[:, k] = self.borne(dP)
            B[:, k] = self.borne(respond((cells * stored).ravel())[0])
        return K, B

    def _response(self) -> Callable[[Array], tuple[Array, Array]]:
        """Return a function that computes the changes of pressure and void that balance a loss of oil."""
        free = ~self.network.fixed
        full = self.solution.void == 0 if self.conserving else self.solution.P > 0
        kept = free if self.conserving else free & full
        matrix = csc_array(self.network.A * full - self.network.T * ~full)[kept][:, kept]
        diagonal = _DAMPING * np.abs(matrix.diagonal())
        factors = splu(csc_array(matrix + diags_array(np.where(full[kept], diagonal, -diagonal))))

        def respond(loss: Array) -> tuple[Array, Array]:
            change = np.zeros(free.size)
            change[kept] = factors.solve(-loss[kept])
            parts = np.where(full, change, 0.0), np.where(full, 0.0, change)
            return parts[0].reshape(self.nodes.shape), parts[1].reshape(self.nodes.shape)

        return respond


def shaped_film(
    nodes: Nodes,
    bore: Bore,
    lie: Lie,
    pockets: list[Pocket],
    *,
    conserving: bool,
    start: tuple[Array, Array] | None = None,
) -> ShapedFilm:
    """Return the film at a position of the journal.

    Parameters
    ----------
    nodes
        The mesh.
    bore, lie
        Shape of the bore, and position of the journal, which must not touch the bore anywhere.
    pockets
        The pockets that feed oil.
    conserving
        Whether cavities conserve mass.
    start
        Pressure and void of a nearby film on the same nodes.

    Raises
    ------
    ArithmeticError
        If the extent of film or cavities does not converge, or pockets leave no node between them.
    RuntimeError
        If a matrix is singular.
    """
    H = gaps(nodes, bore, lie)
    P_fixed, inside = fed(nodes, pockets)
    if (P_fixed >= 0).all():
        raise ArithmeticError("pockets cover the whole bearing")
    balances = network(nodes, H, P_fixed)
    solve = cavitation if conserving else ruptured
    return ShapedFilm(nodes, H, balances, inside, conserving, solve(balances, start))


def ruptured(balances: Network, start: tuple[Array, Array] | None = None) -> Cavitation:
    """Return the pressure with Swift–Stieber rupture, by the active-set method of `complementarity`.

    Raises
    ------
    ArithmeticError
        If the active set still changes after 200 steps.
    """
    free = ~balances.fixed
    P = np.where(free, 0.0, balances.P_fixed)
    brought = -(balances.T @ np.ones(free.size)) - balances.A @ P
    film = free & ((start[0] > 0) if start is not None else brought > 0)
    noise = 1e-13 * float(np.abs(brought).max())
    for step in range(1, _MOST_STEPS):
        P[free] = 0.0
        if film.any():
            P[film] = splu(csc_array(balances.A[film][:, film])).solve(brought[film])
        lack = balances.A @ np.where(free, P, 0.0) - brought
        after = free & np.where(film, P > 0, lack < -noise)
        if np.array_equal(after, film):
            return Cavitation(P, np.zeros(free.size), step, 0.0)
        film = after
    raise ArithmeticError("the film's extent did not converge")
