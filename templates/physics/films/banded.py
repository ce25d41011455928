"""The matrix of the film equations in banded form, and its solution where the film bears pressure."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.linalg.lapack import dpbtrf, dpbtrs

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
        """Distances from the diagonal of bands that need not be empty; factors fill the others."""
        return np.unique([1, self.shape[1] - 1, len(self.bands) - 1])

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
            unknowns[:count] = _solve_masked(self.masked(film[:count], 0), film[:count], right)
            P[self.order, :-1] = unknowns.reshape(P[self.order, :-1].shape)
        return P

    def masked(self, film: Mask, start: int) -> Array:
        """The bands from an unknown on; rows and columns outside the film are those of the unit matrix."""
        bands, inside = self.bands[:, start : film.size], film[start:]
        result = np.zeros_like(bands, order="F")  # as LAPACK has it: another order would be copied
        result[0] = np.where(inside, bands[0], 1.0)
        for offset in self.couplings[self.couplings < inside.size]:
            end = inside.size - offset
            result[offset, :end] = bands[offset, :end] * (inside[:end] & inside[offset:])
        return result


def _solve_masked(inside: Array, film: Mask, right: Array) -> Array:
    solution = solveh_banded(
        inside, right * film[:, None], overwrite_ab=True, overwrite_b=True, lower=True, check_finite=False
    )
    return np.asarray(solution)


class Resumed:
    """Solutions on one film after another, each factorised from where it differs from the one before.

    The unknowns run in the sense of rotation, and films differ where they rupture: near the end.
    """

    def __init__(self, matrix: Banded) -> None:
        self.matrix = matrix
        self._factors = np.zeros_like(matrix.bands, order="F")
        self._film = np.zeros(0, bool)  # up to its last unknown; what is beyond is not factorised

    def solve(self, inside: Mask, b: Array) -> Array:
        """Solve A P = b (n + 1, m + 1) at the nodes inside and P = 0 at the others.

        Raises
        ------
        ArithmeticError
            If the matrix is not positive definite.
        """
        order = self.matrix.order
        film = inside[order, :-1].ravel()
        unknowns = np.zeros(film.size)
        if film.any():
            count = int(film.nonzero()[0][-1]) + 1
            self._factorise(film[:count])
            right = b[order, :-1].ravel()[:count] * film[:count]
            unknowns[:count] = dpbtrs(self._factors[:, :count], right, lower=1)[0]
        P = np.zeros(b.shape)
        P[order, :-1] = unknowns.reshape(order.size, -1)
        return P

    def _factorise(self, film: Mask) -> None:
        band, shared = len(self._factors) - 1, min(film.size, self._film.size)
        differs = film[:shared] != self._film[:shared]
        first = int(differs.argmax()) if differs.any() else shared
        start = first - band if first >= 2 * band else 0  # a column reaches as far as the band is wide
        rest = self.matrix.masked(film, start)
        if start:
            row, column = _lower(min(band, film.size - start))
            rest[row - column, column] -= self._brought(start, band)[row, column]
        factors, failed = dpbtrf(rest, lower=1, overwrite_ab=1)
        if failed:
            raise ArithmeticError("the film's matrix is not positive definite")
        self._factors[:, start : film.size] = factors
        self._film = film

    def _brought(self, start: int, band: int) -> Array:
        """What factors before an unknown take from the matrix of it and those after it, (band, band)."""
        column, row = _lower(band)
        beside = np.zeros((band, band))
        beside[row, column] = self._factors[row - column + band, start - band + column]
        return np.asarray(beside @ beside.T)


@cache
def _lower(size: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the lower triangle of a matrix."""
    row, column = np.tril_indices(size)
    return row, column


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
