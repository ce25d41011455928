"""Forced torsional vibration of a train: all speeds and orders in one solve.

For each speed and order, at the angular frequency w of the order,

    (K(1 + iη) + i w C − w² M) q = Bᵀ T,   angles = B q,

where B gives all angles from those that no gear drives, and K, C, M are matrices Bᵀ ( ) B; each shaft has a
loss factor η and viscous damping. Each matrix is scaled to a diagonal of about 1. If the angles are more than
`RESONANT` times those that the torque would cause on this diagonal alone, the order excites an undamped
resonance: no digit is significant, and the result is NaN.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from templates.core.arrays import Array
from templates.physics.torsion.torque_harmonics import Phasors
from templates.physics.torsion.train_layout import TrainLayout

RESONANT = 1e12
_BLOCK = 2_000_000  # most matrix entries in memory at a time
_NUDGE = 1e-15  # perturbation of the scaled diagonal of a matrix that is numerically singular


@dataclass(frozen=True)
class Propeller:
    """A load whose torque is proportional to the square of its speed, on one inertia (index from 0).

    `torque` [N m] at `speed` [rad/s] are on its own shaft; `factor` is the slope dT/dω over T/ω.
    """

    at: int
    torque: Array
    speed: Array
    factor: Array

    def damping(self, speeds: Array) -> Array:
        """Return the slope of the propeller's torque [N m s/rad] at its mean speeds [rad/s], (…, V)."""
        each = (np.asarray(one)[..., None] for one in (self.torque, self.speed, self.factor))
        torque, reference, factor = each
        return np.asarray(factor * torque * np.abs(speeds) / reference**2)


@dataclass(frozen=True)
class Train:
    """Inertias, (…, n); stiffness, damping and loss factor of shafts, (…, S); damping to ground; in SI."""

    layout: TrainLayout
    J: Array
    k: Array
    c: Array
    eta: Array
    absolute: Array
    propeller: Propeller | None = None
    crank: int = 0  # the inertia to which the speeds refer

    @cached_property
    def mass(self) -> Array:
        """Return the diagonal matrix M: the inertias that rotate with each free angle, (…, q)."""
        return self.J @ self.layout.reduction**2

    @cached_property
    def twists(self) -> Array:
        """Return the matrix that gives the twist of the shafts from the free angles, (S, q)."""
        return self.layout.difference @ self.layout.reduction

    def damping_of_inertias(self, speeds: Array) -> Array:
        """Return the damping to ground [N m s/rad], (…, V, n), including that of the propeller."""
        own = np.broadcast_to(self.absolute, (*np.shape(self.absolute)[:-1], self.layout.count))[..., None, :]
        if self.propeller is None:
            return own
        at = np.arange(self.layout.count) == self.propeller.at
        ratio = self.layout.speeds[self.propeller.at] / self.layout.speeds[self.crank]
        return np.asarray(own + self.propeller.damping(speeds * ratio)[..., None] * at)

    def respond(self, speeds: Array, orders: Array, torque: Phasors) -> Response:
        """Return the response to torques of the inertias [N m], (…, V, H, n), at speeds [rad/s], (…, V)."""
        ground = self.damping_of_inertias(speeds)
        frequency = np.asarray(speeds)[..., :, None] * orders
        stiff = np.einsum("sa,...s,sb->...ab", self.twists, self.k * (1 + 1j * self.eta), self.twists)
        relative = np.einsum("sa,...s,sb->...ab", self.twists, self.c + 0 * self.k, self.twists)
        reduction = self.layout.reduction
        points = np.broadcast_shapes(
            stiff.shape[:-2], self.mass.shape[:-1], relative.shape[:-2], ground.shape[:-2],
            frequency.shape[:-2], torque.shape[:-3],
        )  # fmt: skip
        several, lines, free = frequency.shape[-2], frequency.shape[-1], self.mass.shape[-1]
        angles = np.empty((*points, several, lines, self.layout.count), complex)
        rows = max(1, _BLOCK // max(1, int(np.prod(points)) * lines * free**2))
        for start in range(0, several, rows):
            part = slice(start, start + rows)
            w = frequency[..., part, :, None]
            on_ground = ground[..., part, :] if ground.shape[-2] > 1 else ground
            to_ground = np.einsum("ia,...i,ib->...ab", reduction, on_ground, reduction)[..., None, :, :]
            damped = relative[..., None, None, :, :] + to_ground
            w_2 = w[..., None]
            matrix = stiff[..., None, None, :, :] + 1j * w_2 * damped
            matrix = matrix - w_2**2 * (self.mass[..., None, None, :, None] * np.eye(free))
            free_angles = _solved(matrix, w, self.mass, np.asarray(torque[..., part, :, :] @ reduction))
            angles[..., part, :, :] = free_angles @ reduction.T
        return Response(self, frequency, torque, angles, ground)


def _solved(matrix: Phasors, w: Array, mass: Array, right: Phasors) -> Phasors:
    """Return the solutions (…, V, H, q); NaN at an undamped resonance that leaves no significant digits."""
    inertia = w**2 * mass[..., None, None, :]
    diagonal = np.abs(np.diagonal(matrix, axis1=-2, axis2=-1) + inertia) + inertia
    scale = 1 / np.sqrt(diagonal)
    scaled = matrix * scale[..., :, None] * scale[..., None, :]
    loads = (right * scale)[..., None]
    try:
        solution = np.linalg.solve(scaled, loads)[..., 0]
    except np.linalg.LinAlgError:  # one of them is numerically singular
        solution = _nudged(scaled, loads)
    size, load = np.abs(solution).max(axis=-1), np.abs(loads[..., 0]).max(axis=-1)
    return np.where((size > RESONANT * load)[..., None], np.nan, solution * scale)


def _nudged(matrix: Phasors, loads: Phasors) -> Phasors:
    """Return the solutions; those of singular matrices are perturbed and very large; NaN on failure."""
    try:
        return np.asarray(np.linalg.solve(matrix + 1j * _NUDGE * np.eye(matrix.shape[-1]), loads)[..., 0])
    except np.linalg.LinAlgError:
        return np.full(loads.shape[:-1], complex(np.nan, np.nan))


@dataclass(frozen=True)
class Response:
    """Angular frequencies [rad/s], (…, V, H); torques and angles of the inertias, (…, V, H, n)."""

    train: Train
    frequency: Array
    torque: Phasors
    angles: Phasors
    ground: Array

    @cached_property
    def twist(self) -> Phasors:
        """Return the twist of the shafts [rad], (…, V, H, S)."""
        return np.asarray(self.angles @ self.train.layout.difference.T)

    @cached_property
    def shaft_torque(self) -> Phasors:
        """Return the torque of the shafts [N m], (…, V, H, S)."""
        train = self.train
        stiff = (train.k * (1 + 1j * train.eta))[..., None, None, :]
        damped = (train.c + 0 * train.k)[..., None, None, :]
        return np.asarray(self.twist * (stiff + 1j * self.frequency[..., None] * damped))

    @cached_property
    def power_in(self) -> Array:
        """Return the mean power input by the harmonics of the torque [W], (…, V)."""
        return (self.frequency * (self.angles.conj() * self.torque).imag.sum(axis=-1)).sum(axis=-1) / 2

    @cached_property
    def apparent_power(self) -> Array:
        """Return the power input with all angles shifted by a quarter period [W], (…, V), for reference."""
        return (self.frequency * (np.abs(self.angles) * np.abs(self.torque)).sum(axis=-1)).sum(axis=-1) / 2

    @cached_property
    def shaft_power(self) -> Array:
        """Return the mean power dissipated by the damping of each shaft [W], (…, V, S)."""
        train, w = self.train, self.frequency[..., None]
        viscous = w**2 * (train.c + 0 * train.k)[..., None, None, :]
        inner = w * (train.k * train.eta)[..., None, None, :]
        return np.asarray((np.abs(self.twist) ** 2 * (viscous + inner)).sum(axis=-2) / 2)

    @cached_property
    def ground_power(self) -> Array:
        """Return the mean power dissipated by the damping of each inertia to ground [W], (…, V, n)."""
        speed = (self.frequency[..., None] * np.abs(self.angles)) ** 2
        return np.asarray(speed.sum(axis=-2) * self.ground / 2)
