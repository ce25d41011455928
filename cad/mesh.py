"""Triangles of the bodies in a STEP file, as arrays: what STL, GLB and pictures are made of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from cadquery import Location, Shape
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location

from cad.model import Colour
from cad.step import Body, rigid
from templates.core.arrays import Array, Integers

ANGULAR_TOLERANCE = 0.2  # [rad] between neighbouring facets; 0.1 takes five times as long
RELATIVE_TOLERANCE = 1e-3  # of the size of the body: the greatest distance of a facet from the true surface


@dataclass(frozen=True)
class Mesh:
    """One body, in its own coordinates [mm]; its normals are smooth within a face, sharp between faces."""

    name: str
    colour: Colour
    places: tuple[Location, ...]
    points: Array  # (n, 3)
    normals: Array  # (n, 3), outwards
    triangles: Integers  # (m, 3), counter-clockwise seen from outside
    faces: Integers  # (m,), the number of the face that a triangle lies on


def mesh(body: Body, angle: float = ANGULAR_TOLERANCE) -> Mesh:
    """Triangulate one body."""
    size = body.shape.BoundingBox().DiagonalLength
    BRepMesh_IncrementalMesh(body.shape.wrapped, RELATIVE_TOLERANCE * size, False, angle, False)
    pieces = list(_face_meshes(body.shape))
    starts = np.cumsum([0, *(len(points) for points, _, _ in pieces)])
    return Mesh(
        body.name,
        body.colour,
        body.places,
        points=np.concatenate([points for points, _, _ in pieces]),
        normals=np.concatenate([normals for _, normals, _ in pieces]),
        triangles=np.concatenate([t + start for (_, _, t), start in zip(pieces, starts, strict=False)]),
        faces=np.repeat(np.arange(len(pieces)), [len(t) for _, _, t in pieces]),
    )


def placed(meshes: Iterable[Mesh]) -> Iterator[tuple[Mesh, Array, Array]]:
    """Each mesh at each of its places: the mesh, its points and its normals there."""
    for one in meshes:
        for place in one.places:
            turn, shift = rigid(place)
            yield one, one.points @ turn.T + shift, one.normals @ turn.T


def _face_meshes(shape: Shape) -> Iterator[tuple[Array, Array, Integers]]:
    for face in shape.Faces():
        location = TopLoc_Location()
        triangulation = BRep_Tool.Triangulation_s(face.wrapped, location)
        if triangulation is None:  # a face too small to show a triangle
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
