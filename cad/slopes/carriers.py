"""Carriers of faces: planes, cylinders, cones, spheres and tori as arrays, and how fast they move.

Each is a surface of revolution: its signed distance φ depends on the distance ρ from its axis, on the
coordinate z along the axis, and on its sizes. A point of the carrier has the normal velocity -dφ/dp along ∇φ
if a parameter p moves the axis or changes the sizes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_SurfaceType as _Type
from OCP.TopoDS import TopoDS_Face

from cad.on_demand import constant
from templates.core.arrays import Array

NUMBERS = 8
"""Numbers of a carrier: a point of its axis [mm], the direction of the axis, two sizes [mm or rad]."""

PLANE, CYLINDER, CONE, SPHERE, TORUS, OTHER = range(6)


class Distance(NamedTuple):
    """The signed distance φ(ρ, z, first size, second size), and its partial derivatives."""

    value: Array
    along_radius: Array
    along_axis: Array
    first: Array | float = 0.0
    second: Array | float = 0.0


def _plane(rho: Array, z: Array, _first: Array, _second: Array) -> Distance:
    return Distance(z, 0 * rho, 1 + 0 * z)


def _cylinder(rho: Array, z: Array, radius: Array, _second: Array) -> Distance:
    return Distance(rho - radius, 1 + 0 * rho, 0 * z, -1.0)


def _cone(rho: Array, z: Array, radius: Array, angle: Array) -> Distance:
    """Return the distance from a cone whose radius is that at z = 0; the angle is half that at the tip."""
    sine, cosine = np.sin(angle), np.cos(angle)
    beyond = (rho - radius) * sine + z * cosine
    return Distance((rho - radius) * cosine - z * sine, cosine + 0 * rho, -sine + 0 * z, -cosine, -beyond)


def _sphere(rho: Array, z: Array, radius: Array, _second: Array) -> Distance:
    away = np.hypot(rho, z)
    return Distance(away - radius, rho / away, z / away, -1.0)


def _torus(rho: Array, z: Array, tube: Array, radius: Array) -> Distance:
    away = np.hypot(rho - radius, z)
    return Distance(away - tube, (rho - radius) / away, z / away, -1.0, -(rho - radius) / away)


_DISTANCES: Mapping[int, Callable[[Array, Array, Array, Array], Distance]] = {
    PLANE: _plane,
    CYLINDER: _cylinder,
    CONE: _cone,
    SPHERE: _sphere,
    TORUS: _torus,
}


class Carriers(NamedTuple):
    """The carriers of some faces: their kinds (n,) and their numbers (n, 8)."""

    kinds: Array
    numbers: Array

    @classmethod
    def of(cls, faces: Sequence[TopoDS_Face]) -> Carriers:
        """Return the carriers of faces, in their order."""
        read = [_read(face) for face in faces]
        kinds = np.array([kind for kind, _ in read], dtype=int)
        return cls(kinds, np.array([numbers for _, numbers in read]).reshape(-1, NUMBERS))


def _read(face: TopoDS_Face) -> tuple[int, Sequence[float]]:
    adaptor = BRepAdaptor_Surface(face, False)
    kind = _KINDS.get(adaptor.GetType(), OTHER)
    if kind == OTHER:
        return kind, [0.0] * NUMBERS
    place, sizes = _SHAPES[kind](adaptor)
    at, axis = place.Location(), place.Direction()
    return kind, [at.X(), at.Y(), at.Z(), axis.X(), axis.Y(), axis.Z(), *sizes]


def distance(kind: int, numbers: Array, points: Array) -> Array:
    """Return the signed distances [mm] of points (m, 3) from carriers (…, 8) of one kind, shape (…, m)."""
    return _Revolved.of(kind, numbers, points).distance.value


def gradient(kind: int, numbers: Array, points: Array) -> Array:
    """Return the gradients of the distance (m, 3) from one carrier (8,) at points of it (m, 3)."""
    at = _Revolved.of(kind, numbers, points)
    outwards = at.across / np.maximum(at.rho, _TINY)[:, None]
    axis = numbers[3:6]
    return np.asarray(at.distance.along_radius[:, None] * outwards + at.distance.along_axis[:, None] * axis)


def distance_rate(kind: int, numbers: Array, rates: Array, points: Array) -> Array:
    """Return dφ/dp at points (m, 3) of one carrier (8,) whose numbers have the rates (…, 8), shape (…, m)."""
    at = _Revolved.of(kind, numbers, points)
    shift, turn = rates[..., :3] @ at.across.T, rates[..., 3:6] @ at.across.T
    of_radius = -(shift + at.z * turn) / np.maximum(at.rho, _TINY)
    of_axis = rates[..., 3:6] @ at.away.T - (rates[..., :3] @ numbers[3:6])[..., None]
    by_size = at.distance.first * rates[..., 6:7] + at.distance.second * rates[..., 7:8]
    return np.asarray(at.distance.along_radius * of_radius + at.distance.along_axis * of_axis + by_size)


_TINY = 1e-12  # [mm]


class _Revolved(NamedTuple):
    """Points as seen from the axis of carriers."""

    away: Array  # from the point of the axis
    across: Array  # the part of `away` perpendicular to the axis
    rho: Array
    z: Array
    distance: Distance

    @classmethod
    def of(cls, kind: int, numbers: Array, points: Array) -> _Revolved:
        away = points - numbers[..., None, :3]
        axis = numbers[..., None, 3:6]
        z = np.sum(away * axis, axis=-1)
        across = away - z[..., None] * axis
        rho = np.linalg.norm(across, axis=-1)
        return cls(away, across, rho, z, _DISTANCES[kind](rho, z, numbers[..., 6:7], numbers[..., 7:8]))


_KINDS = constant(
    lambda: {
        _Type.GeomAbs_Plane: PLANE,
        _Type.GeomAbs_Cylinder: CYLINDER,
        _Type.GeomAbs_Cone: CONE,
        _Type.GeomAbs_Sphere: SPHERE,
        _Type.GeomAbs_Torus: TORUS,
    }
)
_SHAPES: Mapping[int, Callable[[Any], tuple[Any, tuple[float, float]]]] = {
    PLANE: lambda adaptor: (adaptor.Plane().Position(), (0.0, 0.0)),
    CYLINDER: lambda adaptor: ((c := adaptor.Cylinder()).Position(), (c.Radius(), 0.0)),
    CONE: lambda adaptor: ((c := adaptor.Cone()).Position(), (c.RefRadius(), c.SemiAngle())),
    SPHERE: lambda adaptor: ((s := adaptor.Sphere()).Position(), (s.Radius(), 0.0)),
    TORUS: lambda adaptor: ((t := adaptor.Torus()).Position(), (t.MinorRadius(), t.MajorRadius())),
}
"""For each kind, the position of a carrier and its sizes."""
