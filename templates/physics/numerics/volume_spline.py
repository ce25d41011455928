"""Cubic splines on equally spaced nodes in three dimensions, many functions at once: see `uniform_spline`."""

import numpy as np
from scipy.sparse import csr_array

from templates.core.arrays import Array
from templates.physics.numerics.uniform_spline import Axis

_BLOCK = 1024
"""Points evaluated at a time, so that their weights stay in the processor's cache."""
_FOUR = np.arange(4)

Axes = tuple[Axis, Axis, Axis]


def volume(coefficients: Array, axes: Axes, places: Array) -> Array:
    """Return all functions at points.

    Parameters
    ----------
    coefficients
        (n + 2, k + 2, m + 2, functions).
    axes
        The nodes along the three axes.
    places
        (3, N) coordinates of the points.

    Returns
    -------
    (functions, N).
    """
    shape = coefficients.shape[:3]
    flat = coefficients.reshape(-1, coefficients.shape[-1])
    values = np.empty((flat.shape[1], places.shape[1]))
    for start in range(0, places.shape[1], _BLOCK):
        part = slice(start, start + _BLOCK)
        values[:, part] = _block(flat, shape, axes, places[:, part]).T
    return values


def at_third(coefficients: Array, third: Axis, place: float) -> Array:
    """Return the coefficients of the surface of a volume at one place on its third axis."""
    cell, weight = third.weights(np.array([place]))
    return np.asarray(np.einsum("ijkf,k->ijf", coefficients[:, :, cell[0] : cell[0] + 4], weight[0]))


def _block(flat: Array, shape: tuple[int, ...], axes: Axes, places: Array) -> Array:
    """Return the sixty-four products of B-splines for each point as rows of a sparse matrix."""
    (i, u), (j, v), (k, w) = (axis.weights(x) for axis, x in zip(axes, places, strict=True))
    size = i.size
    offsets = (_FOUR[:, None, None] * shape[1] + _FOUR[:, None]) * shape[2] + _FOUR
    corner = (i * shape[1] + j) * shape[2] + k
    indices = corner[:, None] + offsets.ravel().astype(np.int32)
    pairs = (u[:, :, None] * v[:, None, :]).reshape(size, 16, 1)
    weights = (pairs * w[:, None, :]).ravel()
    ends = np.arange(0, 64 * size + 1, 64, dtype=np.int32)
    return np.asarray(csr_array((weights, indices.ravel(), ends), shape=(size, len(flat))) @ flat)
