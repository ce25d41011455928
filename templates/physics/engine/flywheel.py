"""Torque of several cylinders, its energy fluctuation, and the flywheel that smooths it."""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.engine.gas_pressure import GasCycle
from templates.physics.engine.slider_crank import Motion, crank_motion
from templates.physics.numerics.crank_grid import CrankGrid


def cylinder_motion(theta: Array, strokes: Array, count: Array, n: Array) -> Motion:
    """Return the motion of all cylinders in firing order, (…, N K), for each ratio n [1]."""
    angles = theta[..., None, :] - firing_angles(strokes, count)[:, None]
    return crank_motion(angles.reshape(*angles.shape[:-2], -1), n)


def firing_angles(strokes: Array, count: Array) -> Array:
    """Return the crank angle [rad] by which each cylinder lags the first, in firing order, (N,)."""
    return np.arange(round(float(count))) * (np.pi * strokes / count)


def corners(gas: GasCycle, strokes: Array, count: Array) -> Array:
    """Return the crank angles [rad] of the jumps and peaks of the pressure in all cylinders, (…, J)."""
    angles = gas.corners()[..., None, :] + firing_angles(strokes, count)[:, None]
    return np.asarray(angles.reshape(*angles.shape[:-2], -1))


def _together(value: Array, theta: Array) -> Array:
    """Return the sum over the cylinders, (…, K)."""
    return np.asarray(value.reshape(*value.shape[:-1], -1, theta.shape[-1]).sum(axis=-2))


@units("kg", "rad/s", "m", "m**2", "kg*m**2", None, None, "Pa", "rad", returns="N*m")
def total_torque(
    m: Array, omega: Array, r: Array, A: Array, excess: Array, motion: Motion, gas: GasCycle, p_c: Array,
    theta: Array,
) -> Array:  # fmt: skip
    """Return the torque of all cylinders [N m], (…, K): `crank_loads.torque_Rao_Singh_1993`, part by part.

    Each part is a curve of the mechanism or the gas alone, multiplied by a number for each point.
    """
    p = gas.pressure(motion.theta, motion.travel) - np.asarray(p_c)[..., None]
    parts = (
        (A * r, p * motion.lever),
        (m * omega**2 * r**2, motion.acceleration * motion.lever),
        (excess * omega**2, motion.rod_acceleration * motion.rod_velocity),
    )
    return np.asarray(sum(np.asarray(size)[..., None] * _together(curve, theta) for size, curve in parts))


@units(None, None, returns="J")
def energy_fluctuation(torque: Array, grid: CrankGrid) -> Array:
    """Return the largest minus smallest running integral [J] of torque minus its mean [N m] over the grid."""
    return np.asarray(np.ptp(grid.running(torque), axis=-1))[()]


@units("N*m", "1", "rad/s", returns="kg*m**2", latex=r"\frac{{{0}}}{{{1}\,{2}^2}}")
def inertia_of_fluctuation(E: Array, delta: Array, omega: Array) -> Array:
    """Return the inertia [kg m²] that limits the coefficient of speed fluctuation to delta; NaN at rest."""
    moving = np.where(omega == 0, np.nan, omega)
    return (E / (delta * moving**2))[()]


@units("kg*m**2", "kg*m**2", returns="kg*m**2", latex=r"\max\left({0},{1}\right)")
def larger(one: Array, other: Array) -> Array:
    """Return the larger of two inertias [kg m²], either of which may be NaN."""
    return np.fmax(one, other)
