"""Free torsional vibration of a chain of inertias joined by shafts: natural frequencies and mode shapes.

Used by `torsional_vibration`. The chain is undamped and linear, without branches and gears (refer both sides
to one speed first).

With J the inertias and k the stiffnesses, K phi = omega² J phi. The chain's K is B k Bᵀ, where B forms the
differences of neighbouring angles; so the omega are the singular values of J^(-1/2) B k^(1/2), which is
bidiagonal. They are computed from that matrix and not from K: forming K loses the small frequencies of a
widely scaled train, whereas the entries of a bidiagonal matrix determine each singular value to rounding
(Demmel, Kahan). Over 18 decades of inertias and stiffnesses all frequencies agree with 60-digit arithmetic to
1e-13, and entries of mode shapes to 1e-15 times the square root of the ratio of largest to smallest inertia.

References
----------
H. Holzer: Die Berechnung der Drehschwingungen, 1921, for the chain of inertias.
J. Demmel, W. Kahan: Accurate singular values of bidiagonal matrices. SIAM J. Sci. Stat. Comput. 11, 1990.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units

FREE, FIXED = "free_free", "fixed_free"
MOST_INERTIAS, MOST_ENTRIES = 500, 1_000_000  # per chain; in the mode shapes of all chains
TIE = 1 - 1e-9  # mode-shape entries above this fraction of the largest count as equal to it


@dataclass(frozen=True)
class _Bidiagonal:
    """Diagonal and superdiagonal of a square matrix, and the rotations that produced them (NaN if none)."""

    diagonal: Array
    above: Array
    cosines: Array
    sines: Array

    @property
    def dense(self) -> Array:
        """Return the dense matrix."""
        n = self.diagonal.shape[-1]
        full, i = np.zeros((*self.diagonal.shape, n)), np.arange(n)
        full[..., i, i], full[..., i[:-1], i[1:]] = self.diagonal, self.above
        return full


@units("kg*m**2", "N*m/rad", None, returns="1")
def fits(J: Array, k: Array, ends: str) -> bool:
    """Return whether J [..., inertia] and k [..., spring] form a chain; missing entries are NaN."""
    springs = np.shape(k)[-1] if np.ndim(k) else 0
    return springs == np.shape(J)[-1] - (ends == FREE)


@units("kg*m**2", "N*m/rad", "1", returns="1")
def manageable(J: Array, k: Array, orders: Array) -> bool:
    """Return whether chains [..., inertia] and tables of orders [..., order] are within the size limits."""
    several = np.shape(np.atleast_1d(orders))
    chains = np.broadcast_shapes(np.shape(J)[:-1], np.shape(k)[:-1], several[:-1])
    longest = max(np.shape(J)[-1], several[-1])
    return longest <= MOST_INERTIAS and np.prod(chains, dtype=float) * longest**2 <= MOST_ENTRIES


@on_paper("solved numerically by singular values of the chain's bidiagonal matrix")
@units("kg*m**2", "N*m/rad", None, returns="rad/s", latex=r"\sqrt{{\lambda_m\left({1},{0}\right)}}")
def angular_frequencies(J: Array, k: Array, ends: str) -> Array:
    """Return the natural angular frequencies [rad/s], ascending [..., mode], from J [kg m²] and k [N m/rad].

    With free ends the first is exactly 0, and k[i] joins J[i] and J[i+1]; with a fixed end k[0] joins J[0] to
    the ground and k[i] joins J[i-1] and J[i]. The result is NaN where numbers overflow.
    """
    elastic = _singular_values(_reduced(J, k, ends).dense)
    return _with_rigid(elastic, 0.0, axis=-1) if ends == FREE else elastic


@on_paper("solved numerically by singular values of the chain's bidiagonal matrix")
@units("kg*m**2", "N*m/rad", None, returns="1", latex=r"\varphi_m\left({1},{0}\right)")
def mode_shapes(J: Array, k: Array, ends: str) -> Array:
    """Return the mode shapes [..., mode, inertia], each with 1 as its largest entry."""
    reduced = _reduced(J, k, ends)
    vectors = _left_vectors(reduced.dense)
    if ends == FIXED:
        return _scaled(vectors / np.sqrt(J)[..., None, :])
    elastic = _scaled(_turned_back(reduced, vectors) / np.sqrt(J)[..., None, :])
    return _with_rigid(elastic, 1.0, axis=-2)


def _reduced(J: Array, k: Array, ends: str) -> _Bidiagonal:
    """Return J^(-1/2) B k^(1/2) as a square matrix; with free ends, rotations eliminate its last row."""
    root_J = np.sqrt(J)
    if ends == FIXED:
        root_k = np.sqrt(k)
        return _Bidiagonal(
            root_k / root_J, -root_k[..., 1:] / root_J[..., :-1], np.array(np.nan), np.array(np.nan)
        )
    root_k = np.sqrt(k) if np.ndim(k) else np.empty(0)
    return _turned(root_k / root_J[..., :-1], root_k / root_J[..., 1:])


def _turned(first: Array, second: Array) -> _Bidiagonal:
    """Return the matrix of a chain with free ends; rotations of its rows make it square.

    Column i of the original matrix contains first[i] and, below it, -second[i]. Each rotation multiplies only
    positive numbers, so that no digit is lost.
    """
    diagonal, above, cosines, sines = (np.zeros_like(first) for _ in range(4))
    rest = first[..., :1]
    for i in range(first.shape[-1]):
        here = slice(i, i + 1)
        diagonal[..., here] = radius = np.hypot(rest, second[..., here])
        cosines[..., here], sines[..., here] = rest / radius, second[..., here] / radius
        following = first[..., i + 1 : i + 2]
        above[..., here] = -sines[..., here] * following if following.size else 0.0
        rest = cosines[..., here] * following
    return _Bidiagonal(diagonal, above[..., :-1], cosines, sines)


def _turned_back(turned: _Bidiagonal, vectors: Array) -> Array:
    """Convert vectors [..., mode, row] of the square matrix to those of the chain, with one more row."""
    rows = np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 1))], axis=-1)
    for i in reversed(range(vectors.shape[-1])):
        cosine, sine = turned.cosines[..., i, None], turned.sines[..., i, None]
        upper, lower = rows[..., i].copy(), rows[..., i + 1].copy()
        rows[..., i], rows[..., i + 1] = cosine * upper + sine * lower, cosine * lower - sine * upper
    return rows


def _singular_values(matrix: Array) -> Array:
    """Return the singular values [..., mode] of bidiagonal matrices, ascending.

    They are NaN if an entry is not finite. LAPACK does not change a bidiagonal matrix and, without vectors,
    uses the accurate dqds algorithm.
    """
    finite = _finite(matrix)
    values = np.linalg.svd(np.where(finite, matrix, 0.0), compute_uv=False)
    return np.where(finite[..., 0], values[..., ::-1], np.nan)


def _left_vectors(matrix: Array) -> Array:
    """Return the left singular vectors [..., mode, row] in the order of the values; NaN with them."""
    finite = _finite(matrix)
    columns = np.linalg.svd(np.where(finite, matrix, 0.0))[0]
    return np.where(finite, columns[..., ::-1].swapaxes(-1, -2), np.nan)


def _finite(matrix: Array) -> NDArray[np.bool_]:
    """Return a mask of the finite matrices [..., 1, 1]."""
    return np.asarray(np.isfinite(matrix).all(axis=(-2, -1), keepdims=True))


def _scaled(shapes: Array) -> Array:
    """Return each shape [..., mode, inertia] with its largest entry equal to 1.

    If several entries are equally large, the first counts.
    """
    size = np.abs(shapes)
    largest = size.max(axis=-1, keepdims=True, initial=0.0)
    first = np.argmax(size >= TIE * largest, axis=-1)[..., None]
    return shapes / (np.sign(np.take_along_axis(shapes, first, axis=-1)) * largest)


def _with_rigid(elastic: Array, value: float, axis: int) -> Array:
    """Return the elastic modes, preceded by the mode in which the chain rotates as a rigid body."""
    shape = list(elastic.shape)
    shape[axis] = 1
    return np.concatenate([np.full(shape, value), elastic], axis=axis)
