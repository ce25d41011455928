"""Find sharp inner edges of a solid, where stress is unbounded and elements must be small.

`cad.analysis.mesh` uses this module. The surface is divided into triangles so small that the normals of
neighbours differ by less than `SHARP` at the start of a fillet. At a sharp inner edge, triangles of two faces
meet at a larger angle that opens outwards.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import acos, ceil, cos, pi
from typing import Any

import numpy as np
from netgen.meshing import MeshingParameters, MeshingStep
from netgen.occ import OCCGeometry

from templates.core.arrays import Array, Integers

SHARP = pi / 3  # [rad]

_SIZE, _CURVATURE, _GRADING = 1.0, 1.0, 0.7  # triangles: size in radii; per radius of curvature; growth


@dataclass(frozen=True)
class Edges:
    """Straight segments of edges."""

    ends: Array  # (n, 2, 3) [mm]
    radius: Array  # (n,) [mm], radius of the edge at the end; for a straight edge the size of the solid
    smallest: float = 0.0  # [mm], size below which no elements are made at them


NONE = Edges(np.zeros((0, 2, 3)), np.zeros(0))


def sharp_inner_edges(shape: Any, scale: float, smallest: float = 0.0) -> Edges:
    """Return all sharp inner edges of a shape, found on triangles of this size, none below another [mm]."""
    parameters = MeshingParameters(
        maxh=_SIZE * scale,
        minh=smallest,
        curvaturesafety=_CURVATURE,
        grading=_GRADING,
        perfstepsend=MeshingStep.MESHSURFACE,
    )
    surface = OCCGeometry(shape).GenerateMesh(parameters)
    elements = surface.Elements2D().NumPy()
    points, face, corners = surface.Coordinates(), elements["index"], elements["nodes"] - 1
    first, second = _neighbours(corners)
    normal, centre = _normals(points[corners]), points[corners].mean(axis=1)
    one, other = first[:, 0], second[:, 0]
    vertices = corners[one[:, None], np.stack([first[:, 1], (first[:, 1] + 1) % 3], axis=1)]
    ends = points[vertices]
    turned = np.sum(normal[one] * normal[other], axis=1) < cos(SHARP)
    outward = np.sum((centre[other] - ends.mean(axis=1)) * normal[one], axis=1) > 0
    inner = (face[one] != face[other]) & turned & outward
    faces = np.sort(np.stack([face[one], face[other]], axis=1), axis=1)[inner]
    radius = np.minimum(_radii(faces, vertices[inner], ends[inner]), scale)
    return Edges(ends[inner], radius, smallest)


def along(edges: Edges, share: float) -> Iterator[tuple[tuple[float, float, float], float]]:
    """Yield points along edges, at a spacing [mm] that is a share of the radius of the edge."""
    for (start, end), radius in zip(edges.ends, edges.radius, strict=True):
        step = share * float(radius)
        count = ceil(float(np.linalg.norm(end - start)) / step)
        for low, high in pairwise(np.linspace(0, 1, count + 1)):
            x, y, z = start + (end - start) * (low + high) / 2
            yield (float(x), float(y), float(z)), step


def _radii(faces: Integers, vertices: Integers, ends: Array) -> Array:
    """Return the radius [mm] of the edge at each segment, from lengths and angles between neighbours."""
    met = defaultdict(list)
    for piece, (pair, two) in enumerate(zip(faces, vertices, strict=True)):
        for side in (0, 1):
            met[(*pair, two[side])].append((piece, side))
    radius = np.full(len(ends), np.inf)
    for (one, side), (other, opposite) in (both for both in met.values() if len(both) == 2):
        before = ends[one, side] - ends[one, 1 - side]
        after = ends[other, 1 - opposite] - ends[other, opposite]
        lengths = np.linalg.norm(before), np.linalg.norm(after)
        turn = acos(np.clip(before @ after / np.prod(lengths), -1, 1))
        bent = sum(lengths) / 2 / turn if turn > 0 else np.inf
        radius[[one, other]] = np.minimum(radius[[one, other]], bent)
    return radius


def _neighbours(corners: Integers) -> tuple[Integers, Integers]:
    """Return, for each side shared by two triangles, both triangles with the index of that side."""
    sides = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2)
    order = np.lexsort(sides.T)
    twice = np.flatnonzero((sides[order[1:]] == sides[order[:-1]]).all(axis=1))
    pairs = np.stack([order[twice], order[twice + 1]])
    one, other = np.stack([pairs // 3, pairs % 3], axis=-1)
    return one, other


def _normals(triangles: Array) -> Array:
    a, b, c = triangles.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])
