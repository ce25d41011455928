"""Sharp inner edges of a solid, at which stress has no limit and elements have to be small.

For `cad.analysis.mesh`. They are seen on triangles that are small enough to turn by less than `SHARP` where a
fillet begins: at a sharp inner edge two triangles of two faces meet at a larger angle, and open outward.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil, cos, pi
from typing import Any

import numpy as np
from netgen.meshing import MeshingParameters, MeshingStep
from netgen.occ import OCCGeometry
from numpy.typing import NDArray

SHARP = pi / 3  # [rad]

_SIZE, _CURVATURE, _GRADING = 1.0, 1.0, 0.7  # of triangles: in radii; by radius of curvature; of neighbours

Reals = NDArray[np.float64]


def sharp_inner_edges(shape: Any, radius: float) -> Reals:
    """The ends (n, 2, 3) [mm] of straight pieces of all sharp inner edges of a shaft of some radius [mm]."""
    parameters = MeshingParameters(
        maxh=_SIZE * radius,
        curvaturesafety=_CURVATURE,
        grading=_GRADING,
        perfstepsend=MeshingStep.MESHSURFACE,
    )
    surface = OCCGeometry(shape).GenerateMesh(parameters)
    points = np.array([[*point] for point in surface.Points()])
    elements = [
        (element.index, [vertex.nr - 1 for vertex in element.vertices]) for element in surface.Elements2D()
    ]
    face = np.array([index for index, _ in elements])
    corners = np.array([vertices for _, vertices in elements])
    first, second = _neighbours(corners)
    normal, centre = _normals(points[corners]), points[corners].mean(axis=1)
    one, other = first[:, 0], second[:, 0]
    ends = points[corners[one[:, None], np.stack([first[:, 1], (first[:, 1] + 1) % 3], axis=1)]]
    turned = np.sum(normal[one] * normal[other], axis=1) < cos(SHARP)
    outward = np.sum((centre[other] - ends.mean(axis=1)) * normal[one], axis=1) > 0
    return np.asarray(ends[(face[one] != face[other]) & turned & outward])


def along(edges: Reals, step: float) -> Iterator[tuple[float, float, float]]:
    """Points along straight pieces, at most a step [mm] apart."""
    for start, end in edges:
        count = ceil(float(np.linalg.norm(end - start)) / step)
        for low, high in pairwise(np.linspace(0, 1, count + 1)):
            x, y, z = start + (end - start) * (low + high) / 2
            yield float(x), float(y), float(z)


def _neighbours(corners: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """For each side that two triangles share: the one, and the other, each with the place of its side."""
    sides = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2)
    order = np.lexsort(sides.T)
    twice = np.flatnonzero((sides[order[1:]] == sides[order[:-1]]).all(axis=1))
    found = np.stack([order[twice], order[twice + 1]])
    one, other = np.stack([found // 3, found % 3], axis=-1)
    return one, other


def _normals(triangles: Reals) -> Reals:
    a, b, c = triangles.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])
