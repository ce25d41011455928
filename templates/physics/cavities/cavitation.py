r"""Mass-conserving film rupture and re-formation (Jakobsson, Floberg, Olsson; Elrod, Adams).

.. math::
    \nabla\cdot(H^3\nabla P) = 6\,\partial_x\left[(1-\lambda) H\right],\quad
    P \ge 0,\ \lambda \ge 0,\ P\lambda = 0

P is the pressure above that of the cavity, lambda the void. Shear carries what oil there is: upwind.
Solved by the Fischer–Burmeister–Newton–Schur method: the complementarity becomes the equation
P + lambda = sqrt(P² + lambda²), Newton's method takes both at once, and at every node the unknown
on which this equation depends more is eliminated, which leaves one sparse system.

References
----------
T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58:18, 2015;
H. G. Elrod, Trans. ASME J. Lubr. Technol. 103, 1981, p. 350.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from templates.core.arrays import Array, Mask
from templates.physics.cavities.column_scaled import ColumnScaledSum

_MOST_STEPS = 200
_ACCURACY = 1e-11
_DAMPING = 1e-10
"""Share of the diagonal added: a ring of cavities alone would leave its void undetermined."""

_SYMMETRIC = {"SymmetricMode": True}
"""The pattern nearly is: its own ordering is cheaper and fills less than that of its square."""


@dataclass(frozen=True)
class Network:
    """Balance of flow at nodes: A P + T fill = 0 where the pressure is unknown."""

    A: csc_array
    """(N, N) what a node loses by pressure, per pressure."""
    T: csc_array
    """(N, N) what a node loses by shear, per fill of the node from which it comes."""
    fixed: Mask
    """(N,) nodes at a given pressure, which are full."""
    P_fixed: Array
    """(N,) that pressure; of no account elsewhere."""

    def loss(self, P: Array, void: Array) -> Array:
        """What each node loses: 0 where the balance holds, −inflow from outside at fixed nodes."""
        return np.asarray(self.A @ P + self.T @ (1 - void))


@dataclass(frozen=True)
class Cavitation:
    """A solved film with cavities."""

    P: Array
    """(N,) pressure above that of the cavity."""
    void: Array
    """(N,) share of the gap without oil."""
    steps: int
    """Newton steps."""
    imbalance: float
    """Largest loss at a node whose balance should hold, over the largest flow between nodes."""


def cavitation(network: Network, start: tuple[Array, Array] | None = None) -> Cavitation:
    """Solve for pressure and void.

    Parameters
    ----------
    network
        Balances of flow.
    start
        Pressure and void of a nearby film; a re-formation front moves about one node a step.

    Raises
    ------
    ArithmeticError
        If Newton's method has not converged after 200 steps.
    """
    free = ~network.fixed
    A, T = network.A[free][:, free], network.T[free][:, free]
    scale = np.stack([A.diagonal(), T.diagonal()])
    by_P, by_void = csc_array(A / scale[0]), csc_array(T / scale[1])
    slopes = ColumnScaledSum.of(by_P, by_void)
    P, void = start if start is not None else (np.zeros(free.size), np.zeros(free.size))
    P, void = np.where(free, P, network.P_fixed), np.where(free, void, 0.0)
    flow = max(float(np.abs(network.T.data).max()), float(np.abs(network.A @ P).max()))
    for step in range(1, _MOST_STEPS):
        loss = network.loss(P, void)[free]
        pair = scale * np.stack([P[free], void[free]])
        fischer = pair.sum(axis=0) - np.hypot(*pair)
        worst = float(np.abs(loss).max())
        if max(worst, np.abs(fischer).max()) < _ACCURACY * flow:
            P[free], void[free] = np.where(pair[0] >= pair[1], pair * [[1], [0]], pair * [[0], [1]]) / scale
            return Cavitation(P, void, step, float(np.abs(network.loss(P, void)[free]).max()) / flow)
        P[free], void[free] = (pair + _newton_step(slopes, by_P, by_void, loss, pair, fischer)) / scale
    raise ArithmeticError("the cavities' extent did not settle")


def _newton_step(
    slopes: ColumnScaledSum, by_P: csc_array, by_void: csc_array, loss: Array, pair: Array, fischer: Array
) -> Array:
    """Changes of pressure and void, (2, N), from loss + A dP − T dvoid = 0 and the changed complementarity.

    Where the film is full dvoid is eliminated, in the cavity dP: the larger slope divides.
    """
    full = pair[0] >= pair[1]
    dependence = 1 - pair / np.maximum(np.hypot(*pair), np.finfo(float).tiny)
    ratio, rest = dependence.min(axis=0) / dependence.max(axis=0), -fischer / dependence.max(axis=0)
    matrix = slopes.scaled(
        np.where(full, 1, -ratio), np.where(full, ratio, -1), np.where(full, _DAMPING, -_DAMPING)
    )
    right = -loss - by_P @ np.where(full, 0, rest) + by_void @ np.where(full, rest, 0)
    kept = splu(matrix, "MMD_AT_PLUS_A", relax=4, panel_size=1, options=_SYMMETRIC).solve(right)
    eliminated = rest - ratio * kept
    return np.where(full, [kept, eliminated], [eliminated, kept])
