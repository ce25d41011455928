"""The matrix of the film equations in banded form, and its solution where the film bears pressure."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from templates.core.arrays import Array, Mask
from templates.physics.films.film_equations import Equations, dual_widths


@dataclass(frozen=True)
class Banded:
    """The symmetric matrix A of the unknown nodes, lower bands; the axial index runs fastest."""

    bands: Array
    """(bandwidth + 1, unknowns)."""
    order: NDArray[np.intp]
    """The rows of nodes around the bearing in the order of their unknowns."""
    shape: tuple[int, int]
    """Shape of the node arrays, fixed nodes included."""

    @cached_property
    def couplings(self) -> NDArray[np.intp]:
        """Distances from the diagonal of bands that are not empty; factors fill the others."""
        return np.flatnonzero(self.bands[1:].any(axis=1)) + 1

    def solve(self, inside: Mask, b: Array) -> Array:
        """Solve A P = b at the nodes inside and P = 0 at the others.

        Parameters
        ----------
        inside
            (n + 1, m + 1) the nodes of the film.
        b
            (n + 1, m + 1, ...) right-hand sides.

        Returns
        -------
        P like b.
        """
        film = inside[self.order, :-1].ravel()
        count = int(film.nonzero()[0][-1]) + 1 if film.any() else 0
        P = np.zeros(b.shape)
        if count:
            right = b[self.order, :-1].reshape(film.size, -1)[:count]
            unknowns = np.zeros((film.size, right.shape[1]))
            unknowns[:count] = _solve_masked(self.bands[:, :count], self.couplings, film[:count], right)
            P[self.order, :-1] = unknowns.reshape(P[self.order, :-1].shape)
        return P


def _solve_masked(bands: Array, couplings: NDArray[np.intp], film: Mask, right: Array) -> Array:
    """Solve with the rows and columns outside the film replaced by those of the unit matrix."""
    inside = np.zeros_like(bands, order="F")  # as LAPACK has it: another order would be copied
    inside[0] = np.where(film, bands[0], 1.0)
    for offset in couplings[couplings < film.size]:
        end = film.size - offset
        inside[offset, :end] = bands[offset, :end] * (film[:end] & film[offset:])
    solution = solveh_banded(
        inside, right * film[:, None], overwrite_ab=True, overwrite_b=True, lower=True, check_finite=False
    )
    return np.asarray(solution)


def banded(equations: Equations) -> Banded:
    """Order the unknowns and fill the bands."""
    n, m = equations.around.size, equations.zeta.size - 1
    order = _ring_order(n) if equations.ring else np.arange(1, n)
    bands = np.zeros(((2 if equations.ring else 1) * m + 1, order.size * m))
    bands[0] = equations.diagonal()[order, :-1].ravel()
    axial = -equations.across[order, None] / np.diff(equations.zeta)
    if equations.ring:
        axial[0] -= equations.across[-1] / np.diff(equations.zeta)
    axial[:, -1] = 0
    bands[1] = axial.ravel()
    _couple_around(bands, order, equations)
    return Banded(bands, order, (n + 1, m + 1))


def _couple_around(bands: Array, order: NDArray[np.intp], equations: Equations) -> None:
    """Enter the conductance between neighbours around at the distance of their unknowns."""
    n, m = equations.around.size, equations.zeta.size - 1
    rank = np.full(n + 1, -1)
    rank[order] = np.arange(order.size)
    if equations.ring:
        rank[-1] = rank[0]
    here, there = rank[:-1], rank[1:]
    both = (here >= 0) & (there >= 0)
    first, distance = np.minimum(here, there)[both], np.abs(here - there)[both]
    flow = equations.around[both, None] * dual_widths(equations.zeta)[:-1]
    bands[distance[:, None] * m, first[:, None] * m + np.arange(m)] -= flow


def _ring_order(n: int) -> NDArray[np.intp]:
    """Rows 0, 1, n − 1, 2, n − 2 …: neighbours on the ring are at most two apart."""
    order = np.zeros(n, np.intp)
    order[1::2] = np.arange(1, n // 2 + 1)
    order[2::2] = np.arange(n - 1, n // 2, -1)
    return order
