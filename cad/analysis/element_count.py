"""Estimate the number of elements of a mesh from its element sizes, before it is made.

Netgen's first step computes the size of the elements at each point from curvature, edges and prescribed
limits, in a fraction of the time of the mesh. A solid has about `PER_BOX` ∫ dV/h³ tetrahedra of size h. The
integral is a sum over boxes at most half as large as the elements there. Boxes that lie outside the solid
count too, since only those near the surface are small enough to matter.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any

import numpy as np
from netgen.meshing import MeshingParameters, MeshingStep
from netgen.occ import OCCGeometry

from templates.core.arrays import Array

PER_BOX = 4.4
"""Tetrahedra per volume h³ of the boxes (`python -m benchmarks.element_counts`)."""

_SHARE = 0.5  # largest side of a box, relative to the elements in it
_GROWTH = 0.5 * sqrt(3) / 2  # of the size from the middle of a box to its corner, over its side
_OCTANTS = np.stack(np.meshgrid(*3 * [[-0.25, 0.25]], indexing="ij"), axis=-1).reshape(-1, 3)


def element_sizes(shape: Any, parameters: MeshingParameters) -> Callable[[tuple[float, ...]], float]:
    """Return the function that gives the size of elements [mm] at a point [mm] near a shape."""
    analysed = MeshingParameters(parameters, perfstepsend=MeshingStep.ANALYSE)
    local = OCCGeometry(shape).GenerateMesh(analysed).GetLocalH(1)
    return lambda point: float(local.GetH(point))


def estimated_elements(shape: Any, parameters: MeshingParameters, largest: float, most: float) -> int:
    """Return the estimated number of elements of a mesh, none larger than `largest` [mm].

    The count stops once it is certain to exceed `most`; then it returns a smaller number, but above `most`.
    """
    size_of = element_sizes(shape, parameters)
    low, high = (np.array([*corner]) for corner in shape.bounding_box)
    side = float((high - low).min())
    counts = np.ceil((high - low) / side).astype(int)
    places = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 3)

    def size_at(centres: Array) -> Array:
        return np.array([min(size_of(tuple(centre)), largest) for centre in centres.tolist()])

    return round(_elements_in(size_at, low + side * (places + 0.5), side, most))


def _elements_in(size_at: Callable[[Array], Array], centres: Array, side: float, most: float) -> float:
    """Return the estimated number of elements in equal boxes, after dividing those that are too large."""
    elements = 0.0
    while len(centres):
        size = size_at(centres)
        is_large = side > _SHARE * size
        elements += PER_BOX * float(np.sum((side / size[~is_large]) ** 3))
        least = PER_BOX * float(np.sum((side / (size[is_large] + _GROWTH * side)) ** 3))
        if elements + least > most:
            return elements + least
        centres = (centres[is_large, None] + side * _OCTANTS).reshape(-1, 3)
        side /= 2
    return elements
