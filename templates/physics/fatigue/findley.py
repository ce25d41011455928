r"""Findley's criterion: the plane with the largest combination of shear amplitude and greatest normal stress.

The criterion is tau_a + k sigma_n,max, where tau_a is the radius of the smallest circle about the path of the
shear stress on a plane. The normal of a free surface is not needed: the search covers planes of every
direction, which include those at the surface.

References
----------
W. N. Findley: A theory for the effect of mean stress on fatigue of metals under combined torsion and axial
load or bending. J. Eng. for Industry 81, 1959.
D. F. Socie, G. B. Marquis: Multiaxial Fatigue. SAE 2000, section 5.3: k and
the endurance limits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.fatigue.smallest_circle import radii_of_smallest_circles

_PLANES = 400  # planes in the first search, 7 degrees apart
_FIRST_STEP = 0.07  # first step [rad] of the second search, around the best planes of the first
_SHRINK, _STEPS = 0.6, 18  # factor and number of steps, down to 1e-5 rad
_NEIGHBOURS = 6
_STARTS = 5  # starts of the second search
_APART = np.cos(np.radians(15))  # cosine of the least angle between these starts
_AT_ONCE = 4_000_000  # most stress values at once
_DIRECTIONS = 36  # directions on the plane in which the shear range is compared


@dataclass(frozen=True)
class CriticalPlane:
    """Findley's critical plane of each history, and the stresses on it over the cycle."""

    normal: Array  # [..., 3]
    shear: Array  # [..., angle] [Pa], along the line of its largest range, scaled to its amplitude
    shear_amplitude: Array  # [...] [Pa]
    normal_high: Array  # [...] [Pa], greatest normal stress
    normal_low: Array  # [...] [Pa]

    def normal_amplitude(self) -> Array:
        """Return half the range of the normal stress [Pa]."""
        return (self.normal_high - self.normal_low) / 2


@units("1", returns="1", latex=r"\frac{{x}}{{\sqrt{{1-x^{{2}}}}}},\ x=\frac{{2}}{{{0}}}-1")
def findley_coefficient(ratio: Array) -> Array:
    """Return k [1] from the ratio f/t of endurance limits in bending and torsion: f/t = 2/(1+k/√(1+k²))."""
    x = 2 / ratio - 1
    return x / np.sqrt(1 - x**2)


def uniaxial_equivalent(parameter: Array, k: Array) -> Array:
    """Return the reversed uniaxial amplitude [Pa] with the same tau_a + k sigma_n,max [Pa]."""
    return 2 * parameter / (k + np.sqrt(1 + k**2))


def critical_planes(tensors: Array, k: float, *, credit: bool) -> CriticalPlane:
    """Return Findley's critical plane of stress histories [..., angle, 6] [Pa].

    A compressive mean of the normal stress counts as zero unless there is `credit` for it.
    """
    shape = tensors.shape[:-2]
    flat = tensors.reshape(-1, *tensors.shape[-2:])
    scale = np.abs(flat).max(axis=(1, 2), initial=0.0)
    flat = flat / np.where(scale > 0, scale, 1.0)[:, None, None]
    at_once = max(1, _AT_ONCE // (_PLANES * flat.shape[1]))
    pieces = [_planes_of(flat[i : i + at_once], k, credit) for i in range(0, len(flat), at_once)]
    normals = np.concatenate(pieces)
    shear, normal = _acting(flat, normals[:, None])
    amplitude = radii_of_smallest_circles(shear.real, shear.imag)[:, 0]
    counted = _longest_way(shear[:, 0], amplitude)
    size = scale.reshape(shape)
    return CriticalPlane(
        normals.reshape(*shape, 3),
        counted.reshape(*shape, -1) * size[..., None],
        amplitude.reshape(shape) * size,
        normal[:, 0].max(axis=-1).reshape(shape) * size,
        normal[:, 0].min(axis=-1).reshape(shape) * size,
    )


@lru_cache(1)
def _hemisphere() -> Array:
    """Return directions distributed evenly over half a sphere on a Fibonacci spiral."""
    number = np.arange(_PLANES) + 0.5
    z = number / _PLANES
    angle = np.pi * (1 + np.sqrt(5)) * number
    across = np.sqrt(1 - z**2)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], -1)


def _planes_of(tensors: Array, k: float, credit: bool) -> Array:
    """Return the normals [history, 3] of the planes with the largest parameter."""
    everywhere = _hemisphere()
    values = _parameters(tensors, np.broadcast_to(everywhere, (len(tensors), *everywhere.shape)), k, credit)
    rows = np.arange(len(tensors))
    left, starts = values.copy(), []
    for _ in range(_STARTS):
        starts.append(np.argmax(left, axis=1))
        left[np.abs(everywhere[starts[-1]] @ everywhere.T) > _APART] = -np.inf
    places = np.stack([everywhere[start] for start in starts], 1)
    reached = np.stack([values[rows, start] for start in starts], 1)
    step, turn = _FIRST_STEP, 0.0
    for _ in range(_STEPS):
        around = _around(places, step, turn)
        flat = around.reshape(len(tensors), -1, 3)
        found = _parameters(tensors, flat, k, credit).reshape(*around.shape[:-1])
        better = np.argmax(found, axis=-1)
        highest = np.take_along_axis(found, better[..., None], -1)[..., 0]
        moved = np.take_along_axis(around, better[..., None, None], -2)[..., 0, :]
        places = np.where((highest > reached)[..., None], moved, places)
        reached = np.maximum(reached, highest)
        step, turn = step * _SHRINK, turn + 0.4
    return places[rows, np.argmax(reached, axis=1)]


def _around(places: Array, step: float, turn: float) -> Array:
    """Return directions at a small angle around others [..., 3]: [..., neighbour, 3]."""
    u, v = _in_plane(places)
    angles = turn + 2 * np.pi * np.arange(_NEIGHBOURS) / _NEIGHBOURS
    aside = u[..., None, :] * np.cos(angles)[:, None] + v[..., None, :] * np.sin(angles)[:, None]
    return places[..., None, :] * np.cos(step) + aside * np.sin(step)


def _in_plane(normals: Array) -> tuple[Array, Array]:
    """Return two orthogonal directions within each plane."""
    steep = np.abs(normals[..., 2:]) < 0.9
    helper = np.where(steep, np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))
    u = np.cross(helper, normals)
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    return u, np.cross(normals, u)


def _acting(tensors: Array, normals: Array) -> tuple[Array, Array]:
    """Return the shear stress (as a complex number in the plane) and the normal stress on planes.

    Both are [history, plane, angle].
    """
    u, v = _in_plane(normals)
    shear = _weights(normals, u) + 1j * _weights(normals, v)
    turned = np.swapaxes(tensors, 1, 2)
    return shear @ turned, _weights(normals, normals) @ turned


def _weights(n: Array, m: Array) -> Array:
    """Return the factors of a tensor's six components in the stress n·sigma·m."""
    x, y, z = 0, 1, 2
    pairs = ((x, y), (y, z), (x, z))
    straight = [n[..., i] * m[..., i] for i in (x, y, z)]
    return np.stack([*straight, *(n[..., i] * m[..., j] + n[..., j] * m[..., i] for i, j in pairs)], -1)


def _parameters(tensors: Array, normals: Array, k: float, credit: bool) -> Array:
    """Return tau_a + k sigma_n,max on planes [history, plane]."""
    shear, normal = _acting(tensors, normals)
    high, low = normal.max(axis=-1), normal.min(axis=-1)
    counted = high if credit else np.maximum(high, (high - low) / 2)
    return radii_of_smallest_circles(shear.real, shear.imag) + k * counted


def _longest_way(shear: Array, amplitude: Array) -> Array:
    """Return the shear [history, angle] along the direction of its largest range, scaled to the amplitude."""
    lines = np.exp(-1j * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS)
    along = (shear[:, None, :] * lines[:, None]).real
    ranges = along.max(axis=-1) - along.min(axis=-1)
    best = np.argmax(ranges, axis=1)
    rows = np.arange(len(shear))
    half = ranges[rows, best] / 2
    return along[rows, best] * np.where(half > 0, amplitude / np.where(half > 0, half, 1.0), 0.0)[:, None]
