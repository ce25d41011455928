"""Values and derivatives of cubic splines over two coordinates, where each point uses its own surface.

These are the splines of `uniform_spline`, with derivatives for Newton's method.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from templates.core.arrays import Array
from templates.physics.numerics.uniform_spline import Axis

_BLOCK = 4096
"""Points evaluated at a time, so that their weights stay in the processor's cache."""
_OFFSETS = np.arange(4)


def at_thirds(coefficients: Array, third: Axis, places: Array) -> Array:
    """Return the coefficients of the surfaces of a volume at places on its third axis, (places, ...)."""
    cells, weights = third.weights(places)
    pieces = coefficients[:, :, cells[:, None] + _OFFSETS]
    return np.asarray(np.einsum("ijpkf,pk->pijf", pieces, weights))


def surfaces_with_slopes(
    coefficients: Array, which: NDArray[np.intp], first: Axis, second: Axis, x: Array, y: Array
) -> Array:
    """Return all functions and their derivatives at points.

    Parameters
    ----------
    coefficients
        (surfaces, n + 2, m + 2, functions).
    which
        (N,) index of the surface of each point.
    first, second
        The nodes along the two axes.
    x, y
        (N,) coordinates of the points.

    Returns
    -------
    (3, functions, N): values, derivatives with respect to x, and to y.
    """
    flat = coefficients.reshape(-1, coefficients.shape[-1])
    values = np.empty((3, flat.shape[1], x.size))
    for start in range(0, x.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        values[:, :, part] = _block(flat, coefficients.shape, which[part], first, second, x[part], y[part])
    return values


def _block(
    flat: Array,
    shape: tuple[int, ...],
    which: NDArray[np.intp],
    first: Axis,
    second: Axis,
    x: Array,
    y: Array,
) -> Array:
    """Return the sixteen products of B-splines for each point and function as rows of sparse matrices."""
    row, weight_x = first.weights(x)
    column, weight_y = second.weights(y)
    slope_x, slope_y = _slopes(first, x, row), _slopes(second, y, column)
    corner = (which * shape[1] + row) * shape[2] + column
    offsets = (_OFFSETS[:, None] * shape[2] + _OFFSETS).ravel()
    indices = (corner[:, None] + offsets).ravel().astype(np.int32)
    ends = np.arange(0, 16 * x.size + 1, 16, dtype=np.int32)
    pairs = ((weight_x, weight_y), (slope_x, weight_y), (weight_x, slope_y))
    parts = ((u[:, :, None] * v[:, None, :]).ravel() for u, v in pairs)
    matrices = (csr_array((part, indices, ends), shape=(x.size, len(flat))) for part in parts)
    return np.stack([np.asarray(matrix @ flat).T for matrix in matrices])


def _slopes(axis: Axis, x: Array, cell: NDArray[np.int32]) -> Array:
    """Return the derivatives of the four B-splines at x, (N, 4)."""
    t = (x - axis.first) / axis.step - cell
    u = 1 - t
    inner = t * (1.5 * t - 2), u * (2 - 1.5 * u)
    return np.stack([-u * u / 2, *inner, t * t / 2], axis=1) / axis.step
