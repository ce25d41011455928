"""Curves on the paper: straight lines, true arcs, and polylines where neither fits.

The kernel projects edges in pieces, and draws coincident edges several times. This module joins the pieces of
each line or circle, draws each once, and omits a hidden line behind a visible one (ISO 128-2).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, ceil, cos, degrees, hypot, pi, radians, sin, tan
from typing import Any

import numpy as np
from cadquery import BoundBox, Shape
from OCP.BRepLib import BRepLib
from OCP.GCPnts import GCPnts_TangentialDeflection
from scipy.interpolate import CubicSpline

Point = tuple[float, float]
Polyline = list[Point]
Vertex = tuple[float, float, float]
"""A corner of an outline, and the bulge of the piece behind it: the tangent of a quarter of its turn."""

_STEP = 5.0  # between two points of an arc [degrees]
_TURN = 0.05  # [rad] between two points of another curve
_SMOOTH = 5e-4  # of a curve's size: the greatest distance of a piece from it
_POINT = 1e-6  # [mm]
_ROUND = 2e-5  # of the radius: how near to a circle points lie that are an arc
_JOINED = 2e-5  # [mm]
_CORNER = 0.7  # [rad], a larger turn is a corner
_FINER = 5  # pieces between two points of the kernel
_DIGITS = 4  # to which two lines or circles are the same one


@dataclass(frozen=True)
class Round:
    """An arc, counter-clockwise from its start angle [degrees]; a turn of 360 makes it a circle."""

    centre: Point
    radius: float
    start: float
    turn: float

    @property
    def is_whole(self) -> bool:
        """Return whether the arc is a full circle."""
        return self.turn >= 360 - 1e-6

    def at(self, angle: float) -> Point:
        """Return the point of the circle at an angle [degrees]."""
        turned = radians(angle)
        return self.centre[0] + self.radius * cos(turned), self.centre[1] + self.radius * sin(turned)

    def points(self) -> Polyline:
        """Return points along the arc, including its ends and its extreme points."""
        count = max(2, ceil(self.turn / _STEP))
        angles = {self.start + self.turn * i / count for i in range(count + 1)}
        quarters = range(ceil(self.start / 90), int((self.start + self.turn) // 90) + 1)
        return [self.at(angle) for angle in sorted(angles | {90.0 * quarter for quarter in quarters})]


@dataclass(frozen=True)
class Curve:
    """A polyline, and the arc that it approximates if there is one."""

    points: Polyline
    arc: Round | None = None

    def moved(self, shift: Point) -> Curve:
        """Return the curve moved by a vector."""
        points = [(x + shift[0], y + shift[1]) for x, y in self.points]
        if self.arc is None:
            return Curve(points)
        centre = self.arc.centre[0] + shift[0], self.arc.centre[1] + shift[1]
        return Curve(points, replace(self.arc, centre=centre))

    def vertices(self) -> list[Vertex]:
        """Return the curve as corners with bulges, the form in which DXF writes outlines."""
        if self.arc is None:
            return [(x, y, 0.0) for x, y in self.points]
        halves = 2 if self.arc.turn > 180 else 1
        bulge = tan(radians(self.arc.turn / halves) / 4)
        angles = [self.arc.start + self.arc.turn * i / halves for i in range(halves + 1)]
        corners = [self.arc.at(angle) for angle in angles]
        return [*((x, y, bulge) for x, y in corners[:-1]), (*corners[-1], 0.0)]


def curves_of(compounds: Iterable[Any], scale: float) -> list[Curve]:
    """Return the edges of projections as curves, scaled by a factor."""
    curves = []
    for compound in compounds:
        if compound is None or compound.IsNull():
            continue
        BRepLib.BuildCurves3d_s(compound)  # the projection leaves curves on a plane only
        for edge in Shape.cast(compound).Edges():
            size = BoundBox._fromTopoDS(edge.wrapped, None, False).DiagonalLength
            if size > _POINT:  # what is seen end on is a point
                curves.append(_scaled(curve_of(edge._geomAdaptor(), size), scale))
    return curves


def curve_of(adaptor: Any, size: float) -> Curve:
    """Return a curve of the kernel as it appears when viewed along z."""
    kind = adaptor.GetType().name.rpartition("_")[2]
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    if kind == "Line":
        return Curve([_flat(adaptor.Value(first)), _flat(adaptor.Value(last))])
    if kind == "Circle" and abs(axis := adaptor.Circle().Axis().Direction().Z()) > 1 - 1e-9:
        circle = adaptor.Circle()
        centre = _flat(circle.Location())
        begin = _flat(adaptor.Value(first if axis > 0 else last))
        start = degrees(atan2(begin[1] - centre[1], begin[0] - centre[0]))
        return rounded(Round(centre, circle.Radius(), start, min(degrees(last - first), 360.0)))
    if kind == "BSplineCurve" and adaptor.Degree() == 1:  # where the kernel joins points of its own
        poles = adaptor.BSpline().Poles()
        return recognised([_flat(poles.Value(i)) for i in range(1, poles.Length() + 1)])
    steps = GCPnts_TangentialDeflection(adaptor, _TURN, max(_SMOOTH * size, _POINT))
    return recognised([_flat(steps.Value(i)) for i in range(1, steps.NbPoints() + 1)])


def rounded(arc: Round) -> Curve:
    """Return an arc as a curve, with points along it."""
    return Curve(arc.points(), arc)


def recognised(points: Polyline) -> Curve:
    """Return a straight line or an arc if the points lie on one, otherwise a polyline."""
    one, other = points[0], points[-1]
    span = hypot(other[0] - one[0], other[1] - one[1])
    if span > _POINT and all(abs(_cross(one, other, p)) < 1e-5 * span * span for p in points[1:-1]):
        return Curve([one, other])
    if len(points) < 5 or (circle := _circle_through(one, points[len(points) // 2], other)) is None:
        return Curve(smoothed(points))
    (x, y), radius = circle
    if any(abs(hypot(p[0] - x, p[1] - y) - radius) > _ROUND * radius for p in points):
        return Curve(smoothed(points))
    turns = [atan2(p[1] - y, p[0] - x) for p in points]
    turn = sum((b - a + pi) % (2 * pi) - pi for a, b in pairwise(turns))
    return rounded(Round((x, y), radius, degrees(turns[0] if turn > 0 else turns[-1]), degrees(abs(turn))))


def smoothed(points: Polyline) -> Polyline:
    """Return the points and further ones on a smooth curve through them; leave corners unchanged."""
    places = np.asarray(points)
    away = np.diff(places, axis=0)
    sizes = np.hypot(away[:, 0], away[:, 1])
    if len(points) < 4 or sizes.min() < _POINT:
        return points
    angles = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    if np.abs(np.diff(angles)).max() > _CORNER or np.abs(np.diff(angles)).max() < _TURN:
        return points
    along = np.concatenate([[0.0], np.cumsum(sizes)])
    finer = np.concatenate([np.linspace(a, b, _FINER, endpoint=False) for a, b in pairwise(along)])
    curve = CubicSpline(along, places)(np.append(finer, along[-1]))
    return [(float(x), float(y)) for x, y in curve]


def joined(curves: Iterable[Curve], without: Sequence[Curve] = ()) -> list[Curve]:
    """Return the curves with the pieces of each line or circle joined.

    Stretches that the curves in `without` cover are omitted.
    """
    lines, arcs, rest = _Spans(), _Spans(), []
    for curve, is_kept in [*((c, True) for c in curves), *((c, False) for c in without)]:
        if curve.arc is not None:
            arcs.add_arc(curve.arc, is_kept)
        elif len(curve.points) == 2:
            lines.add_line(curve.points, is_kept)
        elif is_kept and curve not in rest:
            rest.append(curve)
    return [*lines.lines(), *arcs.arcs(), *rest]


class _Spans:
    """Stretches of lines and circles, grouped by the line or circle on which they lie."""

    def __init__(self) -> None:
        self.carriers: dict[tuple[float, ...], tuple[float, ...]] = {}
        self.kept: dict[tuple[float, ...], list[tuple[float, float]]] = {}
        self.taken: dict[tuple[float, ...], list[tuple[float, float]]] = {}

    def add_line(self, points: Polyline, is_kept: bool) -> None:
        (x, y), (u, v) = sorted(points)
        size = hypot(u - x, v - y)
        if size < _POINT:
            return
        a, b = (u - x) / size, (v - y) / size
        if a < 1e-9:  # upright, whichever end rounding has put farther left
            a, b, y = 0.0, 1.0, min(y, v)
        away = x * -b + y * a
        start = x * a + y * b
        self._add(
            (round(a, 6), round(b, 6), round(away, _DIGITS)), (a, b, away), start, start + size, is_kept
        )

    def add_arc(self, arc: Round, is_kept: bool) -> None:
        key = (*(round(c, _DIGITS) + 0.0 for c in arc.centre), round(arc.radius, _DIGITS))
        start = arc.start % 360.0
        carrier = (*arc.centre, arc.radius)
        end = start + arc.turn
        self._add(key, carrier, start, min(end, 360.0), is_kept)
        if end > 360.0:
            self._add(key, carrier, 0.0, end - 360.0, is_kept)

    def _add(
        self, key: tuple[float, ...], carrier: tuple[float, ...], low: float, high: float, is_kept: bool
    ) -> None:
        carrier = self.carriers.setdefault(key, carrier)
        (self.kept if is_kept else self.taken).setdefault(key, []).append((low, high))

    def lines(self) -> Iterator[Curve]:
        for key, (a, b, away) in self.carriers.items():
            for low, high in _left(self.kept.get(key, []), self.taken.get(key, []), _JOINED):
                yield Curve([(a * t - b * away, b * t + a * away) for t in (low, high)])

    def arcs(self) -> Iterator[Curve]:
        for key, (x, y, radius) in self.carriers.items():
            near = degrees(_JOINED / radius)
            spans = _left(self.kept.get(key, []), self.taken.get(key, []), near)
            if len(spans) > 1 and spans[0][0] < near and spans[-1][1] > 360 - near:
                spans = [*spans[1:-1], (spans[-1][0], spans[0][1] + 360.0)]
            for low, high in spans:
                yield rounded(Round((x, y), radius, low, 360.0 if high - low > 360 - near else high - low))


def _left(
    kept: list[tuple[float, float]], taken: list[tuple[float, float]], near: float
) -> list[tuple[float, float]]:
    """Return the union of the kept spans minus the taken ones."""
    spans = _union(kept, near)
    for low, high in _union(taken, near):
        parts = [part for a, b in spans for part in ((a, min(b, low)), (max(a, high), b))]
        spans = [(a, b) for a, b in parts if b - a > near]
    return spans


def _union(spans: list[tuple[float, float]], near: float) -> list[tuple[float, float]]:
    result: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if result and low <= result[-1][1] + near:
            result[-1] = result[-1][0], max(result[-1][1], high)
        else:
            result.append((low, high))
    return result


def outline(pieces: Sequence[Curve]) -> list[Vertex]:
    """Return a closed outline as corners with bulges, from pieces in any order and direction."""
    left = [piece.vertices() for piece in pieces]
    line = left.pop(0)
    while left:
        end = line[-1]
        nearest = min(left, key=lambda piece: min(_apart(end, piece[0]), _apart(end, piece[-1])))
        left.remove(nearest)
        forward = _apart(end, nearest[0]) <= _apart(end, nearest[-1])
        line = [*line[:-1], *(nearest if forward else _reversed(nearest))]
    return line[:-1] if _apart(line[0], line[-1]) < 1e-3 and len(line) > 2 else line


def _reversed(vertices: Sequence[Vertex]) -> list[Vertex]:
    bulges = [*(-bulge for _, _, bulge in reversed(vertices[:-1])), 0.0]
    return [(x, y, bulge) for (x, y, _), bulge in zip(reversed(vertices), bulges, strict=True)]


def _scaled(curve: Curve, scale: float) -> Curve:
    if (arc := curve.arc) is not None:
        (x, y), radius = arc.centre, arc.radius
        return rounded(Round((x * scale, y * scale), radius * scale, arc.start, arc.turn))
    return Curve([(x * scale, y * scale) for x, y in curve.points])


def _flat(point: Any) -> Point:
    return point.X(), point.Y()


def _apart(one: Sequence[float], other: Sequence[float]) -> float:
    return hypot(one[0] - other[0], one[1] - other[1])


def _cross(a: Point, b: Point, p: Point) -> float:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def _circle_through(a: Point, b: Point, c: Point) -> tuple[Point, float] | None:
    """Return the centre and radius of the circle through three points; None if they are collinear."""
    double = 2 * _cross(a, b, c)
    if abs(double) < 1e-12:
        return None
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / double
    y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / double
    return (a[0] + x, a[1] + y), hypot(x, y)
