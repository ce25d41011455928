"""Newton steps for two coordinates that obey a periodic differential equation.

Second-order backward differences at all nodes of the cycle at once (BDF2, variable steps):

.. math:: a_0 e_k + a_1 e_{k-1} + a_2 e_{k-2} = f_k(e_k)

A step solves the linearised equations of many cases together: one banded triangular system for all, in which
the last two nodes of the previous cycle are unknown, and a system of four equations for these. The method is
L-stable for equal steps, so stiff solutions decay as they should, and no run-in cycles are needed.
"""

import numpy as np
from scipy.linalg.lapack import dtbtrs

from templates.core.arrays import Array

_NEARLY = 1 + 1e-15
"""Prevents an exactly singular matrix for a cycle that returns every disturbance unchanged."""


def differences(steps: Array) -> Array:
    """Return the coefficients a_0, a_1, a_2 of the backward differences on a ring of steps, (3, K)."""
    r = steps / np.roll(steps, 1)
    return np.stack([(1 + 2 * r) / (1 + r), -(1 + r), r * r / (1 + r)]) / steps


def imbalance(a: Array, e: Array, f: Array) -> Array:
    """Return the residuals of the equations, (2, C, K)."""
    return np.asarray(a[0] * e + a[1] * np.roll(e, 1, axis=-1) + a[2] * np.roll(e, 2, axis=-1) - f)


def newton_step(a: Array, left: Array, slopes: Array) -> Array:
    """Return the change of all nodes that removes the residuals, (2, C, K).

    Parameters
    ----------
    a
        (3, K) coefficients of `differences`.
    left
        (2, C, K) residuals of `imbalance`.
    slopes
        (2, 2, C, K) derivatives of f by e.

    Returns
    -------
    (2, C, K); not finite for cases in which the system is singular.
    """
    inverse = _inverse(a[0], slopes)
    change = _solved(a, inverse, left)
    if not np.isfinite(change).all() and left.shape[1] > 1:
        alone = [_solved(a, inverse[:, :, k : k + 1], left[:, k : k + 1]) for k in range(left.shape[1])]
        change = np.concatenate(alone, axis=1)
    return change


def _inverse(a_0: Array, slopes: Array) -> Array:
    """Return the inverses of a_0 − f', (2, 2, C, K)."""
    (A, B), (C, D) = -slopes
    A, D = a_0 + A, a_0 + D
    return np.array([[D, -B], [-C, A]]) / (A * D - B * C)


def _solved(a: Array, inverse: Array, left: Array) -> Array:
    """Return e_k = G_1 e_(k−1) + G_2 e_(k−2) + q_k.

    The recurrence is run from unit values before the cycle, then closed.
    """
    G_1, G_2 = -a[1] * inverse, -a[2] * inverse
    cases, nodes = left.shape[1:]
    columns = np.zeros((cases, nodes, 2, 5))
    columns[..., 0] = -np.einsum("rscn,scn->cnr", inverse, left)
    columns[:, 0, :, 1:3], columns[:, 0, :, 3:5] = _of_node(G_2, 0), _of_node(G_1, 0)
    columns[:, 1, :, 3:5] = _of_node(G_2, 1)
    bands = _bands(G_1, G_2)
    runs, _ = dtbtrs(bands, columns.reshape(-1, 5), uplo="L", diag="U", overwrite_b=True)
    runs = np.asarray(runs).reshape(cases, nodes, 2, 5)
    end = runs[:, -2:].reshape(cases, 4, 5)
    before = _closed(end) if np.isfinite(end).all() else np.full((cases, 4, 1), np.nan)
    change = runs[..., 0] + np.einsum("cnrs,cs->cnr", runs[..., 1:], before[..., 0])
    return np.moveaxis(change, -1, 0)


def _closed(end: Array) -> Array:
    """Return the values before the cycle that recur at its end, (C, 4, 1)."""
    return np.asarray(np.linalg.solve(_NEARLY * np.eye(4) - end[:, :, 1:], end[:, :, :1]))


def _of_node(G: Array, node: int) -> Array:
    """Return the matrices of one node, (C, 2, 2)."""
    return np.moveaxis(G[..., node], -1, 0)


def _bands(G_1: Array, G_2: Array) -> Array:
    """Return the lower triangular matrix of all cases in LAPACK's band storage: (6, 2 C K)."""
    cases, nodes = G_1.shape[2:]
    bands = np.zeros((6, cases, nodes, 2))
    bands[0] = 1
    for back, G in ((1, G_1), (2, G_2)):
        for row, column in np.ndindex(2, 2):
            bands[2 * back + row - column, :, :-back, column] = -G[row, column, :, back:]
    return bands.reshape(6, -1)
