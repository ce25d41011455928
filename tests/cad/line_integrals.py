"""The volume of a finished solid by line integrals along the edges of its faces: independent of the kernel's.

By the divergence theorem 3 V is the integral of x·n over the faces, and by Green's theorem the integral
over a face is one along its edges in the plane of the surface's parameters (u, v): of G dv, with ∂G/∂u =
x·(S_u × S_v). Of planes, cylinders and cones G is known in closed form. Where one edge ends off the
beginning of the next (the kernel lets curves of intersection stop 1e-7 mm off their vertex), a straight
line closes the gap. `BRepGProp` does not close it, and is off there by as much as 4e-9 of the volume.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import cos, sin

import numpy as np
from cadquery import Face, Shape
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.GeomAbs import GeomAbs_Shape
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind
from OCP.gp import gp_Pnt2d, gp_Vec2d
from OCP.TColStd import TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_Orientation as Orientation

Potential = Callable[[float, float], float]
"""G(u, v) of a surface [mm²] or [mm³], as v is a length or not."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
_PIECES = 4  # of each polynomial piece of a curve


def volume_of(solid: Shape) -> float:
    """The volume [mm³] of a solid of planes, cylinders and cones; raises TypeError of others."""
    return sum(_flux(face) for face in solid.Faces()) / 3


def _flux(face: Face) -> float:
    """The integral of x·n over a face [mm³]."""
    potential, total = _potential(BRepAdaptor_Surface(face.wrapped)), 0.0
    for wire in (face.outerWire(), *face.innerWires()):
        ends = []
        for curve, is_reversed in _curves(wire, face):
            sign = -1 if is_reversed else 1
            total += sign * _along(curve, potential)
            points = [curve.Value(t) for t in (curve.FirstParameter(), curve.LastParameter())]
            ends.append([(p.X(), p.Y()) for p in points][::sign])
        for one, following in zip(ends, [*ends[1:], ends[0]], strict=True):
            stop, start = one[1], following[0]
            total += (potential(*stop) + potential(*start)) / 2 * (start[1] - stop[1])
    return total


def _curves(wire: Shape, face: Face) -> Iterator[tuple[BRepAdaptor_Curve2d, bool]]:
    """The edges of a wire in their order, as curves in (u, v); and whether one is passed backwards."""
    explorer = BRepTools_WireExplorer(wire.wrapped, face.wrapped)
    while explorer.More():
        edge = explorer.Current()
        yield BRepAdaptor_Curve2d(edge, face.wrapped), edge.Orientation() == Orientation.TopAbs_REVERSED
        explorer.Next()


def _along(curve: BRepAdaptor_Curve2d, potential: Potential) -> float:
    """∫ G dv along a curve [mm³], by Gauss' rule on each of its smooth pieces."""
    count = curve.NbIntervals(GeomAbs_Shape.GeomAbs_CN)
    knots = TColStd_Array1OfReal(1, count + 1)
    curve.Intervals(knots, GeomAbs_Shape.GeomAbs_CN)
    total, point, speed = 0.0, gp_Pnt2d(), gp_Vec2d()
    for number in range(1, count + 1):
        steps = np.linspace(knots.Value(number), knots.Value(number + 1), _PIECES + 1)
        for low, high in pairwise(steps):
            half = (high - low) / 2
            for node, weight in zip(_NODES, _WEIGHTS, strict=True):
                curve.D1(low + half * (1 + node), point, speed)
                total += weight * half * potential(point.X(), point.Y()) * speed.Y()
    return total


def _potential(surface: BRepAdaptor_Surface) -> Potential:
    kind = surface.GetType()
    if kind == Kind.GeomAbs_Plane:
        origin, right, up, _ = _frame(surface.Plane().Position())
        away = origin @ np.cross(right, up)
        return lambda u, v: float(away * u)
    if kind == Kind.GeomAbs_Cylinder:
        cylinder = surface.Cylinder()
        return _of_cone(cylinder.Position(), cylinder.Radius(), 0.0)
    if kind == Kind.GeomAbs_Cone:
        cone = surface.Cone()
        return _of_cone(cone.Position(), cone.RefRadius(), cone.SemiAngle())
    raise TypeError(f"no closed form for {kind}")


def _of_cone(position, radius: float, slope: float) -> Potential:
    """Of o + (R + v sin a) e(u) + v cos a k with e(u) = i cos u + j sin u.

    R [mm], a [rad]; a cylinder has a = 0.
    """
    origin, right, up, axis = _frame(position)
    hand = float(np.sign(np.cross(right, up) @ axis))
    x, y, z = float(origin @ right), float(origin @ up), float(origin @ axis)
    sine, cosine = sin(slope), cos(slope)

    def potential(u: float, v: float) -> float:
        r = radius + v * sine
        return hand * r * (cosine * (x * sin(u) - y * cos(u) + r * u) - sine * (z + v * cosine) * u)

    return potential


def _frame(position) -> list:
    """Origin and directions of a surface's coordinates."""
    parts = (position.Location(), position.XDirection(), position.YDirection(), position.Direction())
    return [np.array((part.X(), part.Y(), part.Z())) for part in parts]
