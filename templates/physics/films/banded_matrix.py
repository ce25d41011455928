"""The matrix of the film equations in banded form, and its solution at the nodes of the film."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpbtrf, dpbtrs

from templates.core.arrays import Array, Mask
from templates.physics.films.film_equations import Equations


@dataclass(frozen=True)
class BandedMatrix:
    """The symmetric matrix A of the unknown nodes, by its lower diagonals; axial index fastest."""

    diagonals: Array
    """(diagonals, unknowns): each diagonal starts at the first unknown; those between are empty."""
    offsets: tuple[int, ...]
    """Distances of the diagonals from the main one, ascending from 0; the last is the bandwidth."""
    order: NDArray[np.intp]
    """The circumferential rows of nodes in the order of their unknowns."""
    shape: tuple[int, int]
    """Shape of the node arrays, fixed nodes included."""

    def solve(self, inside: Mask, b: Array) -> Array:
        """Solve A P = b at the nodes inside the film; P = 0 at the others.

        Parameters
        ----------
        inside
            (n + 1, m + 1) mask of the nodes of the film.
        b
            (n + 1, m + 1, ...) right-hand sides.

        Returns
        -------
        P, in the shape of b.

        Raises
        ------
        ArithmeticError
            If the matrix is not positive definite.
        """
        return IncrementalSolver(self).solve(inside, b)

    def write(self, bands: Array, film: Mask, start: int) -> None:
        """Write the bands, starting at an unknown; outside the film they are those of the unit matrix.

        Parameters
        ----------
        bands
            (bandwidth + 1, film.size - start) the array that is written.
        film
            Mask of the unknowns inside the film, from the first to the last one used.
        start
            The first unknown to write.
        """
        inside, diagonals = film[start:], self.diagonals[:, start : film.size]
        bands[:] = 0
        bands[0] = np.where(inside, diagonals[0], 1.0)
        for offset, diagonal in zip(self.offsets[1:], diagonals[1:], strict=True):
            end = inside.size - offset
            if end > 0:
                np.multiply(diagonal[:end], inside[:end] & inside[offset:], out=bands[offset, :end])


class IncrementalSolver:
    """Solver for successive films; each is refactorised only from where it differs from the previous one.

    The unknowns are ordered in the sense of rotation, and films differ at rupture, which is near the end.
    """

    def __init__(self, matrix: BandedMatrix) -> None:
        self.matrix = matrix
        shape = matrix.offsets[-1] + 1, matrix.diagonals.shape[1]
        self._factors = np.empty(shape, order="F")  # LAPACK's memory order, which avoids a copy
        self._film = np.zeros(0, bool)  # up to its last unknown; the rest is not factorised

    def solve(self, inside: Mask, b: Array) -> Array:
        """Solve A P = b (n + 1, m + 1, ...) at the nodes inside the film; P = 0 at the others.

        Raises
        ------
        ArithmeticError
            If the matrix is not positive definite.
        """
        order = self.matrix.order
        film = inside[order, :-1].ravel()
        P = np.zeros(b.shape)
        if film.any():
            count = film.size - int(film[::-1].argmax())
            self._factorise(film[:count])
            right = b[order, :-1].reshape(film.size, -1)
            unknowns = np.zeros(right.shape)
            right = right[:count] * film[:count, None]
            unknowns[:count] = dpbtrs(self._factors[:, :count], right, lower=1, overwrite_b=1)[0]
            P[order, :-1] = unknowns.reshape(order.size, -1, *b.shape[2:])
        return P

    def _factorise(self, film: Mask) -> None:
        band, shared = len(self._factors) - 1, min(film.size, self._film.size)
        differs = film[:shared] != self._film[:shared]
        first = int(differs.argmax()) if differs.any() else shared
        start = first - band if first >= 2 * band else 0  # a column extends over one bandwidth
        rest = self._factors[:, start : film.size]
        self.matrix.write(rest, film, start)
        if start:
            row, column = _lower(min(band, film.size - start))
            rest[row - column, column] -= self._brought(start, band)[row, column]
        rest[:], failed = dpbtrf(rest, lower=1, overwrite_ab=1)
        if failed:
            raise ArithmeticError("the film's matrix is not positive definite")
        self._film = film

    def _brought(self, start: int, band: int) -> Array:
        """Return the update of the trailing block by the earlier factors, (band, band)."""
        column, row = _lower(band)
        beside = np.zeros((band, band))
        beside[row, column] = self._factors[row - column + band, start - band + column]
        return np.asarray(beside @ beside.T)


@cache
def _lower(size: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows and columns of the lower triangle of a matrix."""
    row, column = np.tril_indices(size)
    return row, column


def banded(equations: Equations) -> BandedMatrix:
    """Return the matrix of the ordered unknowns in banded form."""
    n, m = equations.around.size, equations.zeta.size - 1
    order = _ring_order(n) if equations.ring else np.arange(1, n)
    offsets = (0, 1, m, 2 * m) if equations.ring else (0, 1, m)
    diagonals = np.zeros((len(offsets), order.size * m))
    diagonals[0] = equations.diagonal()[order, :-1].ravel()
    axial = -equations.conductance_across[order]
    if equations.ring:
        axial[0] -= equations.conductance_across[-1]
    axial[:, -1] = 0
    diagonals[1] = axial.ravel()
    around = equations.conductance_around[:, :-1]
    if equations.ring:
        _couple_ring(diagonals[2:], order, around)
    else:
        diagonals[2, : (n - 2) * m] = -around[1:-1].ravel()
    return BandedMatrix(diagonals, offsets, order, (n + 1, m + 1))


def _couple_ring(diagonals: Array, order: NDArray[np.intp], around: Array) -> None:
    """Enter the conductances between ring neighbours, which are one or two rows apart, (2, unknowns)."""
    n, m = around.shape
    rank = np.zeros(n + 1, np.intp)
    rank[order] = np.arange(order.size)
    rank[-1] = rank[0]
    first, distance = np.minimum(rank[:-1], rank[1:]), np.abs(np.diff(rank))
    diagonals[distance[:, None] - 1, first[:, None] * m + np.arange(m)] -= around


def _ring_order(n: int) -> NDArray[np.intp]:
    """Return the rows in the order 0, 1, n − 1, 2, n − 2 …, with ring neighbours at most two apart."""
    order = np.zeros(n, np.intp)
    order[1::2] = np.arange(1, n // 2 + 1)
    order[2::2] = np.arange(n - 1, n // 2, -1)
    return order
