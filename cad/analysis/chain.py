"""A crankshaft as a chain of throws: matrices of single throws, rotated by their pin angles and assembled.

The first end is held. In a guided chain each main journal stays on the axis, as in a bearing, but may rotate;
in a free chain nothing else is held. Separately computed throw stiffnesses in series would neglect the
bearings between the throws.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin, sqrt

import numpy as np
from scipy.linalg import block_diag, eigh

from cad.analysis.throw_matrix import END, PIN, ThrowMatrix
from templates.core.arrays import Array


@dataclass(frozen=True)
class Chain:
    """Throws in order, starting at the held end, with the angles of their pins [rad]."""

    throws: Sequence[ThrowMatrix]
    angles: Sequence[float]

    @property
    def size(self) -> int:
        """Return the number of degrees of freedom: six for each main journal, then two for each pin."""
        return END * (len(self.throws) + 1) + PIN * len(self.throws)

    def assembled(self, name: str) -> Array:
        """Return the `stiffness` or the `mass` matrix of the chain in the axes of the first section."""
        whole = np.zeros((self.size, self.size))
        pins = END * (len(self.throws) + 1)
        for k, (throw, angle) in enumerate(zip(self.throws, self.angles, strict=True)):
            turn = turned(angle)
            at = np.r_[END * k : END * (k + 2), pins + PIN * k : pins + PIN * (k + 1)]
            whole[np.ix_(at, at)] += turn.T @ getattr(throw, name) @ turn
        return whole

    def free_to_move(self, *, guided: bool) -> Array:
        """Return the numbers of the free degrees of freedom."""
        held = [*range(END)]
        if guided:
            held += [END * k + d for k in range(1, len(self.throws) + 1) for d in (0, 1)]
        return np.setdiff1d(np.arange(self.size), held)

    def stiffness(self, *, guided: bool) -> float:
        """Return the torque at the last section per rotation [N m/rad], with the first one held."""
        return float(1e-3 / self._rotations(guided=guided)[-1])

    def throw_stiffnesses(self, *, guided: bool) -> Array:
        """Return the stiffness of each throw in the chain [N m/rad]: torque per rotation between its mains.

        These stiffnesses in series give the stiffness of the chain. With guided mains they include the effect
        of the guides and of the neighbouring throws.
        """
        between: Array = np.diff(self._rotations(guided=guided), prepend=0.0)
        return 1e-3 / between

    def _rotations(self, *, guided: bool) -> Array:
        """Return the rotations of the mains after each throw [rad] under a torque of 1 N mm at the end."""
        free = self.free_to_move(guided=guided)
        torque = np.zeros(self.size)
        mains = END * np.arange(1, len(self.throws) + 1) + 5
        torque[mains[-1]] = 1.0
        moved = np.linalg.solve(self.assembled("stiffness")[np.ix_(free, free)], torque[free])
        return np.asarray(moved[np.searchsorted(free, mains)])

    def frequency(self, *, guided: bool) -> float:
        """Return the frequency [Hz] of the mode with the largest inertia about z; one end is held."""
        free = self.free_to_move(guided=guided)
        K, M = (self.assembled(name)[np.ix_(free, free)] for name in ("stiffness", "mass"))
        squares, shapes = eigh(K, M)
        moved = shapes.T @ M @ self._rotation()[free]
        return sqrt(float(squares[np.argmax(moved**2)])) / (2 * pi)

    def inertia(self) -> float:
        """Return the inertia of the whole shaft about z as a rigid body [kg m²]."""
        r = self._rotation()
        return float(r @ self.assembled("mass") @ r) * 1e-3

    def _rotation(self) -> Array:
        """Return all displacements when the whole shaft rotates by 1 rad about z."""
        mains = np.tile([0.0, 0, 0, 0, 0, 1], len(self.throws) + 1)
        pins = [
            throw.throw * way
            for throw, angle in zip(self.throws, self.angles, strict=True)
            for way in (-sin(angle), cos(angle))
        ]
        return np.concatenate([mains, pins])


def turned(angle: float) -> Array:
    """Return the transformation of a throw's degrees of freedom from fixed axes to its own axes (14, 14)."""
    plane = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    space = block_diag(plane, np.eye(1))
    return np.asarray(block_diag(space, space, space, space, plane))
