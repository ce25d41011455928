"""Quadrature over faces on planes, cylinders, cones, spheres and tori, exact but for rounding.

By Green's theorem ∬ g du dv over the parameters (u, v) of a face is -∮ (∫ g dv) du along its boundary. The
inner integral begins at a fixed v. So a face needs no mesh, and a weight of the quadrature may be negative.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from math import ceil, pi
from typing import Any, NamedTuple

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_CurveType as _Curve
from OCP.GeomAbs import GeomAbs_Shape
from OCP.gp import gp_Pnt2d, gp_Vec2d
from OCP.TColStd import TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad.slopes.carriers import CONE, CYLINDER, PLANE, SPHERE, TORUS, Carriers, gradient
from templates.core.arrays import Array

_ALONG = 10  # nodes along each piece of the boundary; a piece spans at most a quarter of a turn
_ACROSS = {PLANE: 3, CYLINDER: 3, CONE: 3, SPHERE: 16, TORUS: 16}
"""Nodes of the inner integral; with these the integrals of polynomials of the third degree are exact."""


class FaceQuadrature(NamedTuple):
    """The kind of a face, points of it (n, 3) [mm], weights that add up to its area, and outward normals."""

    kind: int
    points: Array
    weights: Array
    normals: Array


def quadrature(face: TopoDS_Face) -> FaceQuadrature:
    """Return the quadrature of a face on one of the carriers."""
    carrier = Carriers.of([face])
    kind, numbers = int(carrier.kinds[0]), carrier.numbers[0]
    surface = BRepAdaptor_Surface(face, False)
    is_reversed = face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    forward = TopoDS.Face_s(face.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    outlines = [*_outlines(forward)]
    u, v, weights = (np.concatenate(column) for column in zip(*_inner(kind, outlines), strict=True))
    points, normals = _positions(kind, surface, numbers, u, v)
    lengths = np.linalg.norm(normals, axis=1)
    along = gradient(kind, numbers, points)
    far = np.argmax(lengths)
    side = int(np.sign(normals[far] @ along[far])) * (-1 if is_reversed else 1)
    return FaceQuadrature(kind, points, weights * lengths, side * along)


def _inner(kind: int, outlines: list[tuple[Array, Array, Array]]) -> Iterator[tuple[Array, Array, Array]]:
    """Yield u, v and the weights of du dv for each edge, whose u, v and weights of du are given."""
    start = min(float(v.min()) for _, v, _ in outlines)
    nodes, shares = _gauss(_ACROSS[kind])
    for u, v, du in outlines:
        reach = v - start
        yield (
            np.repeat(u, len(nodes)),
            (start + reach[:, None] * nodes).ravel(),
            (-(du * reach)[:, None] * shares).ravel(),
        )


def _outlines(face: TopoDS_Face) -> Iterator[tuple[Array, Array, Array]]:
    """Yield u, v and the weights of du along each edge of a face that is taken as forward."""
    explorer = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while explorer.More():
        edge = TopoDS.Edge_s(explorer.Current())
        curve = BRepAdaptor_Curve2d(edge, face)
        t, weights = _nodes(curve)
        u, v, slope = _on(curve, t)
        if edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
            weights = -weights
        yield u, v, weights * slope
        explorer.Next()


def _nodes(curve: BRepAdaptor_Curve2d) -> tuple[Array, Array]:
    """Return the nodes and weights of a composite Gauss rule along a curve."""
    nodes, shares = _gauss(_ALONG)
    ends = _ends(curve)
    lengths = np.diff(ends)
    return (ends[:-1, None] + lengths[:, None] * nodes).ravel(), (lengths[:, None] * shares).ravel()


def _ends(curve: BRepAdaptor_Curve2d) -> Array:
    """Return the ends of the pieces of a curve: spans of a spline, otherwise at most a quarter of a turn."""
    if curve.GetType() in (_Curve.GeomAbs_Line, _Curve.GeomAbs_Circle, _Curve.GeomAbs_Ellipse):
        first, last = curve.FirstParameter(), curve.LastParameter()
        return np.linspace(first, last, 1 + max(1, min(4, ceil(abs(last - first) / (pi / 2) - 1e-9))))
    spans = TColStd_Array1OfReal(1, curve.NbIntervals(GeomAbs_Shape.GeomAbs_CN) + 1)
    curve.Intervals(spans, GeomAbs_Shape.GeomAbs_CN)
    return np.array([spans.Value(n) for n in range(1, spans.Length() + 1)])


def _on(curve: BRepAdaptor_Curve2d, t: Array) -> tuple[Array, Array, Array]:
    """Return u, v and du/dt at parameters of a curve."""
    match curve.GetType():
        case _Curve.GeomAbs_Line:
            at, along = curve.Line().Location(), curve.Line().Direction()
            return at.X() + t * along.X(), at.Y() + t * along.Y(), np.full_like(t, along.X())
        case _Curve.GeomAbs_Circle:
            radius = curve.Circle().Radius()
            return _turn(curve.Circle().Position(), radius, radius, t)
        case _Curve.GeomAbs_Ellipse:
            ellipse = curve.Ellipse()
            return _turn(ellipse.Axis(), ellipse.MajorRadius(), ellipse.MinorRadius(), t)
    point, slope = gp_Pnt2d(), gp_Vec2d()
    rows = np.empty((len(t), 3))
    for n, one in enumerate(t.tolist()):
        curve.D1(one, point, slope)
        rows[n] = point.X(), point.Y(), slope.X()
    return rows[:, 0], rows[:, 1], rows[:, 2]


def _turn(place: Any, long: float, short: float, t: Array) -> tuple[Array, Array, Array]:
    """Return u, v and du/dt at parameters of an ellipse."""
    at, x, y = place.Location(), place.XDirection(), place.YDirection()
    a, b = long * np.cos(t), short * np.sin(t)
    da, db = -long * np.sin(t), short * np.cos(t)
    return (
        at.X() + a * x.X() + b * y.X(),
        at.Y() + a * x.Y() + b * y.Y(),
        da * x.X() + db * y.X(),
    )


def _positions(
    kind: int, surface: BRepAdaptor_Surface, numbers: Array, u: Array, v: Array
) -> tuple[Array, Array]:
    """Return the points of a surface at parameters, and the cross product of its derivatives there."""
    place = _PLACES[kind](surface).Position()
    origin, axis = numbers[:3], numbers[3:6]
    x, y = (np.array([d.X(), d.Y(), d.Z()]) for d in (place.XDirection(), place.YDirection()))
    if kind == PLANE:
        points = origin + u[:, None] * x + v[:, None] * y
        return points, np.broadcast_to(np.cross(x, y), points.shape)
    radius, height, radius_rate, height_rate = _profile(kind, numbers, v)
    out = np.cos(u)[:, None] * x + np.sin(u)[:, None] * y
    ahead = np.cos(u)[:, None] * y - np.sin(u)[:, None] * x
    points = origin + radius[:, None] * out + height[:, None] * axis
    upwards = radius_rate[:, None] * out + height_rate[:, None] * axis
    return points, np.cross(radius[:, None] * ahead, upwards)


def _profile(kind: int, numbers: Array, v: Array) -> tuple[Array, Array, Array, Array]:
    """Return the radius and the height of a surface of revolution at parameters v, and their slopes."""
    first, second = numbers[6], numbers[7]
    if kind == CYLINDER:
        return first + 0 * v, v, 0 * v, 1 + 0 * v
    if kind == CONE:
        sine, cosine = np.sin(second), np.cos(second)
        return first + v * sine, v * cosine, sine + 0 * v, cosine + 0 * v
    away = second if kind == TORUS else 0.0
    return away + first * np.cos(v), first * np.sin(v), -first * np.sin(v), first * np.cos(v)


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes and weights of Gauss's rule from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


_PLACES: Mapping[int, Callable[[BRepAdaptor_Surface], Any]] = {
    PLANE: lambda surface: surface.Plane(),
    CYLINDER: lambda surface: surface.Cylinder(),
    CONE: lambda surface: surface.Cone(),
    SPHERE: lambda surface: surface.Sphere(),
    TORUS: lambda surface: surface.Torus(),
}
