"""Loads of every main bearing from all loads on the crankshaft, and their balance.

Each load is a complex force, x + i y, at a position along the shaft. *Determinate*: the lever rule
distributes every load to the two mains of its span, and an overhung load to those of the end span. For
elastic supports see `crank_supports`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.numerics.crank_grid import CrankGrid

Vectors = NDArray[np.complex128]
_VANISHES = 1e-12


@dataclass(frozen=True)
class ShaftLoads:
    """Loads on the shaft: positions [m], (L,), and forces [N] in the frame's axes, (…, L, K)."""

    places: Array
    forces: Vectors


def lever_shares(mains: Array, places: Array) -> Array:
    """Return the share of each load that each main carries, (n, L), for mains [m] in ascending order.

    Shares sum to 1.
    """
    span = np.clip(np.searchsorted(mains, places) - 1, 0, mains.size - 2)
    share = (places - mains[span]) / (mains[span + 1] - mains[span])
    shares = np.zeros((mains.size, places.size))
    loads = np.arange(places.size)
    shares[span, loads], shares[span + 1, loads] = 1 - share, share
    return shares


def determinate_loads(mains: Array, loads: ShaftLoads) -> Vectors:
    """Return the force of the frame on the shaft at each main by the lever rule [N], (…, n, K)."""
    return -(lever_shares(mains, loads.places) @ loads.forces)


def elastic_loads(reactions: Array, loads: ShaftLoads, theta: Array) -> Vectors:
    """Return the force at each main on elastic supports, by `reactions`, (…, 2 n, 2 L), in rotating axes."""
    turn = np.exp(1j * theta)[..., None, :]
    turned = loads.forces * np.conj(turn)
    pairs = np.stack([turned.real, turned.imag], axis=-2)  # (…, L, 2, K)
    flat = pairs.reshape(*pairs.shape[:-3], -1, pairs.shape[-1])
    found = np.asarray(reactions @ flat)
    split = found.reshape(*found.shape[:-2], -1, 2, found.shape[-1])
    return (split[..., 0, :] + 1j * split[..., 1, :]) * turn


def in_engine_axes(forces: Vectors, banks: Array) -> Vectors:
    """Convert forces given in the axes of their cylinders, (…, N, K), to the axes of the engine."""
    return np.asarray(forces * np.exp(1j * banks)[..., None])


@units("m", returns="1")
def mains_ascend(mains: Array) -> Truth:
    """Return whether no mains are given, or two or more in ascending order along the shaft."""
    if np.ndim(mains) == 0:
        return True
    return np.ndim(mains) == 1 and np.size(mains) > 1 and bool(np.all(np.diff(mains) > 1e-6))


def _returned(part: Array, vectors: Vectors, grid: CrankGrid) -> Array:
    """Return a component of vectors at the returned angles; 0 where it is rounding error of the largest."""
    if not np.ndim(vectors):
        return np.asarray(part)
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    shown = grid.returned(part)
    return np.where(np.abs(shown) <= _VANISHES * largest, 0.0, shown)


@units(None, None, returns="N")
def along_x(forces: Vectors, grid: CrankGrid) -> Array:
    """Return the x component of forces [N] at the returned angles."""
    return _returned(forces.real, forces, grid)


@units(None, None, returns="N")
def along_y(forces: Vectors, grid: CrankGrid) -> Array:
    """Return the y component of forces [N] at the returned angles."""
    return _returned(forces.imag, forces, grid)


@units(None, None, returns="N*m")
def moment_about_x(couple: Vectors, grid: CrankGrid) -> Array:
    """Return the moment about x [N m], −Σz F_y, at the returned angles from complex ΣzF."""
    return _returned(-couple.imag, couple, grid)


@units(None, None, returns="N*m")
def moment_about_y(couple: Vectors, grid: CrankGrid) -> Array:
    """Return the moment about y [N m], Σz F_x, at the returned angles from complex ΣzF."""
    return _returned(couple.real, couple, grid)


@units(None, returns="N")
def greatest(forces: Vectors) -> Array:
    """Return the greatest magnitude over the cycle [N] for each bearing."""
    return np.asarray(np.abs(forces).max(axis=-1)) if np.ndim(forces) else np.array(np.nan)


@units(None, None, returns="rad")
def greatest_at(forces: Vectors, grid: CrankGrid) -> Array:
    """Return the crank angle at which each load is greatest [rad]; the first if several are equal."""
    if not np.ndim(forces):
        return np.array(np.nan)
    size = np.abs(forces)
    near = size >= size.max(axis=-1, keepdims=True) * (1 - 1e-9)
    return np.asarray(np.where(near, grid.theta[..., None, :], np.inf).min(axis=-1))


@units(None, returns="1")
def governing(forces: Vectors) -> Array:
    """Return the number of the bearing with the greatest load, from 1; the first if several are equal."""
    if not np.ndim(forces):
        return np.array(np.nan)
    most = np.abs(forces).max(axis=-1)
    near = most >= most.max(axis=-1, keepdims=True) * (1 - 1e-9)
    return np.where(near.any(axis=-1), np.argmax(near, axis=-1) + 1.0, np.nan)[()]


@units(None, None, returns="1")
def relative_change(elastic: Vectors, determinate: Vectors) -> Array:
    """Return the relative change of each main's greatest load from determinate to elastic supports."""
    plain = np.abs(determinate).max(axis=-1)
    return np.asarray(np.abs(elastic).max(axis=-1) / np.where(plain > 0, plain, np.nan) - 1)


@units(None, None, "m", returns="1")
def left_over(reactions: Vectors, loads: ShaftLoads, mains: Array) -> Array:
    """Return the largest unbalanced force or moment, divided by the sum of magnitudes; 0 below 1e-12."""
    size = np.abs(loads.forces).sum(axis=-2)
    size = np.where(size > 0, size, 1.0)
    force = np.abs(reactions.sum(axis=-2) + loads.forces.sum(axis=-2)) / size
    middle, half = mains.mean(), np.ptp(mains) / 2
    arms = (loads.places - middle)[:, None]
    moment = ((mains - middle)[:, None] * reactions).sum(axis=-2) + (arms * loads.forces).sum(axis=-2)
    left = np.asarray(np.maximum(force, np.abs(moment) / (size * half)).max(axis=-1))
    return np.where(left < _VANISHES, 0.0, left)[()]
