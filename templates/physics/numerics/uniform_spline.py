"""Cubic splines on equally spaced nodes in two dimensions, many functions at once.

References
----------
C. de Boor, A Practical Guide to Splines, 1978, chapters IX and IV (not-a-knot ends).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from templates.core.arrays import Array

_BLOCK = 4096
"""Points evaluated at a time, so that their weights stay in the processor's cache."""


@dataclass(frozen=True)
class Axis:
    """Equally spaced nodes."""

    first: float
    step: float
    nodes: int

    def places(self) -> Array:
        """Return all nodes."""
        return np.linspace(self.first, self.first + self.step * (self.nodes - 1), self.nodes)

    def weights(self, x: Array, cell: NDArray[np.int32] | None = None) -> tuple[NDArray[np.int32], Array]:
        """Return the index of the first of the four B-splines at x, and their values, (N, 4).

        Outside the axis, the cubic of the last cell is continued.
        """
        place = (x - self.first) / self.step
        if cell is None:
            cell = np.clip(place.astype(np.int32), 0, self.nodes - 2)
        t: Array = np.subtract(place, cell, dtype=np.float64)
        u = 1 - t
        t2, u2 = t * t, u * u
        values = np.empty((x.size, 4))
        values[:, 0], values[:, 3] = u2 * u / 6, t2 * t / 6
        values[:, 1], values[:, 2] = 2 / 3 - t2 * (1 + u) / 2, 2 / 3 - u2 * (1 + t) / 2
        return cell, values


def spline_coefficients(values: Array) -> Array:
    """Return the coefficients of the B-spline that interpolates values; the first axis has two more."""
    n = len(values)
    system = np.zeros((n + 2, n + 2))
    for k in range(n):
        system[k + 1, k : k + 3] = 1 / 6, 4 / 6, 1 / 6
    system[0, :5] = system[-1, -5:] = 1, -4, 6, -4, 1
    right = np.zeros((n + 2, *values.shape[1:]))
    right[1:-1] = values
    return np.asarray(np.linalg.solve(system, right.reshape(n + 2, -1)).reshape(right.shape))


def surface_coefficients(values: Array) -> Array:
    """Return the B-spline coefficients along the first two axes of (n, m, functions)."""
    return spline_coefficients(spline_coefficients(values).swapaxes(0, 1)).swapaxes(0, 1)


def surface(coefficients: Array, first: Axis, second: Axis, x: Array, y: Array) -> Array:
    """Return all functions at points.

    Parameters
    ----------
    coefficients
        (n + 2, m + 2, functions).
    first, second
        The nodes along the two axes.
    x, y
        (N,) coordinates of the points.

    Returns
    -------
    (functions, N).
    """
    flat = coefficients.reshape(-1, coefficients.shape[-1])
    values = np.empty((flat.shape[1], x.size))
    for start in range(0, x.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        values[:, part] = _block(flat, first, second, x[part], y[part]).T
    return values


def line(coefficients: Array, second: Axis, y: Array) -> Array:
    """Return the coefficients along the first axis of one function at places on the second, (N, n + 2)."""
    column, weight = second.weights(y)
    indices = (column[:, None] + np.arange(4)).ravel()
    shape = y.size, second.nodes + 2
    return np.asarray(
        csr_array((weight.ravel(), indices, np.arange(0, 4 * y.size + 1, 4)), shape=shape) @ coefficients.T
    )


def _block(flat: Array, first: Axis, second: Axis, x: Array, y: Array) -> Array:
    """Return the sixteen products of B-splines for each point as rows of a sparse matrix."""
    row, weight_x = first.weights(x)
    column, weight_y = second.weights(y)
    width = second.nodes + 2
    offsets = (np.arange(4)[:, None] * width + np.arange(4)).ravel().astype(np.int32)
    indices = (row * width + column)[:, None] + offsets
    weights = (weight_x[:, :, None] * weight_y[:, None, :]).ravel()
    ends = np.arange(0, 16 * x.size + 1, 16, dtype=np.int32)
    return np.asarray(csr_array((weights, indices.ravel(), ends), shape=(x.size, len(flat))) @ flat)
