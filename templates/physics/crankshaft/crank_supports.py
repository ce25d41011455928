"""Main bearings of an elastic crankshaft on elastic supports: the force method (three-moment equations).

The reactions are R = R0 + N λ. R0 balances the loads by the lever rule; each column of N is a self-balanced
set of reactions, one for each main between the two outermost, in x and in y. The displacements of the
supports, −R/k, and those of the shaft, C R + C_l F plus a rigid-body motion, agree: Nᵀ((C + 1/k)(R0 + N λ) +
C_l F) = 0. Force and moment therefore balance to rounding error at any stiffness, from soft supports (a rigid
shaft) to rigid ones.

All quantities are in axes that rotate with the shaft, in which its flexibility is constant; supports are
equal in x and y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.crankshaft.main_bearings import lever_shares


@dataclass(frozen=True)
class Flexibility:
    """Displacements of the mains [m/N] for unit forces on mains, (2 n, 2 n), and at the loads, (2 n, 2 L).

    The first and last main are fixed; torque and thrust are taken at the drive end. Components x, y of each
    place are consecutive.
    """

    mains: Array
    loads: Array


def self_balancing(mains: Array) -> Array:
    """Return self-balanced sets of reactions, (n, n − 2) [-].

    Each set has 1 at one inner main and the balancing lever-rule reactions at the two outermost mains.
    """
    n = mains.size
    share = (mains[1:-1] - mains[0]) / (mains[-1] - mains[0])
    basis = np.zeros((n, n - 2))
    basis[np.arange(1, n - 1), np.arange(n - 2)] = 1
    basis[0], basis[-1] = share - 1, -share
    return basis


def support_reactions(mains: Array, places: Array, shaft: Flexibility, stiffness: Array) -> Array:
    """Return reactions to unit forces at the loads, (2 n, 2 L); `stiffness` [N/m], (n,), may be infinite."""
    plane = np.eye(2)
    start: Array = np.asarray(-np.kron(lever_shares(mains, places), plane), dtype=float)
    if mains.size == 2:
        return start
    basis = np.kron(self_balancing(mains), plane)
    give = shaft.mains + np.diag(np.repeat(1 / stiffness, 2))
    gap = basis.T @ (give @ start + shaft.loads)
    return np.asarray(start - basis @ np.linalg.solve(basis.T @ give @ basis, gap), dtype=float)
