r"""Mass-conserving film rupture and re-formation (Jakobsson, Floberg, Olsson; Elrod, Adams).

.. math::
    \nabla\cdot(H^3\nabla P) = 6\,\partial_x\left[(1-\lambda) H\right],\quad
    P \ge 0,\ \lambda \ge 0,\ P\lambda = 0

P is the pressure above the cavity pressure, lambda the void fraction. The transport of oil by shear is
discretised upwind. The equations are solved by the Fischer–Burmeister–Newton–Schur method: the
complementarity condition becomes the equation P + lambda = sqrt(P² + lambda²), and Newton's method solves for
both unknowns at once. At every node the unknown on which this equation depends more strongly is eliminated,
which leaves one sparse system.

References
----------
T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58:18, 2015;
H. G. Elrod, Trans. ASME J. Lubr. Technol. 103, 1981, p. 350.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from templates.core.arrays import Array, Mask
from templates.physics.cavities.scaled_sum import ColumnScaledSum

_MOST_STEPS = 200
_ACCURACY = 1e-11
_DAMPING = 1e-10
"""Fraction of the diagonal that is added; otherwise a ring of cavities alone would leave its void
undetermined.
"""


@dataclass(frozen=True)
class Network:
    """The flow balance at nodes: A P + T fill = 0 where the pressure is unknown."""

    A: csc_array
    """(N, N) outflow of a node due to pressure, per unit of pressure."""
    T: csc_array
    """(N, N) outflow of a node due to shear, per fill of the upstream node."""
    fixed: Mask
    """(N,) nodes at a given pressure, which are full."""
    P_fixed: Array
    """(N,) the given pressures; ignored at the other nodes."""

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Return the indices of nodes with unknown pressure, from the end of the longest run of fixed ones.

        In this order neighbouring nodes have close indices even if a groove is as long as the bearing is
        wide.
        """
        count = self.fixed.size
        around = np.arange(2 * count)
        last_free = np.maximum.accumulate(np.where(np.tile(self.fixed, 2), -1, around))
        end = int((around - last_free).argmax())
        order = (end + 1 + around[:count]) % count
        return np.asarray(order[~self.fixed[order]], np.intp)

    def loss(self, P: Array, void: Array) -> Array:
        """Return the net outflow of each node.

        It is 0 where flows balance; at fixed nodes it is minus the inflow from outside.
        """
        return np.asarray(self.A @ P + self.T @ (1 - void))


@dataclass(frozen=True)
class Cavitation:
    """A solved film with cavities."""

    P: Array
    """(N,) pressure above that of the cavity."""
    void: Array
    """(N,) fraction of the gap without oil."""
    steps: int
    """Newton steps."""
    imbalance: float
    """Largest residual of a node's flow balance, over the largest flow between nodes."""


def cavitation(network: Network, start: tuple[Array, Array] | None = None) -> Cavitation:
    """Return the pressure and void of a film with mass-conserving cavities.

    Parameters
    ----------
    network
        The flow balances.
    start
        Pressure and void of a nearby film; a re-formation front moves about one node per step.

    Raises
    ------
    ArithmeticError
        If Newton's method has not converged after 200 steps.
    """
    free = network.free
    slopes = ColumnScaledSum.of(network.A, network.T).among(free)
    scale = slopes.diagonals()
    P, void = start if start is not None else np.zeros((2, network.fixed.size))
    P, void = np.where(network.fixed, network.P_fixed, P), np.where(network.fixed, 0.0, void)
    flow = max(float(np.abs(network.T.data).max()), float(np.abs(network.A @ P).max()))
    for step in range(1, _MOST_STEPS):
        loss = network.loss(P, void)[free]
        pair = scale * np.stack([P[free], void[free]])
        fischer = pair.sum(axis=0) - np.hypot(*pair)
        worst = float(np.abs(loss).max())
        if max(worst, np.abs(fischer).max()) < _ACCURACY * flow:
            P[free], void[free] = np.where(pair[0] >= pair[1], pair * [[1], [0]], pair * [[0], [1]]) / scale
            return Cavitation(P, void, step, float(np.abs(network.loss(P, void)[free]).max()) / flow)
        P[free], void[free] = (pair + _newton_step(slopes, scale, loss, pair, fischer)) / scale
    raise ArithmeticError("the cavities' extent did not converge")


def _newton_step(slopes: ColumnScaledSum, scale: Array, loss: Array, pair: Array, fischer: Array) -> Array:
    """Return the changes of pressure and void times their scale, (2, N).

    They solve loss + A dP − T dvoid = 0 together with the linearised complementarity condition. In the full
    film dvoid is eliminated, in the cavity dP, so that the larger of the two slopes is the divisor.
    """
    full = pair[0] >= pair[1]
    dependence = 1 - pair / np.maximum(np.hypot(*pair), np.finfo(float).tiny)
    ratio, rest = dependence.min(axis=0) / dependence.max(axis=0), -fischer / dependence.max(axis=0)
    brought = np.stack([np.where(full, 0, -rest), np.where(full, rest, 0)]) / scale
    right = slopes.times(*brought) - loss
    by_P, by_void = np.stack([np.where(full, 1, -ratio), np.where(full, ratio, -1)]) / scale
    kept = slopes.factorised(by_P, by_void, np.where(full, _DAMPING, -_DAMPING))(right)
    eliminated = rest - ratio * kept
    return np.where(full, [kept, eliminated], [eliminated, kept])
