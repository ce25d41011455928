"""Torque of many cylinders, its energy fluctuation, and the flywheel that evens it out."""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.engine.gas_pressure import GasCycle
from templates.physics.engine.slider_crank import Motion, crank_motion
from templates.physics.numerics.crank_grid import CrankGrid


def cylinder_motion(theta: Array, strokes: Array, count: Array, n: Array) -> Motion:
    """The motion of all cylinders, one after the other as they fire, (…, N K), for each ratio n [1]."""
    angles = theta[..., None, :] - firing_angles(strokes, count)[:, None]
    return crank_motion(angles.reshape(*angles.shape[:-2], -1), n)


def firing_angles(strokes: Array, count: Array) -> Array:
    """Return the crank angle [rad] by which each cylinder follows the first, as they fire, (N,)."""
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
    """Return torque of all cylinders [N m], (…, K): `crank_loads.torque_Rao_Singh_1993` summed part by part.

    Each part is a curve of the mechanism or the gas alone, times a number for each point.
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
    """Return the largest minus smallest running integral of torque [N m] less its mean over the grid [J]."""
    return np.asarray(np.ptp(grid.running(torque), axis=-1))[()]


@units("N*m", "1", "rad/s", returns="kg*m**2", latex=r"\frac{{{0}}}{{{1}\,{2}^2}}")
def inertia_of_fluctuation(E: Array, delta: Array, omega: Array) -> Array:
    """Return the inertia [kg m²] that keeps the speed within delta of itself; NaN at rest."""
    moving = np.where(omega == 0, np.nan, omega)
    return (E / (delta * moving**2))[()]


@units("kg*m**2", "kg*m**2", returns="kg*m**2", latex=r"\max\left({0},{1}\right)")
def larger(one: Array, other: Array) -> Array:
    """Return the larger of two inertias [kg m²], one of which may be unknown."""
    return np.fmax(one, other)
