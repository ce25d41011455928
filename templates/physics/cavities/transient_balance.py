"""Flow balances of a moving film on a ring of nodes, and their linear solution: see `transient_film`."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from templates.core.arrays import Array
from templates.physics.films.film_equations import dual_widths
from templates.physics.films.film_mesh import graded_across

Index = NDArray[np.intp]


@dataclass(frozen=True)
class Journal:
    """Mesh and bearing; axial nodes run from the middle and exclude the end, which is at ambient pressure."""

    ratio: float
    """Width over diameter B/D [-]."""
    phi: Array
    """(n,) angles of the nodes [rad]."""
    zeta: Array
    """(m + 1,) axial places of the nodes, 0 (middle) … 1 (end)."""

    def gap(self, eps: Array, phi: Array) -> Array:
        """Return H at angles [-]."""
        return np.asarray(1 - eps[0] * np.cos(phi) - eps[1] * np.sin(phi))

    def load(self, P: Array) -> Array:
        """Return the force of a pressure, F psi²/(B D eta Omega), along the axes of the frame, (2,)."""
        line = P @ dual_widths(self.zeta)[:-1] * np.pi / self.phi.size
        return np.array([np.cos(self.phi), np.sin(self.phi)]) @ line


def transient_mesh(ratio: float, around: int, across: int) -> Journal:
    """Return a uniform ring of nodes, axially graded towards the end of a wide bearing."""
    zeta, _ = graded_across(min(1.0, 0.3 / ratio), across)
    return Journal(ratio, np.arange(around) * 2 * np.pi / around, zeta)


@dataclass(frozen=True)
class Balance:
    """Flows between the nodes at one position of the journal: loss = A P + T fill + before."""

    round: Array
    """(n,) H³/dphi towards the next circumferential node, per unit zeta."""
    across: Array
    """(n, m) conductance towards the next axial node."""
    carried: Array
    """(n,) shear flow 12 w H to the next circumferential node; upwind from this node if positive, else from
    the next.
    """
    stored: Array
    """(n,) oil that a full node stores in a step, per unit zeta."""
    width: Array
    """(m,) axial widths of the cells."""

    def by_pressure(self, P: Array) -> Array:
        """Return A P, (n, m)."""
        flow = self.round[:, None] * self.width * (P - np.roll(P, -1, axis=0))
        axial = self.across * (P - np.pad(P[:, 1:], ((0, 0), (0, 1))))
        return np.asarray(flow - np.roll(flow, 1, axis=0) + axial - np.pad(axial[:, :-1], ((0, 0), (1, 0))))

    def by_fill(self, fill: Array) -> Array:
        """Return T fill, (n, m)."""
        after, ahead = np.maximum(self.carried, 0), np.minimum(self.carried, 0)
        flow = after[:, None] * fill + ahead[:, None] * np.roll(fill, -1, axis=0)
        return np.asarray((flow - np.roll(flow, 1, axis=0) + self.stored[:, None] * fill) * self.width)

    def diagonals(self) -> tuple[Array, Array]:
        """Return the diagonals of A and T, (n, m)."""
        after, ahead = np.maximum(self.carried, 0), np.minimum(self.carried, 0)
        A = (self.round + np.roll(self.round, 1))[:, None] * self.width + self.across
        A[:, 1:] += self.across[:, :-1]
        return A, (after - np.roll(ahead, 1) + self.stored)[:, None] * self.width

    def solve(self, alpha: Array, beta: Array, columns: Array, feed: int) -> Array:
        """Solve (A alpha + T beta) k = columns, with k = 0 at the feed node; k has the shape of columns."""
        n, m = alpha.shape
        rows = _ring_order(n)[:, None] * m + np.arange(m)
        bands = np.zeros((4 * m + 1, n * m))
        for here, there, values in self._couplings(alpha, beta, rows):
            values = np.where(here // m == rows[feed, 0] // m, 0, values)
            bands[2 * m + here - there, there] += values
        bands[2 * m, rows[feed]] = 1
        right = np.zeros((n * m, len(columns)))
        right[rows] = np.moveaxis(np.where(np.arange(n)[:, None] == feed, 0, columns), 0, -1)
        solution = solve_banded((2 * m, 2 * m), bands, right, overwrite_ab=True, check_finite=False)
        return np.moveaxis(solution[rows], -1, 0)

    def _couplings(self, alpha: Array, beta: Array, rows: Index) -> list[tuple[Index, Index, Array]]:
        """Return row, column and value of the entries of A alpha + T beta: diagonal, then neighbours."""
        A, T = self.diagonals()
        after, ahead = np.maximum(self.carried, 0)[:, None], np.minimum(self.carried, 0)[:, None]
        conductance, following = self.round[:, None] * self.width, np.roll(rows, -1, axis=0)
        to_next = ahead * self.width * np.roll(beta, -1, axis=0) - conductance * np.roll(alpha, -1, axis=0)
        from_last = -after * self.width * beta - conductance * alpha
        inner = self.across[:, :-1]
        return [
            (rows, rows, A * alpha + T * beta),
            (rows, following, to_next),
            (following, rows, from_last),
            (rows[:, :-1], rows[:, 1:], -inner * alpha[:, 1:]),
            (rows[:, 1:], rows[:, :-1], -inner * alpha[:, :-1]),
        ]


def balance(journal: Journal, eps: Array, w: float, rate: float) -> Balance:
    """Return the flow balances; `rate` is the first coefficient of the time differences [1/rad]."""
    n, step = journal.phi.size, 2 * np.pi / journal.phi.size
    H, H_mid = journal.gap(eps, journal.phi), journal.gap(eps, journal.phi + step / 2)
    across = np.repeat((H**3 * step / journal.ratio**2)[:, None], journal.zeta.size - 1, axis=1)
    return Balance(
        round=H_mid**3 / step,
        across=across / np.diff(journal.zeta),
        carried=12 * w * H_mid,
        stored=12 * step * rate * H * np.ones(n),
        width=dual_widths(journal.zeta)[:-1],
    )


def _ring_order(n: int) -> Index:
    """Return the ranks of the circumferential rows in the order 0, 1, 3, …, 4, 2.

    In this order neighbouring rows are at most two apart.
    """
    there = np.arange(n)
    return np.where(there <= n // 2, np.maximum(2 * there - 1, 0), 2 * (n - there))
