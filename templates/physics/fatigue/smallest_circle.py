"""The smallest enclosing circles of plane paths; the radius is the shear amplitude on a plane.

Two or three points define the circle. The search begins with the two points that are farthest apart in a
small subset. While a point lies outside, the next circle is the smallest one around the defining points and
that point. The radius grows with each step, so no set of points recurs, and a few steps suffice. The circle
is exact, not sampled.

References
----------
E. Welzl: Smallest enclosing disks. New Results and New Trends in Computer Science, 1991, for the theorem.
I. V. Papadopoulos: Critical plane approaches in high-cycle fatigue. Fatigue Fract. Eng. Mater. 21, 1998,
for the amplitude of a shear stress as the radius of that circle.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array

Complex = NDArray[np.complex128]

_OUTSIDE = 1e-9  # relative to the radius: a point within this distance is on the circle
_MOST_STEPS = 100
_PAIRS = tuple(combinations(range(4), 2))
_TRIPLES = tuple(combinations(range(4), 3))


def radii_of_smallest_circles(x: Array, y: Array) -> Array:
    """Return the radii [...] of the smallest circles around the points x, y [..., point] of plane paths."""
    flat = (x + 1j * y).reshape(-1, x.shape[-1])
    return np.asarray(_radii(flat).reshape(x.shape[:-1]))


def _radii(paths: Complex) -> Array:
    rows = np.arange(len(paths))
    first = paths[rows, np.argmax(_far(paths, paths[:, 0]), axis=1)]
    second = paths[rows, np.argmax(_far(paths, first), axis=1)]
    held = np.stack([first, second, second], axis=1)
    centres, radii = (first + second) / 2, np.abs(first - second) / 2
    active = rows
    for _ in range(_MOST_STEPS):
        distances = _far(paths[active], centres[active])
        farthest = np.argmax(distances, axis=1)
        reach = np.sqrt(distances[np.arange(len(active)), farthest])
        outside = reach > radii[active] * (1 + _OUTSIDE)
        active, farthest = active[outside], farthest[outside]
        if not len(active):
            break
        four = np.concatenate([held[active], paths[active, farthest][:, None]], axis=1)
        centres[active], radii[active], held[active] = _about_four(four)
    return radii


def _far(paths: Complex, centres: Complex) -> Array:
    """Return the squared distances from the centres."""
    away = paths - centres[:, None]
    return np.asarray(away.real**2 + away.imag**2)


def _about_four(points: Complex) -> tuple[Complex, Array, Complex]:
    """Return the smallest circle around each set of four points [n, 4].

    The result contains centre, radius and the points that define the circle.
    """
    centres, radii, held = [], [], []
    for i, j in _PAIRS:
        centre = (points[:, i] + points[:, j]) / 2
        centres.append(centre)
        radii.append(np.abs(points[:, i] - centre))
        held.append(points[:, (i, j, j)])
    for triple in _TRIPLES:
        centre, radius = _circumscribed(*points[:, triple].T)
        centres.append(centre)
        radii.append(radius)
        held.append(points[:, triple])
    centre, radius = np.stack(centres, 1), np.stack(radii, 1)
    reach = np.abs(points[:, None] - centre[:, :, None]).max(axis=-1)
    encloses = reach <= radius * (1 + _OUTSIDE / 10)
    # If rounding leaves no circle that encloses all points, take the one with the smallest excess.
    choice = np.where(encloses.any(axis=1)[:, None], np.where(encloses, radius, np.inf), reach)
    best, rows = np.argmin(choice, axis=1), np.arange(len(points))
    return centre[rows, best], reach[rows, best], np.stack(held, 1)[rows, best]


def _circumscribed(a: Complex, b: Complex, c: Complex) -> tuple[Complex, Array]:
    """Return the circle through each set of three points [n]; infinite if the points are collinear."""
    p, q = b - a, c - a
    twice = 2 * (p.conj() * q).imag
    flat = twice == 0
    away = 1j * (p * np.abs(q) ** 2 - q * np.abs(p) ** 2) / np.where(flat, 1.0, twice)
    return a + np.where(flat, 0, away), np.where(flat, np.inf, np.abs(away))
