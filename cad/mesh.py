"""Triangle meshes of the bodies in a STEP file as arrays, from which STL, GLB and pictures are written.

A closed mesh has no gap: once points that are equal in single precision are merged, each edge belongs to
exactly one other triangle, in the opposite direction. No triangle has two corners that are equal in single
precision.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from cadquery import Location, Shape
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location

from cad.errors import GeometryError
from cad.model import Colour, names_at
from cad.step import Body, rigid
from templates.core.arrays import Array, Integers

ANGULAR_TOLERANCE = 0.2  # [rad] between neighbouring facets; 0.1 takes five times as long
RELATIVE_TOLERANCE = 1e-3  # largest distance of a facet from the true surface, over the size of the body
_ATTEMPTS = 3
_WIDE_ANGLE = 0.5  # [rad] between neighbouring facets if a given deflection determines the mesh
_SAFETY = 0.5  # on spheres, the kernel's facets deviate by up to 1.73 times the requested deflection


@dataclass(frozen=True)
class Mesh:
    """The mesh of one body in its own coordinates [mm].

    Normals are smooth within a face and sharp between faces.
    """

    name: str
    colour: Colour
    places: tuple[Location, ...]
    points: Array  # (n, 3)
    normals: Array  # (n, 3), outwards
    triangles: Integers  # (m, 3), counter-clockwise seen from outside
    faces: Integers  # (m,), the number of the face that a triangle lies on
    called: tuple[str, ...] = ()  # at its positions, where these have their own names

    @property
    def names(self) -> tuple[str, ...]:
        """Return the name of the body at each of its positions, as `cad.model.Part` does."""
        return names_at(self.name, len(self.places), self.called)


def mesh(body: Body, deflection: float | None = None) -> Mesh:
    """Triangulate one body; `deflection` [mm] is the largest distance of a facet from the true surface."""
    if deflection is None:
        size = body.shape.BoundingBox().DiagonalLength
        return _triangulated(body, RELATIVE_TOLERANCE * size, ANGULAR_TOLERANCE)
    return _triangulated(body, _SAFETY * deflection, _WIDE_ANGLE)


def closed_mesh(body: Body, deflection: float | None = None) -> Mesh:
    """Triangulate one body without gaps, with a finer mesh than requested if necessary.

    Raises
    ------
    GeometryError
        `open_mesh`, if the kernel leaves a gap at every attempt.
    """
    one = mesh(body, deflection)
    size = body.shape.BoundingBox().DiagonalLength
    finer = _SAFETY * deflection if deflection else RELATIVE_TOLERANCE * size
    for attempt in range(1, _ATTEMPTS):
        if is_closed(one):
            return one
        one = _triangulated(body, finer / 4**attempt, ANGULAR_TOLERANCE / 2**attempt)
    if is_closed(one):
        return one
    raise GeometryError("open_mesh", f"the triangle mesh of {body.name} is not closed")


def _triangulated(body: Body, linear: float, angular: float) -> Mesh:
    """Return the kernel's triangles [mm, rad], without degenerate ones."""
    BRepMesh_IncrementalMesh(body.shape.wrapped, linear, False, angular, False)
    return _without_collapsed(_joined(body, list(_face_meshes(body.shape))))


def is_closed(one: Mesh) -> bool:
    """Return whether each edge of a triangle belongs to exactly one other triangle, in reverse."""
    corners = welded(one)[1]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    count = int(corners.max()) + 1
    there, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    return bool(np.array_equal(np.unique(there), np.sort(back)))


def welded(one: Mesh) -> tuple[NDArray[np.float32], Integers]:
    """Return points (p, 3) [mm] and triangle corners (m, 3); points equal in single precision are merged."""
    single = np.ascontiguousarray(one.points.astype(np.float32) + np.float32(0.0))  # without negative zeros
    _, first, numbers = np.unique(single.view("V12").ravel(), return_index=True, return_inverse=True)
    return single[first], numbers[one.triangles].astype(np.int64)


def _without_collapsed(one: Mesh) -> Mesh:
    """Return a mesh without triangles whose vertices coincide, as at the poles of a sphere."""
    a, b, c = welded(one)[1].T
    kept = (a != b) & (b != c) & (c != a)
    return one if kept.all() else replace(one, triangles=one.triangles[kept], faces=one.faces[kept])


def _joined(body: Body, pieces: Sequence[tuple[Array, Array, Integers]]) -> Mesh:
    starts = np.cumsum([0, *(len(points) for points, _, _ in pieces)])
    return Mesh(
        body.name,
        body.colour,
        body.places,
        points=np.concatenate([points for points, _, _ in pieces]),
        normals=np.concatenate([normals for _, normals, _ in pieces]),
        triangles=np.concatenate([t + start for (_, _, t), start in zip(pieces, starts, strict=False)]),
        faces=np.repeat(np.arange(len(pieces)), [len(t) for _, _, t in pieces]),
        called=body.called,
    )


def placed(meshes: Iterable[Mesh]) -> Iterator[tuple[Mesh, Array, Array]]:
    """Yield each mesh at each of its positions, with its points and normals there."""
    for one in meshes:
        for place in one.places:
            turn, shift = rigid(place)
            yield one, one.points @ turn.T + shift, one.normals @ turn.T


def _face_meshes(shape: Shape) -> Iterator[tuple[Array, Array, Integers]]:
    for face in shape.Faces():
        location = TopLoc_Location()
        triangulation = BRep_Tool.Triangulation_s(face.wrapped, location)
        if triangulation is None:  # the face is too small for a triangle
            continue
        turn, shift = rigid(Location(location))
        numbers = range(1, triangulation.NbNodes() + 1)
        triangulation.ComputeNormals()
        points = np.array([(p.X(), p.Y(), p.Z()) for p in map(triangulation.Node, numbers)])
        normals = np.array([(n.X(), n.Y(), n.Z()) for n in map(triangulation.Normal, numbers)])
        triangles = (
            np.array([triangulation.Triangle(i).Get() for i in range(1, triangulation.NbTriangles() + 1)]) - 1
        )
        if face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
            triangles, normals = triangles[:, ::-1], -normals
        yield points @ turn.T + shift, normals @ turn.T, triangles
